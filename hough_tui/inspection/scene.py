"""One draw of a scene looked at closely: its points, its truth, and what a clustering makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from algorithms.clustering.parameters import Clustering, CorrectedPatent
from algorithms.clustering.tree import Step
from hough_tui.recorded.clustering import Clustered, can_be_followed, cluster_recording
from scenarios.files.point_files import PointRecording
from scenarios.model import ScenarioSet
from scenarios.range_doppler import SceneDraw, draw_scene
from scenarios.scenes import Scene

MOST_STEPS = 2_000
"""Longer ways from all points to the clusters are not followed: nobody would."""


@dataclass(frozen=True, slots=True)
class ScenePicture:
    """A draw of a scene: what the radar saw, and what was there.

    Attributes
    ----------
    scene, seed, trial : which draw
    drawn : its points, with what caused each, and the centres of the targets
    """

    scene: Scene
    seed: int
    trial: int
    drawn: SceneDraw


@dataclass(frozen=True, slots=True)
class ClusterLook:
    """What a clustering made of a draw.

    Attributes
    ----------
    picture : the draw
    name : of the clustering in the set
    found : the clusters, and the parameters by which they were found, every `auto` worked out
    steps : how the points were split, the whole first; empty where they were not, or too often
    why_no_steps : the reason, in words; empty where there are steps
    """

    picture: ScenePicture
    name: str
    found: Clustered
    steps: tuple[Step, ...] = ()
    why_no_steps: str = ""

    @property
    def splits_at_mean(self) -> bool:
        """Whether a set is judged by the chord of its ellipse and split at the mean."""
        return isinstance(self.found.parameters, CorrectedPatent)


def scene_picture(scene: Scene, seed: int, trial: int) -> ScenePicture:
    """Return a draw of a scene."""
    return ScenePicture(scene, seed, trial, draw_scene(scene, seed, trial))


def cluster_look(picture: ScenePicture, name: str, parameters: Clustering) -> ClusterLook:
    """Return what a clustering makes of a draw.

    Parameters
    ----------
    picture : the draw
    name : of the clustering in the set
    parameters : of the clustering; an `auto` is worked out for the scene

    Raises
    ------
    RequestError
        Where a mode lacks what it needs, or the points are too few for it.
    """
    points = picture.drawn.points
    recording = PointRecording(points, np.zeros(1, np.int64), np.arange(len(points)))
    found = cluster_recording(recording, parameters.resolved(len(picture.scene.targets)))
    if not can_be_followed(parameters):
        return ClusterLook(
            picture, name, found, why_no_steps=f"{parameters.mode} does not split: there are no steps"
        )
    assert found.splits is not None
    count = int(found.splits.offsets[-1])
    if count > MOST_STEPS:
        why = f"{count:,} sets were looked at, more than the {MOST_STEPS:,} that can be followed"
        return ClusterLook(picture, name, found, why_no_steps=why)
    return ClusterLook(picture, name, found, tuple(found.steps(0)))


def scene_seed(given: ScenarioSet, scene: Scene) -> int:
    """Return the seed of the first experiment on a scene; 1 where there is none."""
    for experiment in given.experiments:
        if scene.name in (found.name for found in given.chosen(experiment, "scenes")):
            return experiment.seed
    return 1
