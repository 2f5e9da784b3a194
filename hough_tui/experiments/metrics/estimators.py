"""Estimators: from what each trial gave to one figure with its interval."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.intervals import (
    Z95,
    chi_square_quantile,
    count_interval,
    mean_interval,
    normal_interval,
    wilson,
)

Array = NDArray[np.float64]
Interval = tuple[float, float]

PER_TARGET = 2
"""Dimensions of values that have a second axis."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A figure over the trials of a cell.

    Attributes
    ----------
    value : a number, or one for each target or name; None where no trial says anything
    interval : its 95 % interval; None where there is none
    trials : how many trials say something
    """

    value: float | list[float] | dict[str, float] | None = None
    interval: Interval | None = None
    trials: int = 0


NOTHING = Estimate()
"""The estimate where no trial says anything."""


class Estimator(ABC):
    """How a figure comes from what each trial gave.

    Values have one row a trial, of one number or of one for each target; NaN where there is nothing to say.

    Attributes
    ----------
    has_interval : whether its figures have intervals
    is_number : whether its figure is one number
    is_by_target : whether its figure is one number for each target
    """

    has_interval: ClassVar[bool] = True
    is_number: ClassVar[bool] = True
    is_by_target: ClassVar[bool] = False

    @abstractmethod
    def estimate(self, values: Any) -> Estimate:
        """Return the figure of values."""

    def per_trial(self, values: Any) -> Array:
        """Return one number a trial, NaN where it says nothing: differences of cells pair these."""
        values = np.asarray(values, np.float64)
        return values if values.ndim < PER_TARGET else mean_over_targets(values)


@dataclass(frozen=True, slots=True)
class Share(Estimator):
    """Mean of values in [0, 1], with Wilson's interval for as many trials as they are worth."""

    def estimate(self, values: Any) -> Estimate:
        """Return the share."""
        values = _finite(values)
        if not len(values):
            return NOTHING
        return Estimate(float(values.mean()), mean_interval(values), len(values))


@dataclass(frozen=True, slots=True)
class MeanCount(Estimator):
    """Mean of counts; where nothing was counted at all the interval ends at that of a Poisson mean."""

    def estimate(self, values: Any) -> Estimate:
        """Return the mean."""
        values = _finite(values)
        if not len(values):
            return NOTHING
        interval = count_interval(values) if len(values) > 1 or not values.any() else None
        return Estimate(float(values.mean()), interval, len(values))


@dataclass(frozen=True, slots=True)
class Mean(Estimator):
    """Mean over all trials and targets, with the interval of the normal distribution.

    Attributes
    ----------
    least : what no value can lie below
    """

    least: float = -math.inf

    def estimate(self, values: Any) -> Estimate:
        """Return the mean."""
        mean, interval, trials = _pooled(np.asarray(values, np.float64))
        if mean is None:
            return NOTHING
        if interval is not None:
            interval = max(self.least, interval[0]), interval[1]
        return Estimate(mean, interval, trials)


@dataclass(frozen=True, slots=True)
class RootMeanSquare(Estimator):
    """Root of the mean of squares over all trials and targets; so is its interval, of that of the mean."""

    def estimate(self, values: Any) -> Estimate:
        """Return the root."""
        mean, interval, trials = _pooled(np.asarray(values, np.float64))
        if mean is None:
            return NOTHING
        if interval is not None:
            interval = math.sqrt(max(0.0, interval[0])), math.sqrt(interval[1])
        return Estimate(math.sqrt(mean), interval, trials)


class Squares(NamedTuple):
    """Normalised squares, each of which has a χ² distribution where what it is made of is right.

    Attributes
    ----------
    values : float64 (trials, targets), NaN where there is none
    components : how many components each is made of, the degrees of freedom of the distribution
    """

    values: Array
    components: int


@dataclass(frozen=True, slots=True)
class MeanSquare(Estimator):
    """Mean of normalised squares, with the interval by which their sum is χ² but for its scale.

    It holds their number of components exactly where the sum lies within the bounds of the test that asks
    whether they are what they should be.
    """

    def estimate(self, values: Squares) -> Estimate:
        """Return the mean."""
        finite = values.values[np.isfinite(values.values)]
        if not len(finite):
            return NOTHING
        total, freedom = float(finite.sum()), len(finite) * values.components
        ends = chi_square_quantile(0.975, freedom), chi_square_quantile(0.025, freedom)
        mean = total / len(finite)
        interval = mean * freedom / ends[0], mean * freedom / ends[1]
        return Estimate(mean, interval, int(np.isfinite(values.values).any(axis=1).sum()))

    def per_trial(self, values: Squares) -> Array:
        """Return the mean over the targets of each trial."""
        return mean_over_targets(values.values)


@dataclass(frozen=True, slots=True)
class Quantile(Estimator):
    """Quantile over all trials and targets: the least value that the share reaches.

    Attributes
    ----------
    share : of the values that are no greater
    """

    share: float

    def estimate(self, values: Any) -> Estimate:
        """Return the quantile; its interval ends at values whose ranks chance leaves open."""
        values = np.asarray(values, np.float64)
        ordered = np.sort(values[np.isfinite(values)])
        count = len(ordered)
        if not count:
            return NOTHING
        trials = int(np.isfinite(values).reshape(len(values), -1).any(axis=1).sum())
        # Targets of a trial may go together: ranks are as uncertain as those of so many trials.
        reach = Z95 * math.sqrt(self.share * (1.0 - self.share) / trials)
        ends = [self._at(ordered, self.share - reach), self._at(ordered, self.share + reach)]
        return Estimate(self._at(ordered, self.share), (ends[0], ends[1]), trials)

    @staticmethod
    def _at(ordered: Array, share: float) -> float:
        rank = math.ceil(share * len(ordered) - 1e-9) - 1
        return float(ordered[min(max(rank, 0), len(ordered) - 1)])


@dataclass(frozen=True, slots=True)
class PooledShare(Estimator):
    """Share of one count in another, both summed over the trials: values are (trials, 2), part and whole."""

    def estimate(self, values: Any) -> Estimate:
        """Return the share; the interval is Wilson's, for as many as the trials are worth."""
        values = np.asarray(values, np.float64)
        values = values[np.isfinite(values).all(axis=1) & (values[:, 1] > 0)]
        if not len(values):
            return NOTHING
        whole = float(values[:, 1].sum())
        lacking = values[:, 1] - values[:, 0]
        share = 1.0 - float(lacking.sum()) / whole
        trials = len(values)
        # Those of a trial may go together: the share is worth as many as its scatter over trials says.
        residuals = values[:, 0] - share * values[:, 1]
        variance = float((residuals**2).sum()) * trials / max(1, trials - 1) / whole**2
        worth = share * (1.0 - share) / variance if variance > 0.0 else float(trials)
        return Estimate(share, wilson(share, worth), trials)

    def per_trial(self, values: Any) -> Array:
        """Return the share of each trial."""
        values = np.asarray(values, np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            share: Array = values[:, 0] / values[:, 1]
        return np.where(values[:, 1] > 0, share, np.nan)


@dataclass(frozen=True, slots=True)
class Total(Estimator):
    """Number of trials of which something is true."""

    has_interval = False

    def estimate(self, values: Any) -> Estimate:
        """Return the number."""
        return Estimate(int(np.sum(values)), None, len(values))


@dataclass(frozen=True, slots=True)
class Single(Estimator):
    """One number that is no mean over trials."""

    has_interval = False

    def estimate(self, values: Any) -> Estimate:
        """Return the number itself."""
        return Estimate(float(values), None, 1)

    def per_trial(self, values: Any) -> Array:
        """Return nothing: trials have no values of their own."""
        return np.zeros(0)


@dataclass(frozen=True, slots=True)
class MeanByTarget(Estimator):
    """Mean of each target: values are (trials, targets)."""

    has_interval = False
    is_number = False
    is_by_target = True

    def estimate(self, values: Any) -> Estimate:
        """Return a mean for each target."""
        return Estimate([float(mean) for mean in np.asarray(values).mean(axis=0)], None, len(values))


@dataclass(frozen=True, slots=True)
class MeanByName(Estimator):
    """Mean of each of several values that go by name: a mapping of arrays."""

    has_interval = False
    is_number = False

    def estimate(self, values: Mapping[str, NDArray[Any]]) -> Estimate:
        """Return a mean for each name."""
        return Estimate({name: float(one.mean()) for name, one in values.items()})

    def per_trial(self, values: Any) -> Array:
        """Return nothing: a trial has several values."""
        return np.zeros(0)


def mean_over_targets(values: NDArray[Any]) -> Array:
    """Return the mean over what is finite of each row, NaN where nothing is."""
    values = np.asarray(values, np.float64)
    is_finite = np.isfinite(values)
    count = is_finite.sum(axis=1)
    mean: Array = np.where(is_finite, values, 0.0).sum(axis=1) / np.maximum(count, 1)
    return np.where(count > 0, mean, np.nan)


def _finite(values: Any) -> Array:
    values = np.asarray(values, np.float64)
    finite: Array = values[np.isfinite(values)]
    return finite


def _pooled(values: Array) -> tuple[float | None, Interval | None, int]:
    """Return the mean over trials and targets, its interval, and the number of trials that say something.

    Targets of a trial are not independent: the interval is that of a ratio of two means over trials, of the
    sum of the values and of their number.
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return None, None, 0
    mean = float(finite.mean())
    if values.ndim < PER_TARGET:
        return mean, normal_interval(finite) if len(finite) > 1 else None, len(finite)
    is_finite = np.isfinite(values)
    counts = is_finite.sum(axis=1)
    trials = int((counts > 0).sum())
    if trials < 2:
        return mean, None, trials
    residuals = np.where(is_finite, values, 0.0).sum(axis=1) - mean * counts
    error = math.sqrt(float((residuals**2).sum()) * trials / (trials - 1)) / len(finite)
    return mean, (mean - Z95 * error, mean + Z95 * error), trials
