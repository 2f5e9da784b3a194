"""Strips of a scan: its plots sorted by x, so that those within reach of a place are one run."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel


@kernel
def by_x(position, scan):  # type: ignore[no-untyped-def]
    """Return the plots of one batch sorted by scan, then x, and where each scan begins among them.

    Returns
    -------
    order : int64 (n,)
    begins : int64 (scans with plots + 1,)
    """
    count = len(scan)
    order = np.empty(count, np.int64)
    begins = np.empty(count + 1, np.int64)
    scans, first = 0, 0
    while first < count:
        end = first
        while end < count and scan[end] == scan[first]:
            end += 1
        order[first:end] = first + np.argsort(position[first:end, 0])
        begins[scans] = first
        scans += 1
        first = end
    begins[scans] = count
    return order, begins[: scans + 1]


@kernel
def strip(places, place, reach):  # type: ignore[no-untyped-def]
    """Return begin and end of the run of sorted places that are within reach of one along their axis."""
    begin = np.searchsorted(places, place - reach)
    return begin, begin + np.searchsorted(places[begin:], place + reach, side="right")
