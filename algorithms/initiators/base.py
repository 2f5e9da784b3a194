"""What an initiator is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Literal

import numpy as np

from algorithms.context import Context
from algorithms.hough.voting import Accumulator
from algorithms.kinematics.states import with_states
from algorithms.parameters import Parameters
from algorithms.plots import PlotChunk, Plots
from algorithms.space.planes import PlaneVotes
from algorithms.tracks import TrackChunk, Tracks


class Initiator(ABC):
    """An algorithm from plots to tracks.

    An initiator in plain Python gives `initiate` alone; its trials then run in worker
    processes. One whose kernels release the interpreter's lock is a `ChunkInitiator`: its
    chunks run in threads.

    Attributes
    ----------
    name : what it is called everywhere
    summary : one line for people
    source : where it is published
    parameters : the model that declares its parameters
    dimensions : 2 where it works in the plane (x, y), whatever plots it is given; 3 in space
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    source: ClassVar[str] = ""
    parameters: ClassVar[type[Parameters]]
    dimensions: ClassVar[Literal[2, 3]] = 2

    @abstractmethod
    def initiate(self, plots: Plots, context: Context, parameters: Any) -> Tracks:
        """Return the tracks of one batch of plots.

        Parameters
        ----------
        plots : the batch, sorted by scan
        context : what is known of the sensor
        parameters : resolved parameters, of the type that the initiator declares
        """

    def strongest(self, plots: Plots, context: Context, parameters: Any, most: int) -> tuple[Tracks, int]:
        """Return the tracks with the highest scores, the highest first, and how many there are in all."""
        tracks = self.initiate(plots, context, parameters)
        return tracks.select(np.argsort(-tracks.score, kind="stable")[:most]), len(tracks)

    def accumulator(self, plots: Plots, context: Context, parameters: Any) -> Accumulator | None:
        """Return the votes of one batch; None for an initiator that has no accumulator."""
        return None

    def plane_votes(self, plots: Plots, context: Context, parameters: Any) -> PlaneVotes | None:
        """Return the votes of pairs of plots in three planes; None for an initiator that has none."""
        return None


class ChunkInitiator(Initiator):
    """An initiator that works on a chunk of trials in compiled code."""

    @abstractmethod
    def initiate_chunk(self, chunk: PlotChunk, context: Context, parameters: Any) -> TrackChunk:
        """Return the tracks of each trial of a chunk, as lines.

        Where a track can be declared before the last scan of the batch, `confirmed_scan` says so.
        """

    @abstractmethod
    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks of `initiate_chunk` with their plots."""

    def tracks_of_chunk(
        self, chunk: PlotChunk, context: Context, parameters: Any, *, plots: bool, states: bool
    ) -> TrackChunk:
        """Return the tracks of each trial with their scans of confirmation and what else is asked for.

        Parameters
        ----------
        plots : whether tracks need their plots
        states : whether they need their kinematic states, and so their plots, too
        """
        tracks = self.initiate_chunk(chunk, context, parameters).with_confirmation(context.scans - 1)
        if plots or states:
            tracks = self.associate_chunk(chunk, tracks, context, parameters)
        return with_states(chunk, tracks, context, self.dimensions) if states else tracks

    def initiate(self, plots: Plots, context: Context, parameters: Any) -> Tracks:
        """Return the tracks of one batch, with their plots and kinematic states."""
        return self.tracks_of_chunk(plots.chunk(), context, parameters, plots=True, states=True).only_trial

    def strongest(self, plots: Plots, context: Context, parameters: Any, most: int) -> tuple[Tracks, int]:
        """Return the tracks with the highest scores; the others are not associated with plots."""
        chunk = plots.chunk()
        tracks = self.tracks_of_chunk(chunk, context, parameters, plots=False, states=False)
        strongest = self.associate_chunk(chunk, tracks.strongest(most), context, parameters)
        strongest = with_states(chunk, strongest, context, self.dimensions)
        return strongest.only_trial, len(tracks.theta)
