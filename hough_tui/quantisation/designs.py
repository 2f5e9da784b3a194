"""What a quantisation is designed for: a scenario, or a sensor and a speed that options describe."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from algorithms.context import Box, Unit
from algorithms.errors import RequestError
from algorithms.parameters import validated
from algorithms.quantisation.question import Clutter, ClutterSource, Question, TargetLine
from scenarios.clutter import ExactClutter
from scenarios.files.set_files import load_set
from scenarios.model import Scenario
from scenarios.selection import changed, chosen_scenario
from scenarios.sensors import PolarSensor
from scenarios.targets import Target
from scenarios.true_lines import fitted_motion
from scenarios.world import World

PLACEMENTS = 40
"""Places and headings of a target of which only the speed is known, in the trials of a check."""


@dataclass(frozen=True, slots=True)
class Demands:
    """What is demanded of a quantisation; for the fields see `Question`."""

    false_cells: float = 1.0
    kappa: float = 1.0
    separation: float | None = None
    confidence: float = 0.95


@dataclass(frozen=True, slots=True)
class Sensing:
    """A sensor, its clutter and a target's motion, as options give them.

    Attributes
    ----------
    sigma, scans, interval, detection_probability, region, unit : as in a scenario
    clutter : mean number of clutter plots a scan
    speed : of the target, in units of length a second
    """

    sigma: float
    scans: int
    interval: float
    detection_probability: float
    clutter: float
    region: Box
    speed: float
    unit: Unit


@dataclass(frozen=True, slots=True)
class Design:
    """The question of a design, and the scenarios that put it to the test.

    Attributes
    ----------
    question : for the advisor
    scenarios : what trials draw; each has one target for each line of the question
    names : of the lines
    assumed : what nobody said, in words
    """

    question: Question
    scenarios: tuple[Scenario, ...]
    names: tuple[str, ...]
    assumed: dict[str, str] = field(default_factory=dict)

    @property
    def unit(self) -> Unit:
        """The unit of all lengths."""
        return self.scenarios[0].unit

    @property
    def interval(self) -> float:
        """Time between scans, in seconds."""
        return self.scenarios[0].interval


def moving_targets(scenario: Scenario) -> dict[int, TargetLine]:
    """Return the line of each target that moves and is there within the batch, by its number.

    The line of a path that is none is that of the fit to it, see `scenarios.true_lines`.
    """
    lines, context = {}, scenario.context
    assert context.sigma is not None
    for index, target in enumerate(scenario.targets):
        begin, end = target.lifetime(scenario.interval)
        scans = math.floor((min(end, scenario.last_time) - begin) / context.interval + 1e-9) + 1
        if scans <= 0 or target.stands_still:
            continue
        first, velocity = (target.position[0], target.position[1]), (target.velocity[0], target.velocity[1])
        if not target.motion.is_straight:
            middle, fitted = (part[0] for part in fitted_motion(World.of(scenario).planned_states, index))
            if not np.isfinite(middle).all():
                # No scan of any sensor falls into its life.
                continue
            start = middle - 0.5 * (scans - 1) * context.interval * fitted
            first, velocity = (float(start[0]), float(start[1])), (float(fitted[0]), float(fitted[1]))
        sigma_x, sigma_y = context.sigma[:2]
        lines[index] = TargetLine.of_motion(first, velocity, scans, context.interval, (sigma_x, sigma_y))
    return lines


def _greatest_departure(scenario: Scenario) -> float:
    """Return how far the path of any target departs from its line, without noise."""
    states, away = World.of(scenario).planned_states, [0.0]
    for index, line in moving_targets(scenario).items():
        assert line.theta is not None
        assert line.middle is not None
        apart = states.paths(0)[index][:, :2] - line.middle
        away.append(float(np.abs(apart @ [math.cos(line.theta), math.sin(line.theta)]).max(initial=0.0)))
    return max(away)


def question_of(scenario: Scenario, demands: Demands | None = None) -> Question:
    """Return the question of a scenario: its targets' lines, each as long as it is, in its clutter.

    Raises
    ------
    RequestError
        Where no target moves, or a demand is not allowed.
    """
    lines = tuple(moving_targets(scenario).values())
    if not lines:
        raise RequestError(
            f"{scenario.name}: there is no target that moves, so no line to design a quantisation for"
        )
    return _question(scenario, lines, demands or Demands())


def scenario_design(name: str, assignments: Sequence[str], demands: Demands) -> Design:
    """Return the design for a scenario, given as SET or SET:SCENARIO, with some numeric fields changed.

    Raises
    ------
    RequestError
        Where there is none of that name, a change or a demand is not allowed, or no target moves.
    """
    set_name, _, scenario_name = name.partition(":")
    scenario = changed(chosen_scenario(load_set(set_name), scenario_name or None), assignments)
    names = tuple(scenario.targets[index].name or f"target {index}" for index in moving_targets(scenario))
    return Design(question_of(scenario, demands), (scenario,), names, taken_for(scenario))


def taken_for(scenario: Scenario) -> dict[str, str]:
    """Return in words what of a scenario a question takes for something simpler."""
    found = {}
    if any(not target.motion.is_straight for target in scenario.targets):
        found["motion"] = (
            "straight, along the line fitted to each path; paths depart from it by up to "
            f"{_greatest_departure(scenario):.3g} {scenario.unit.value}"
        )
        if any(target.motion.is_disturbed for target in scenario.targets):
            found["motion"] += " and by their process noise"
    if any(isinstance(sensor, PolarSensor) for sensor in scenario.sensors):
        found["noise"] = "everywhere that in the middle of the sensor's sector"
    if any(source.over in ("volume", "sector") for source in scenario.clutter):
        found["clutter"] = (
            "uniform over the region; a sector fills part of it only, and gives more false cells than that"
        )
    return found


def sensing_design(sensing: Sensing, demands: Demands, seed: int, assumed: dict[str, str]) -> Design:
    """Return the design for a target of known speed that may be anywhere in the region.

    Parameters
    ----------
    sensing : what is known
    demands : on the quantisation
    seed : of the places and headings in trials
    assumed : what of it nobody said, in words
    """
    region = {"x": [sensing.region.lower[0], sensing.region.upper[0]],
              "y": [sensing.region.lower[1], sensing.region.upper[1]]}  # fmt: skip
    scenario = validated(
        Scenario,
        {
            "name": "options",
            "unit": sensing.unit.value,
            "scans": sensing.scans,
            "interval": sensing.interval,
            "region": region,
            "sensor": {"sigma": sensing.sigma, "detection_probability": sensing.detection_probability},
            "clutter": [{"rate": sensing.clutter}],
        },
        "options",
    )
    elapsed = (sensing.scans - 1) * sensing.interval
    line = TargetLine(sensing.sigma, sensing.scans, sensing.speed * elapsed)
    scenarios = []
    random = np.random.default_rng(seed)
    for _ in range(PLACEMENTS):
        middle = random.uniform(sensing.region.lower, sensing.region.upper)
        heading = random.uniform(0.0, 2.0 * math.pi)
        velocity = sensing.speed * np.array([math.cos(heading), math.sin(heading)])
        first = middle - 0.5 * elapsed * velocity
        target = validated(Target, {"position": first.tolist(), "velocity": velocity.tolist()}, "options")
        scenarios.append(scenario.model_copy(update={"targets": [target]}))
    return Design(_question(scenario, (line,), demands), tuple(scenarios), ("target",), assumed)


def _question(scenario: Scenario, lines: tuple[TargetLine, ...], demands: Demands) -> Question:
    return Question(
        lines,
        scenario.context.detection_probability,
        _clutter(scenario),
        scenario.box.plane,
        demands.false_cells,
        demands.kappa,
        demands.separation,
        demands.confidence,
    )


def _clutter(scenario: Scenario) -> Clutter:
    sources = tuple(
        ClutterSource(source.expected(scenario.context.scans), scenario.area(source).plane)
        for source in scenario.clutter
    )
    return Clutter(sources, all(isinstance(source, ExactClutter) for source in scenario.clutter))
