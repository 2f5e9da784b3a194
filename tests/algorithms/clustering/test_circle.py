"""Doppler as a circle: where it is cut open, and that no choice of its beginning matters."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from algorithms.clustering.circle import cut_open, folded, lowest


def brute(doppler, span):
    """Return the points from the first after the widest gap of the circle on, as they follow each other."""
    rising = np.sort(doppler)
    gaps = np.diff(np.append(rising, rising[0] + span))
    after = (int(np.argmax(gaps)) + 1) % len(rising)
    first = rising[after]
    return np.where(doppler < first, doppler + span, doppler)


@given(seed=st.integers(0, 2**16), count=st.integers(1, 30), shift=st.floats(0.0, 1.0))
def test_the_circle_is_cut_in_its_widest_gap_wherever_it_begins(seed, count, shift):
    span = 40.0
    doppler = np.random.default_rng(seed).uniform(-20.0, 20.0, count)
    offsets, spans = np.array([0, count]), np.array([span])
    opened = cut_open(doppler, offsets, spans)
    assert opened == pytest.approx(brute(doppler, span))
    turned = np.array([folded(value + shift * span, -20.0, span) for value in doppler])
    again = cut_open(turned, offsets, spans)
    # The points follow each other as before, at the same distances.
    assert again - again.min() == pytest.approx(opened - opened.min(), abs=1e-9)


def test_each_scan_is_cut_by_itself():
    doppler = np.array([-19.0, 19.0, -10.0, 0.0, 5.0])
    opened = cut_open(doppler, np.array([0, 2, 2, 5]), np.array([40.0, 40.0, 40.0]))
    assert opened.tolist() == [21.0, 19.0, -10.0, 0.0, 5.0]


@pytest.mark.parametrize(
    ("doppler", "low"),
    [
        ([-20.0, 20.0], -20.0),
        ([0.0, 40.0], 0.0),
        ([0.0, 40.1], None),
        ([-20.1, 0.0], None),
        ([-1.0, 30.0], None),
    ],
)
def test_dopplers_lie_about_zero_or_from_zero_on(doppler, low):
    assert lowest(np.array(doppler), 40.0) == low


def test_what_lies_on_the_circle_is_not_touched():
    assert folded(0.1, -20.0, 40.0) == 0.1
    assert folded(21.0, -20.0, 40.0) == pytest.approx(-19.0)
    assert folded(43.0, 0.0, 40.0) == pytest.approx(3.0)
