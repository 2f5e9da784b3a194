"""Range rings and azimuth spokes: where they lie, and that they never cover what is measured."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hough_tui.ui.drawing.graticule import RINGS, Sector, graticule
from hough_tui.ui.drawing.viewport import Limits, Viewport
from tests.hough_tui.ui.test_plane import at, play, sparse, text

ALL_ROUND = Sector((50.0, 50.0), 0.0, 45.0, (0.0, 360.0))
FAN = Sector((0.0, 0.0), 1.0, 40.0, (-20.0, 20.0))


def polar(sector, points):
    """Return distances from the station, and azimuths within a turn of the sector's first one."""
    x, y = (np.asarray(points) - sector.station).T
    azimuth = np.degrees(np.arctan2(x, y))
    return np.hypot(x, y), azimuth


@pytest.mark.parametrize(
    ("sector", "limits", "ranges", "spokes"),
    [
        (FAN, Limits(-15.0, 15.0, 0.0, 42.0), ["10", "20", "30"], ["-20°", "-10°", "0°", "10°", "20°"]),
        (
            ALL_ROUND,
            Limits(0.0, 100.0, 0.0, 100.0),
            ["10", "20", "30", "40"],
            [f"{azimuth}°" for azimuth in range(0, 360, 30)],
        ),
        # A window far out: rings and spokes come closer to one another, as the figures of the axes do.
        (FAN, Limits(-1.0, 1.0, 30.0, 32.0), ["30.0", "30.5", "31.0", "31.5", "32.0"], ["-1°", "0°", "1°"]),
    ],
    ids=["a fan", "all round", "zoomed in"],
)
def test_rings_and_spokes_are_round_and_within_the_sector(sector, limits, ranges, spokes):
    made = graticule((sector,), Viewport(limits, 80, 40))
    words = [figure.words for figure in made.figures]
    assert [word for word in words if not word.endswith("°")] == ranges
    assert [word for word in words if word.endswith("°")] == spokes
    for figure, line in zip(made.figures, made.lines, strict=True):
        distance, azimuth = polar(sector, line)
        wanted = float(figure.words.rstrip("°"))
        if figure.words.endswith("°"):
            assert np.allclose((azimuth - wanted + 180.0) % 360.0, 180.0)
        else:
            assert np.allclose(distance, wanted)
            if not sector.is_whole_turn:
                assert azimuth.min() >= sector.azimuth[0] - 1e-9
                assert azimuth.max() <= sector.azimuth[1] + 1e-9
        assert distance.max() <= sector.far + 1e-9
        assert distance.min() >= sector.near - 1e-9


@given(
    x=st.floats(-100, 100),
    y=st.floats(-100, 100),
    width=st.floats(0.01, 200),
    height=st.floats(0.01, 200),
    first=st.floats(-360, 360),
    span=st.floats(1, 360),
)
def test_every_ring_in_view_is_drawn_wherever_one_looks(x, y, width, height, first, span):
    sector = Sector((3.0, -7.0), 2.0, 90.0, (first, first + span))
    limits = Limits(x, x + width, y, y + height)
    made = graticule((sector,), Viewport(limits, 80, 40))
    rings = {}
    for figure, line in zip(made.figures, made.lines, strict=True):
        if not figure.words.endswith("°"):
            rings.setdefault(figure.words, []).append(line)
    assert len(rings) <= RINGS + 1
    for words, lines in rings.items():
        # Points of the ring that lie in the view and in the sector lie on what is drawn, too.
        drawn, distance = np.concatenate(lines), np.hypot(*(lines[0][0] - sector.station))
        assert distance == pytest.approx(float(words), abs=1e-5)
        points = sector.at(distance, np.linspace(first, first + span, 721))
        points = points[limits.holds(points[:, 0], points[:, 1])]
        gaps = np.linalg.norm(points[:, None] - drawn[None], axis=-1).min(axis=1, initial=math.inf)
        apart = max(np.linalg.norm(np.diff(line, axis=0), axis=1).max() for line in lines)
        assert (gaps <= apart + 1e-6).all()


def test_a_sector_out_of_view_draws_nothing_and_several_stations_share_a_step():
    made = graticule((FAN,), Viewport(Limits(-10.0, 10.0, -30.0, -5.0), 80, 40))
    assert not made.lines
    far = Sector((60.0, 0.0), 1.0, 40.0, (-90.0, 0.0))
    made = graticule((FAN, far), Viewport(Limits(-20.0, 80.0, 0.0, 45.0), 80, 40))
    words = [figure.words for figure in made.figures]
    assert words.count("10") == words.count("20") == words.count("30") == 2


def test_plots_lie_above_rings_and_no_figure_covers_one():
    random = np.random.default_rng(4)
    points = [tuple(point) for point in random.uniform(5, 95, (300, 2)).tolist()]

    async def journey(app, plane, pilot):
        bare = [at(plane, *point) for point in points]
        plane.show(sparse(*points, sectors=(ALL_ROUND,)))
        await pilot.pause()
        # Character by character and colour by colour, plots are what they were without rings.
        assert [at(plane, *point) for point in points] == bare
        assert "30" in text(plane)
        # An empty place on a ring is not empty.
        empty = [
            azimuth
            for azimuth in range(0, 360, 3)
            if np.linalg.norm(np.array(points) - ALL_ROUND.at(40.0, azimuth), axis=1).min() > 4.0
        ]
        assert empty
        drawn = [at(plane, *ALL_ROUND.at(40.0, azimuth).tolist())[0] for azimuth in empty]
        assert sum(character != " " for character in drawn) > 0.5 * len(drawn)

    play(sparse(*points), journey)
