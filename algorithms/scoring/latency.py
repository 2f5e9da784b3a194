"""Latency: how many scans pass from a target's first to the confirmation of a track on it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def scans_to_initiate(confirmed: NDArray[np.int64], present: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return how many scans each target was there for until its first track was confirmed, that scan counted.

    Parameters
    ----------
    confirmed : int64 (trials, targets), the scan in which the first track on each target was confirmed; −1
        for none
    present : bool (scans, targets), whether each target is there in a scan

    Returns
    -------
    int64 (trials, targets), at least 1; −1 where there is no such track
    """
    if confirmed.shape[1] != present.shape[1]:
        raise ValueError(f"{confirmed.shape[1]} targets have confirmations, {present.shape[1]} have scans")
    if confirmed.size == 0:
        return confirmed
    first = present.argmax(axis=0)
    # A track of clutter may be confirmed before its target comes and still match it.
    return np.where(confirmed >= 0, np.maximum(confirmed - first + 1, 1), -1)
