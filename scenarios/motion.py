"""Motions of targets: where each has come and how fast it moves, in closed form, at times since its birth.

A motion begins with the position and the velocity that its target declares. What it adds to them (an
acceleration, a rate of turn, waypoints) and the noise that disturbs it are declared here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from algorithms.parameters import LEAST, Declared, Dimension, NotNegative, Number, parameter, with_default
from scenarios.sensors import Place

Array = NDArray[np.float64]
Course = tuple[Array, Array]
"""Displacement from the start, and velocity: float64 (n, d) each, at n times."""

TurnRate = Annotated[Number, Field(ge=-360, le=360)]


class Motion(Declared):
    """Motion of a target: what moves it beside its velocity, and the noise of that."""

    kind: str = parameter("constant-velocity", help="how it moves")
    process_noise: (
        NotNegative | tuple[NotNegative, NotNegative] | tuple[NotNegative, NotNegative, NotNegative]
    ) = parameter(
        0.0,
        dimension=Dimension.ACCELERATION,
        help="standard deviation of a random acceleration that is drawn in each interval, one number or one "
        "an axis",
    )

    @property
    def is_straight(self) -> bool:
        """Whether its path is a line on which every draw has the same velocity."""
        return False

    @property
    def is_disturbed(self) -> bool:
        """Whether it differs from draw to draw."""
        noise = self.process_noise
        return any(noise) if isinstance(noise, tuple) else noise > 0.0

    def noise_axes(self, dimensions: int) -> tuple[float, ...]:
        """Return the standard deviation of the random acceleration on each axis."""
        noise = self.process_noise
        return noise if isinstance(noise, tuple) else (noise,) * dimensions

    def vectors(self) -> Iterator[tuple[str, tuple[float, ...]]]:
        """Yield the vectors of the motion by name, which must have as many numbers as the position."""
        if isinstance(self.process_noise, tuple):
            yield "process_noise", self.process_noise

    def refusal(self, position: Place, velocity: Place) -> str | None:
        """Return why a target cannot begin this motion with a position and a velocity; None where it can."""
        return None

    def stands_still(self, position: Place, velocity: Place) -> bool:
        """Return whether a target stays where it is in the plane (x, y), but for noise."""
        return not any(velocity[:2])

    def course(self, start: Array, velocity: Array, elapsed: Array) -> Course:
        """Return how far a target has come, and its velocity, without noise.

        Parameters
        ----------
        start, velocity : float64 (d,), at birth
        elapsed : float64 (n,), seconds since then
        """
        raise NotImplementedError


class ConstantVelocity(Motion):
    """Motion along a line at the velocity of the target."""

    kind: Literal["constant-velocity"] = with_default(Motion, "kind", "constant-velocity")

    @property
    def is_straight(self) -> bool:
        """Whether its path is a line on which every draw has the same velocity."""
        return not self.is_disturbed

    def course(self, start: Array, velocity: Array, elapsed: Array) -> Course:
        """Return v·t and v."""
        return elapsed[:, None] * velocity, np.tile(velocity, (len(elapsed), 1))


class Acceleration(Motion):
    """Motion at a constant acceleration."""

    kind: Literal["acceleration"] = with_default(Motion, "kind", "acceleration")
    acceleration: Place = parameter(
        dimension=Dimension.ACCELERATION,
        help="[ax, ay, az], in the unit of length a second squared; az in space only",
    )

    def vectors(self) -> Iterator[tuple[str, tuple[float, ...]]]:
        """Yield the noise, where it is a vector, and the acceleration."""
        yield from super().vectors()
        yield "acceleration", self.acceleration

    def stands_still(self, position: Place, velocity: Place) -> bool:
        """Return whether neither velocity nor acceleration moves it in the plane."""
        return not any((*velocity[:2], *self.acceleration[:2]))

    def course(self, start: Array, velocity: Array, elapsed: Array) -> Course:
        """Return v·t + a·t²/2 and v + a·t."""
        time, acceleration = elapsed[:, None], np.array(self.acceleration)
        return time * velocity + 0.5 * time**2 * acceleration, velocity + time * acceleration


class Turn(Motion):
    """Motion in a coordinated turn: at constant speed on a horizontal circle, in space at a constant vz.

    The rate is that of the heading, which is counted clockwise from north: a positive one turns right.
    """

    kind: Literal["turn"] = with_default(Motion, "kind", "turn")
    rate_deg: TurnRate = parameter(
        dimension=Dimension.TURN_RATE,
        help="how fast its heading changes, degrees a second, to the right; negative to the left",
    )

    def course(self, start: Array, velocity: Array, elapsed: Array) -> Course:
        """Return t·sinc(φ/2)·R(φ/2)·v and R(φ)·v, with φ = ω·t the angle that it has turned by at t.

        R turns clockwise. Nothing is divided by ω in this form: a slow turn is as exact as a fast one.
        """
        angle = math.radians(self.rate_deg) * elapsed
        displacement, speed = elapsed[:, None] * velocity, np.tile(velocity, (len(elapsed), 1))
        chord = (elapsed * np.sinc(0.5 * angle / np.pi))[:, None]
        displacement[:, :2] = chord * _turned(velocity, 0.5 * angle)
        speed[:, :2] = _turned(velocity, angle)
        return displacement, speed


class Waypoints(Motion):
    """Motion through points, on straight legs, at the speed of the target; beyond the last straight on."""

    kind: Literal["waypoints"] = with_default(Motion, "kind", "waypoints")
    points: list[Place] = parameter(
        dimension=Dimension.LENGTH,
        min_length=1,
        help="where it flies, one after the other, at the speed of its velocity, whose direction does not "
        "count",
    )

    def vectors(self) -> Iterator[tuple[str, tuple[float, ...]]]:
        """Yield the noise, where it is a vector, and the points."""
        yield from super().vectors()
        for index, point in enumerate(self.points):
            yield f"points[{index}]", point

    def refusal(self, position: Place, velocity: Place) -> str | None:
        """Return which leg has no length, or that there is no speed."""
        if math.hypot(*velocity) < LEAST:
            return "velocity is zero; the speed of a motion through waypoints must be greater than 0"
        names = ["position", *(f"motion.points[{index}]" for index in range(len(self.points)))]
        places = [position, *self.points]
        for index, (place, following) in enumerate(pairwise(places)):
            if math.dist(place, following) < LEAST:
                return f"{names[index + 1]} is where {names[index]} is; each leg must have a length"
        return None

    def stands_still(self, position: Place, velocity: Place) -> bool:
        """Return whether all legs are upright."""
        return all(point[:2] == position[:2] for point in self.points)

    def course(self, start: Array, velocity: Array, elapsed: Array) -> Course:
        """Return the way along the legs, and the velocity on the leg that is flown, at a point the next."""
        legs = np.diff(np.vstack([start, self.points]), axis=0)
        lengths = np.linalg.norm(legs, axis=1)
        speed = np.linalg.norm(velocity)
        begins = np.concatenate([[0.0], np.cumsum(lengths)[:-1]]) / speed
        # A time of birth that is rounded to just before it belongs to the first leg.
        leg = np.maximum(np.searchsorted(begins, elapsed, side="right") - 1, 0)
        along = legs[leg] / lengths[leg, None] * speed
        before = np.vstack([np.zeros_like(start), np.array(self.points)[:-1] - start])
        return before[leg] + (elapsed - begins[leg])[:, None] * along, along


def _turned(velocity: Array, angle: Array) -> Array:
    """Return the horizontal part of a velocity turned clockwise by angles, float64 (n, 2)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    east, north = velocity[:2]
    return np.stack([east * cosine + north * sine, north * cosine - east * sine], axis=1)


def motion_kind(given: Any) -> Any:
    """Return what kind of motion data or a model are."""
    if isinstance(given, Mapping):
        return given.get("kind", "constant-velocity")
    return getattr(given, "kind", None)


AnyMotion = Annotated[
    Annotated[ConstantVelocity, Tag("constant-velocity")]
    | Annotated[Acceleration, Tag("acceleration")]
    | Annotated[Turn, Tag("turn")]
    | Annotated[Waypoints, Tag("waypoints")],
    Discriminator(motion_kind),
]
