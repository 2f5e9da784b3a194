"""From arrays of characters and styles to lines of segments."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

BLANK = ord(" ")

Codes = NDArray[np.uint32]


def text(codes: Codes) -> str:
    """Return code points as one string, row after row."""
    return codes.astype("<u4", copy=False).tobytes().decode("utf-32-le")


def strips(codes: Codes, paint: NDArray[np.integer], styles: Sequence[Style | None]) -> list[Strip]:
    """Return the rows of an array of characters, neighbours of one style in one segment.

    Parameters
    ----------
    codes : uint32 (rows, columns), code points of characters one cell wide
    paint : int (rows, columns), the style of each, as an index
    styles : what the indices stand for
    """
    rows, columns = codes.shape
    begins = np.ones((rows, columns), np.bool_)
    begins[:, 1:] = paint[:, 1:] != paint[:, :-1]
    starts = np.flatnonzero(begins)
    return cut(text(codes), starts, [styles[index] for index in paint.ravel()[starts].tolist()], columns)


def cut(
    characters: str, starts: NDArray[np.integer], styles: Sequence[Style | None], columns: int
) -> list[Strip]:
    """Return lines cut out of the characters of a whole picture.

    Parameters
    ----------
    characters : row after row
    starts : where each segment begins, ascending; every row begins with a new one
    styles : of the segments
    columns : length of a row
    """
    places = starts.tolist()
    segments = [
        Segment(characters[start:end], style)
        for start, end, style in zip(places, [*places[1:], len(characters)], styles, strict=True)
    ]
    firsts = np.searchsorted(starts, np.arange(0, len(characters) + 1, columns)).tolist()
    return [Strip(segments[first:last], columns) for first, last in pairwise(firsts)]
