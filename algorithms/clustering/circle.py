"""Doppler as the circle that it is: cut open where no target lies, and folded again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel


@kernel
def cut_open(doppler, offsets, span):  # type: ignore[no-untyped-def]
    """Return Dopplers with the circle that they lie on cut in its widest gap, scan by scan.

    Parameters
    ----------
    doppler : float64 (n,)
    offsets : int64 (scans + 1,), where each scan begins, and the end of the last
    span : float64 (scans,), length of the circle, in the unit of the Dopplers

    Returns
    -------
    float64 (n,); what lies below the cut is moved up by the span
    """
    opened = doppler.copy()
    for scan in range(len(offsets) - 1):
        begin, end = offsets[scan], offsets[scan + 1]
        if end - begin < 2:
            continue
        rising = np.sort(doppler[begin:end])
        # Where the gap over the fold is the widest, as it mostly is, nothing moves.
        widest, cut = rising[0] + span[scan] - rising[-1], -np.inf
        for index in range(1, end - begin):
            gap = rising[index] - rising[index - 1]
            if gap > widest:
                widest, cut = gap, rising[index - 1]
        for point in range(begin, end):
            if doppler[point] <= cut:
                opened[point] += span[scan]
    return opened


def lowest(doppler: NDArray[np.float64], span: float) -> float | None:
    """Return where the circle begins: at 0 where no Doppler is negative, else half a span below 0.

    Parameters
    ----------
    doppler : float64 (n,)
    span : length of the circle

    Returns
    -------
    None where the Dopplers do not lie within one span from there.
    """
    low = 0.0 if doppler.min(initial=0.0) >= 0.0 else -0.5 * span
    rounding = 1e-9 * span
    is_within = np.all((doppler >= low - rounding) & (doppler <= low + span + rounding))
    return low if is_within else None


def folded(doppler: float, low: float, span: float) -> float:
    """Return the Doppler on the circle that begins at `low`; one that lies there already is not touched."""
    return doppler if low <= doppler <= low + span else low + (doppler - low) % span
