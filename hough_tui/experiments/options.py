"""What the options of a command say of the sensor, checked."""

from __future__ import annotations

import math

from algorithms.context import Box, Unit
from algorithms.errors import RequestError
from algorithms.parameters import unknown
from hough_tui.experiments.initiation import Known


def window(text: str | None) -> tuple[int, int] | None:
    """Return the first scan and the one after the last of `A:B`; None where nothing is given.

    Raises
    ------
    RequestError
        Where it has not that form, or holds no scan.
    """
    if text is None:
        return None
    first, colon, end = text.partition(":")
    if not colon or not first.isdecimal() or not end.isdecimal() or int(first) >= int(end):
        raise RequestError(f"--scans {text}: it must be A:B, whole numbers with A less than B, such as 0:15")
    return int(first), int(end)


def known_sensor(
    sigma: float | None,
    detection_probability: float | None,
    unit: str | None,
    region: str | None,
    interval: float | None,
) -> Known:
    """Return what options say of the sensor.

    Raises
    ------
    RequestError
        Where a value is not allowed.
    """
    _must(sigma is None or (math.isfinite(sigma) and sigma >= 0), f"--sigma {sigma}: it must be at least 0")
    _must(
        detection_probability is None or 0 < detection_probability <= 1,
        f"--detection-probability {detection_probability}: it must be greater than 0 and at most 1",
    )
    _must(
        interval is None or (math.isfinite(interval) and interval > 0),
        f"--interval {interval}: it must be greater than 0",
    )
    units = [known.value for known in Unit]
    _must(unit is None or unit in units, f"--unit: {unknown(unit or '', units, 'unit')}")
    return Known(sigma, detection_probability, Unit(unit) if unit else None, _region(region))


def _region(text: str | None) -> Box | None:
    if text is None:
        return None
    try:
        west, east, south, north = map(float, text.split(","))
    except ValueError:
        raise RequestError(f"--region {text}: it must be X0,X1,Y0,Y1, four numbers") from None
    _must(
        all(map(math.isfinite, (west, east, south, north))) and west < east and south < north,
        f"--region {text}: X0 must be less than X1, and Y0 less than Y1",
    )
    return Box((west, south), (east, north))


def _must(condition: bool, message: str) -> None:
    if not condition:
        raise RequestError(message)
