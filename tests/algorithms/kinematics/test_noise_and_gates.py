from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from algorithms.context import Context, Unit
from algorithms.kinematics.gates import SpeedGate, can_fly, chi_square_gate, fit_limits
from algorithms.kinematics.noise import LEAST_DEVIATION, covariances
from algorithms.plots import PlotChunk


def test_noise_is_that_of_the_plots_else_that_of_the_context():
    flat = PlotChunk(np.arange(2, dtype=np.int32), np.arange(2.0), np.zeros((2, 3)), np.array([0, 2]))
    context = Context(4, 1.0, sigma=(2.0, 3.0), unit=Unit.KILOMETRE)
    least = (LEAST_DEVIATION / 1000.0) ** 2
    np.testing.assert_allclose(
        covariances(flat, context, 3), [np.diag([4.0, 9.0, 9.0]) + least * np.eye(3)], rtol=1e-15
    )
    in_space = replace(context, sigma=(2.0, 3.0, 1.0))
    np.testing.assert_allclose(covariances(flat, in_space, 3)[0].diagonal(), [4.0, 9.0, 1.0], rtol=1e-9)
    assert covariances(flat, in_space, 2).shape == (1, 2, 2)
    own = np.tile(5.0 * np.eye(3), (2, 1, 1))
    np.testing.assert_allclose(
        covariances(replace(flat, covariance=own), context, 2), own[:, :2, :2], rtol=1e-9
    )
    exact = covariances(replace(flat, covariance=0.0 * own), context, 3)
    np.testing.assert_allclose(exact[0], least * np.eye(3), rtol=1e-12)
    assert covariances(flat, replace(context, sigma=None), 3) is None


def test_limits_are_those_of_chi_squared():
    for dimensions in (2, 3):
        limits = fit_limits(0.99, 5, dimensions)
        freedom = dimensions * np.array([1, 2, 3])
        assert np.isinf(limits[:, :3]).all()
        np.testing.assert_allclose(limits[0, 3:], stats.chi2(freedom).ppf(0.99))
        np.testing.assert_allclose(limits[1, 3:], stats.chi2(freedom).isf(1e-4))
        assert chi_square_gate(0.99, dimensions) == pytest.approx(stats.chi2(dimensions).ppf(0.99))
    with pytest.raises(ValueError, match="between 0 and 1"):
        chi_square_gate(1.0, 2)


@pytest.mark.parametrize(("distance", "inside"), [(93.9, False), (94.1, True), (805.9, True), (806.1, False)])
def test_a_speed_gate_allows_for_noise(distance, inside):
    assert can_fly(SpeedGate(50.0, 400.0, 3.0), distance, 2.0, 2.0) == inside
