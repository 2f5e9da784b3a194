"""What the options of a command say of the sensor, checked."""

from __future__ import annotations

from algorithms.context import Box, Unit
from algorithms.errors import RequestError
from algorithms.parameters import LEAST, Deviation, NotNegative, Number, Positive, checked, unknown
from hough_tui.quantisation.designs import Demands, Sensing
from hough_tui.recorded.initiation import Known


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
    checked(sigma, Deviation | None, "--sigma")
    _must(
        detection_probability is None or 0 < detection_probability <= 1,
        f"--detection-probability {detection_probability}: it must be greater than 0 and at most 1",
    )
    checked(interval, Positive | None, "--interval")
    units = [known.value for known in Unit]
    _must(unit is None or unit in units, f"--unit: {unknown(unit or '', units, 'unit')}")
    return Known(sigma, detection_probability, Unit(unit) if unit else None, _region(region))


def sensing(
    known: Known,
    scans: int | None,
    interval: float | None,
    clutter: float | None,
    speed: float | None,
    extent: float | None,
) -> tuple[Sensing, dict[str, str]]:
    """Return what options say of a sensor and a target, and in words what of it was assumed.

    Raises
    ------
    RequestError
        Where something is missing or not allowed.
    """
    needed = {
        "--sigma": known.sigma,
        "--scans": scans,
        "--clutter": clutter,
        "--region": known.region,
        "--speed (or --extent)": speed if extent is None else extent,
        "--interval": interval if extent is None else 1.0,
    }
    missing = [name for name, value in needed.items() if value is None]
    _must(not missing, f"give a scenario, SET or SET:SCENARIO, or all options; missing: {', '.join(missing)}")
    assert known.sigma is not None
    assert known.region is not None
    assert scans is not None
    assert clutter is not None
    _must(speed is None or extent is None, "--speed and --extent say the same thing: give one of them")
    checked(clutter, NotNegative, "--clutter")
    spacing = 1.0 if interval is None else interval
    if extent is not None:
        checked(extent, Positive, "--extent")
        _must(scans > 1, "--extent: a line has one with two scans or more; give more --scans, or a --speed")
        speed = extent / ((scans - 1) * spacing)
    assert speed is not None
    checked(speed, Positive, "--speed")
    assumed = {}
    if known.detection_probability is None:
        assumed["detection_probability"] = "1"
    if known.unit is None:
        assumed["unit"] = Unit.KILOMETRE.value
    probability = 1.0 if known.detection_probability is None else known.detection_probability
    unit = known.unit or Unit.KILOMETRE
    found = Sensing(known.sigma, scans, spacing, probability, clutter, known.region, speed, unit)
    return found, assumed


def demands(false_cells: float, kappa: float, separation: float | None, confidence: float) -> Demands:
    """Return what options demand of a quantisation.

    Raises
    ------
    RequestError
        Where a value is not allowed.
    """
    for name, value in (("--false-cells", false_cells), ("--kappa", kappa), ("--separation", separation)):
        checked(value, Positive | None, name)
    _must(0 < confidence < 1, f"--confidence {confidence}: it must lie between 0 and 1")
    return Demands(false_cells, kappa, separation, confidence)


def _region(text: str | None) -> Box | None:
    if text is None:
        return None
    try:
        west, east, south, north = map(float, text.split(","))
    except ValueError:
        raise RequestError(f"--region {text}: it must be X0,X1,Y0,Y1, four numbers") from None
    for bound in (west, east, south, north):
        checked(bound, Number, f"--region {text}:")
    _must(
        east - west >= LEAST and north - south >= LEAST,
        f"--region {text}: X0 must be less than X1, and Y0 less than Y1",
    )
    return Box((west, south), (east, north))


def _must(condition: bool, message: str) -> None:
    if not condition:
        raise RequestError(message)
