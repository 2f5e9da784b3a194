"""Least and greatest speed of a target, as parameters."""

from __future__ import annotations

from typing import ClassVar, Self

from pydantic import model_validator

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.parameters import Auto, Dimension, NotNegative, Parameters, Positive, parameter


class SpeedParameters(Parameters):
    """The parameters of every initiator with a gate on the speed.

    Attributes
    ----------
    slowest, fastest : default speeds, in m/s
    """

    slowest: ClassVar[float] = 50.0
    fastest: ClassVar[float] = 400.0

    speed_min: NotNegative | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the least speed of a target", auto="50 m/s"
    )
    speed_max: Positive | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the greatest speed of a target", auto="400 m/s"
    )

    @model_validator(mode="after")
    def _speeds_in_order(self) -> Self:
        if not isinstance(self.speed_min, str) and not isinstance(self.speed_max, str):
            if self.speed_min >= self.speed_max:
                raise ValueError(
                    f"speed_min {self.speed_min:g} is given with speed_max {self.speed_max:g}; "
                    "speed_min must be the smaller one"
                )
        return self

    def resolved(self, context: Context) -> Self:
        """Return these parameters with the speeds worked out from the unit.

        Raises
        ------
        RequestError
            Where one speed is given and lies beyond the other's default.
        """
        metres = context.unit.metres
        slowest = self.slowest / metres if self.speed_min == "auto" else float(self.speed_min)
        fastest = self.fastest / metres if self.speed_max == "auto" else float(self.speed_max)
        if slowest >= fastest:
            raise RequestError(
                f"speed_min is {slowest:g} and speed_max {fastest:g} {context.unit}/s; "
                "speed_min must be the smaller one; give both"
            )
        return self.model_copy(update={"speed_min": slowest, "speed_max": fastest})
