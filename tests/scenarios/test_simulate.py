from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy import stats

from algorithms.plots import PlotChunk
from scenarios.clutter import ExactClutter, PoissonClutter, Region
from scenarios.experiments import LARGEST_SEED, MOST_TRIALS
from scenarios.model import Scenario
from scenarios.sensors import CartesianSensor
from scenarios.simulate import draw, truth
from scenarios.targets import Target
from scenarios.world import World, poisson_distribution

steady = settings(
    deadline=None, derandomize=True, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)

seeds = st.integers(0, LARGEST_SEED)
SQUARE = Region(x=(0.0, 100.0), y=(0.0, 100.0))
CORNER = Region(x=(-20.0, -10.0), y=(5.0, 6.0))


def scene(scans=15, *, sigma=0.1, probability=1.0, rates=(50.0,), targets=None, regions=()):
    if targets is None:
        targets = [
            Target(position=(40.0, 20.0), velocity=(0.3, 0.18)),
            Target(position=(20.0, 80.0), velocity=(0.3, -0.18)),
        ]
    regions = [*regions, *[None] * (len(rates) - len(regions))]
    return Scenario(
        name="scene",
        scans=scans,
        interval=4.0,
        region=SQUARE,
        sensor=CartesianSensor(sigma=sigma, detection_probability=probability),
        clutter=[
            PoissonClutter(rate=rate, region=region) for rate, region in zip(rates, regions, strict=True)
        ],
        targets=targets,
    )


# Everything at once: two sources of clutter, missed plots, targets that come and go.
BUSY = scene(
    8,
    sigma=(0.1, 0.4),
    probability=0.7,
    rates=(6.0, 0.5),
    regions=(None, CORNER),
    targets=[
        Target(position=(40.0, 20.0), velocity=(0.3, 0.18)),
        Target(position=(10.0, 10.0), velocity=(0.0, 0.2), birth=2, death=5),
        Target(position=(60.0, 60.0), velocity=(-0.1, 0.0), birth=5),
    ],
)


def drawn(scenario, seed=1, first=0, trials=1):
    return draw(World.of(scenario), seed, first, trials)


def part(one, trial):
    rows = slice(one.chunk.offsets[trial], one.chunk.offsets[trial + 1])
    return one.chunk.trial(trial), one.origin[rows]


def assert_same(one, other):
    (plots, origin), (other_plots, other_origin) = one, other
    np.testing.assert_array_equal(plots.scan, other_plots.scan)
    np.testing.assert_array_equal(plots.time, other_plots.time)
    np.testing.assert_array_equal(plots.position, other_plots.position)
    np.testing.assert_array_equal(origin, other_origin)


def as_set(one, trial=0):
    """Return the plots of a trial as a sorted list, so that their order in a scan does not count."""
    plots, origin = part(one, trial)
    return sorted(zip(plots.scan.tolist(), *plots.position.T.tolist(), origin.tolist(), strict=True))


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 10), st.integers(1, 9))
def test_a_trial_is_the_same_alone_as_in_a_chunk(seed, first, trials):
    chunk = drawn(BUSY, seed, first, trials)
    assert chunk.chunk.trials == trials
    for index in range(trials):
        assert_same(part(chunk, index), part(drawn(BUSY, seed, first + index), 0))


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 1))
def test_fewer_scans_are_the_first_part_of_more(seed, trial):
    long, long_origin = part(drawn(scene(15, rates=(4.0, 3.0), probability=0.8), seed, trial), 0)
    first = long.scan < 5
    short, short_origin = part(drawn(scene(5, rates=(4.0, 3.0), probability=0.8), seed, trial), 0)
    np.testing.assert_array_equal(short.scan, long.scan[first])
    np.testing.assert_array_equal(short.position, long.position[first])
    np.testing.assert_array_equal(short_origin, long_origin[first])


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 3))
def test_the_control_is_the_draw_without_the_plots_of_targets(seed, trial):
    full = drawn(BUSY, seed, trial, 3)
    control = full.without_targets()
    assert (control.origin == -1).all()
    for index in range(3):
        plots, origin = part(full, index)
        kept = origin < 0
        left, _ = part(control, index)
        np.testing.assert_array_equal(left.scan, plots.scan[kept])
        np.testing.assert_array_equal(left.time, plots.time[kept])
        np.testing.assert_array_equal(left.position, plots.position[kept])


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 3))
def test_the_control_has_the_plots_of_the_scenario_without_targets(seed, trial):
    control = drawn(BUSY, seed, trial, 3).without_targets()
    bare = drawn(BUSY.model_copy(update={"targets": []}), seed, trial, 3)
    for index in range(3):
        assert as_set(control, index) == as_set(bare, index)


@steady
@given(seeds)
def test_sources_do_not_disturb_each_other(seed):
    full = as_set(drawn(BUSY, seed))
    fewer = as_set(drawn(BUSY.model_copy(update={"targets": BUSY.targets[:1]}), seed))
    assert fewer == [row for row in full if row[3] <= 0]
    one_source = as_set(drawn(BUSY.model_copy(update={"clutter": BUSY.clutter[:1]}), seed))
    in_corner = [row for row in full if row[3] < 0 and row[1] < 0]
    assert one_source == [row for row in full if row not in in_corner]


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 1))
def test_columns_are_sorted_by_scan_and_belong_together(seed, trial):
    plots, origin = part(drawn(BUSY, seed, trial), 0)
    assert plots.scan.dtype == origin.dtype == np.int32
    assert len(plots.scan) == len(plots.time) == len(plots.position) == len(origin)
    assert (np.diff(plots.scan) >= 0).all()
    np.testing.assert_array_equal(plots.time, plots.scan * 4.0)
    for target in range(3):
        scans = plots.scan[origin == target]
        assert len(set(scans.tolist())) == len(scans)


def test_the_largest_seed_and_the_last_trial():
    last = MOST_TRIALS - 1
    chunk = drawn(BUSY, LARGEST_SEED, last - 2, 3)
    assert_same(part(chunk, 2), part(drawn(BUSY, LARGEST_SEED, last), 0))
    assert np.isfinite(chunk.chunk.position).all()
    neighbours = [(LARGEST_SEED - 1, last), (LARGEST_SEED, last - 1), (0, last), (LARGEST_SEED - 2**32, last)]
    mine = as_set(drawn(BUSY, LARGEST_SEED, last))
    for seed, trial in neighbours:
        assert not set(mine) & set(as_set(drawn(BUSY, seed, trial)))


def test_trials_do_not_share_plots():
    chunk = drawn(BUSY, 3, 0, 200)
    assert len(np.unique(chunk.chunk.position, axis=0)) == len(chunk.chunk.position)


@pytest.mark.parametrize("rate", [1e-12, 0.003, 0.5, 1.0, 20.0, 50.0, 1234.5, 1e4])
def test_the_poisson_table_is_that_of_scipy(rate):
    table = poisson_distribution(rate)
    expected = stats.poisson.cdf(np.arange(len(table)), rate)
    np.testing.assert_allclose(table, expected, rtol=0, atol=1e-10)
    assert (np.diff(table) >= 0).all()
    assert table[-1] == 1.0


def test_the_poisson_table_of_the_greatest_rate():
    table = poisson_distribution(1e6)
    near = np.arange(990_000, 1_010_000, 500)
    # log k! is summed over a million terms.
    np.testing.assert_allclose(table[near], stats.poisson.cdf(near, 1e6), rtol=0, atol=1e-6)


def test_a_rate_of_zero_draws_nothing():
    assert poisson_distribution(0.0).tolist() == [1.0]
    assert len(drawn(scene(rates=(0.0,), targets=[]), 1, 0, 50).origin) == 0


@pytest.mark.parametrize("rate", [0.5, 20.0, 300.0])
def test_clutter_counts_are_poisson(rate):
    scans, trials = 5, 800
    found = drawn(scene(scans, rates=(rate,), targets=[]), 11, 0, trials).chunk
    trial = np.repeat(np.arange(trials), np.diff(found.offsets))
    counts = np.bincount(trial * scans + found.scan, minlength=trials * scans)
    number = len(counts)
    # The fourth central moment of a Poisson number is λ + 3λ², so its sample variance has (λ + 2λ²)/n.
    assert counts.mean() == pytest.approx(rate, abs=4 * math.sqrt(rate / number))
    assert counts.var() == pytest.approx(rate, abs=4 * math.sqrt((rate + 2 * rate**2) / number))
    by_scan = counts.reshape(trials, scans)
    assert abs(np.corrcoef(by_scan[:, 0], by_scan[:, 1])[0, 1]) < 4 / math.sqrt(trials)
    assert abs(np.corrcoef(by_scan[:-1, 0], by_scan[1:, 0])[0, 1]) < 4 / math.sqrt(trials)


def test_clutter_is_uniform_over_its_region():
    region = Region(x=(-30.0, 50.0), y=(10.0, 14.0))
    place = drawn(scene(4, rates=(100.0,), targets=[], regions=(region,)), 12, 0, 100).chunk.position
    number = len(place)
    shares = (place - [-30.0, 10.0]) / [80.0, 4.0]
    assert ((shares >= 0) & (shares < 1)).all()
    for share in shares.T:
        # P[√n·D > 2.2] is 1.3e-4 (Kolmogorov).
        assert stats.kstest(share, "uniform").statistic * math.sqrt(number) < 2.2
    # Over a square of 10 × 10 cells the statistic of χ² has mean 99 and variance 198.
    cells = np.bincount((shares * 10).astype(int) @ [10, 1], minlength=100)
    assert ((cells - number / 100) ** 2 / (number / 100)).sum() < 99 + 4 * math.sqrt(198)


def test_clutter_sources_add_up_each_in_its_own_region():
    found = drawn(scene(5, rates=(8.0, 3.0), regions=(None, CORNER), targets=[]), 13, 0, 400).chunk
    in_corner = found.position[:, 0] < 0
    scans = 5 * 400
    assert in_corner.sum() == pytest.approx(3.0 * scans, abs=4 * math.sqrt(3.0 * scans))
    assert (~in_corner).sum() == pytest.approx(8.0 * scans, abs=4 * math.sqrt(8.0 * scans))
    corner, square = found.position[in_corner], found.position[~in_corner]
    assert ((corner >= [-20, 5]) & (corner < [-10, 6])).all()
    assert ((square >= 0) & (square < 100)).all()


@pytest.mark.parametrize("probability", [0.0, 0.3, 0.9, 1.0])
def test_targets_are_detected_with_their_probability(probability):
    scans, trials = 10, 500
    found = drawn(scene(scans, probability=probability, rates=()), 14, 0, trials)
    number = scans * trials
    error = 4 * math.sqrt(probability * (1 - probability) / number)
    for target in (0, 1):
        assert (found.origin == target).sum() / number == pytest.approx(probability, abs=error)
    if 0 < probability < 1:
        trial = np.repeat(np.arange(trials), np.diff(found.chunk.offsets))
        seen = np.zeros((2, number))
        seen[found.origin, trial * scans + found.chunk.scan] = 1
        assert abs(np.corrcoef(seen)[0, 1]) < 4 / math.sqrt(number)
        assert abs(np.corrcoef(seen[0, :-1], seen[0, 1:])[0, 1]) < 4 / math.sqrt(number)


def test_noise_is_normal_with_the_sigma_of_each_axis():
    sigma = np.array([0.1, 0.4])
    scenario = scene(10, sigma=tuple(sigma), rates=(2.0,))
    found = drawn(scenario, 15, 0, 400)
    residuals = []
    for number, target in enumerate(scenario.targets):
        own = found.origin == number
        path = np.array(target.position) + found.chunk.time[own][:, None] * np.array(target.velocity)
        residuals.append((found.chunk.position[own] - path) / sigma)
    count = len(residuals[0])
    assert count == 4000
    for residual in residuals:
        for axis in residual.T:
            assert stats.kstest(axis, "norm").statistic * math.sqrt(count) < 2.2
            assert abs(axis.mean()) < 4 / math.sqrt(count)
            # The sample variance of normal numbers has the variance 2/n.
            assert abs(axis.var() - 1) < 4 * math.sqrt(2 / count)
        assert abs(np.corrcoef(residual.T)[0, 1]) < 4 / math.sqrt(count)
        assert abs(np.corrcoef(residual[:-1, 0], residual[1:, 0])[0, 1]) < 4 / math.sqrt(count)
    assert abs(np.corrcoef(residuals[0][:, 0], residuals[1][:, 0])[0, 1]) < 4 / math.sqrt(count)


def test_one_sigma_is_that_of_both_axes():
    found = drawn(scene(10, sigma=0.25, rates=()), 15, 0, 200)
    other = drawn(scene(10, sigma=(0.25, 0.25), rates=()), 15, 0, 200)
    np.testing.assert_array_equal(found.chunk.position, other.chunk.position)


def test_noise_does_not_depend_on_clutter_or_on_missed_plots():
    sure, clear = drawn(scene(6, rates=()), 16), drawn(scene(6, rates=(9.0,), probability=0.6), 16)
    plots = {row for row in as_set(clear) if row[3] >= 0}
    assert 0 < len(plots) < 12
    assert plots <= set(as_set(sure))


def test_no_number_that_moved_a_target_also_placed_clutter():
    still = [Target(position=(50.0, 50.0), velocity=(0.0, 0.0))] * 2
    found = drawn(scene(10, sigma=1.0, rates=(20.0, 20.0), targets=still), 23, 0, 100)
    trial = np.repeat(np.arange(100), np.diff(found.chunk.offsets))
    shares, own = found.chunk.position / 100.0, found.origin >= 0
    # Box and Muller's first number, from the length of the displacement.
    behind = -np.expm1(-0.5 * ((found.chunk.position - 50.0) ** 2).sum(axis=1))
    for number in range(100):
        clutter = shares[~own & (trial == number)]
        used = behind[own & (trial == number)]
        assert np.abs(clutter[:, :, None] - used).min() > 1e-12


def test_without_noise_targets_move_straight():
    plots, origin = part(drawn(scene(6, sigma=0.0, rates=(3.0,)), 17), 0)
    for number, target in enumerate(scene().targets):
        own = origin == number
        expected = [
            [p + v * 4.0 * scan for p, v in zip(target.position, target.velocity, strict=True)]
            for scan in range(6)
        ]
        assert plots.position[own] == pytest.approx(np.array(expected))


@pytest.mark.parametrize(
    ("birth", "death", "expected"),
    [
        (0, None, range(8)),
        (3, None, range(3, 8)),
        (0, 2, range(3)),
        (2, 2, [2]),
        (7, 20, [7]),
        (8, None, []),
        (0, 0, [0]),
    ],
)
def test_a_target_is_there_from_birth_to_death(birth, death, expected):
    target = Target(position=(10.0, 20.0), velocity=(1.0, -2.0), birth=birth, death=death)
    plots, origin = part(drawn(scene(8, sigma=0.0, rates=(2.0,), targets=[target]), 18), 0)
    own = origin == 0
    assert plots.scan[own].tolist() == list(expected)
    for scan, place in zip(plots.scan[own], plots.position[own], strict=True):
        assert place.tolist() == [10.0 + 4.0 * (scan - birth), 20.0 - 8.0 * (scan - birth)]


@pytest.mark.parametrize("rate", [1.0, 5.0, 30.0])
def test_the_place_in_a_scan_does_not_tell_targets_from_clutter(rate):
    scans, trials = 5, 1500
    found = drawn(scene(scans, rates=(rate,)), 19, 0, trials)
    trial = np.repeat(np.arange(trials), np.diff(found.chunk.offsets))
    scan = trial * scans + found.chunk.scan
    size = np.bincount(scan)
    begin = np.concatenate([[0], np.cumsum(size)[:-1]])
    place = np.arange(len(scan)) - begin[scan]
    for target in (0, 1):
        own = np.flatnonzero(found.origin == target)
        number, sizes = len(own), size[scan[own]]
        # A place among m is uniform: (place + ½)/m has the variance (1 − 1/m²)/12.
        share = (place[own] + 0.5) / sizes
        error = math.sqrt(((1 - 1 / sizes**2) / 12).mean() / number)
        assert share.mean() == pytest.approx(0.5, abs=4 * error)
        for at in (0, sizes - 1):
            there = (place[own] == at).mean()
            expected = (1 / sizes).mean()
            assert there == pytest.approx(expected, abs=4 * math.sqrt(expected * (1 - expected) / number))
    first = place[found.origin == 0] < place[found.origin == 1]
    assert first.mean() == pytest.approx(0.5, abs=4 * math.sqrt(0.25 / len(first)))


def test_a_world_without_anything_draws_empty_trials():
    found = drawn(scene(3, rates=(), targets=[]), 20, 5, 4)
    assert found.chunk.offsets.tolist() == [0] * 5
    assert found.chunk.position.shape == (0, 2)
    assert found.without_targets().chunk.offsets.tolist() == [0] * 5


def test_the_control_keeps_trials_without_clutter():
    full = drawn(scene(3, rates=(0.2,)), 21, 0, 60)
    control = full.without_targets()
    counts = np.diff(control.chunk.offsets)
    assert isinstance(control.chunk, PlotChunk)
    assert control.chunk.trials == 60
    assert (counts == 0).any()
    assert (counts > 0).any()
    assert counts.sum() == (full.origin < 0).sum()


def test_the_truth_of_a_draw():
    still = Target(position=(1.0, 2.0), velocity=(0.0, 0.0))
    scenario = scene(4, targets=[scene().targets[0], still])
    found = drawn(scenario, 22, 0, 3)
    known = truth(scenario, found)
    assert known.origin is found.origin
    assert known.theta.shape == known.rho.shape == (3, 2)
    assert np.degrees(known.theta[:, 0]) == pytest.approx(120.96, abs=0.005)
    assert known.rho[:, 0] == pytest.approx(-3.43, abs=0.005)
    assert np.isnan(known.theta[:, 1]).all()
    assert np.isnan(known.rho[:, 1]).all()
    assert known.middle[2] == pytest.approx(np.array([[41.8, 21.08], [1.0, 2.0]]))


def test_there_are_no_lines_without_targets():
    bare = scene(targets=[])
    known = truth(bare, drawn(bare, trials=2))
    assert known.theta.shape == known.rho.shape == (2, 0)


SPREAD = Target(position=(40.0, 20.0), velocity=(0.3, 0.18), spread=(2.0, 0.5))


def test_a_target_begins_anywhere_within_its_spread_and_its_truth_goes_with_it():
    scenario = scene(4, sigma=0.0, rates=(), targets=[SPREAD])
    found = drawn(scenario, 3, 0, 4000)
    shift = found.states.shift[:, 0]
    assert found.states.shift.shape == (4000, 1, 2)
    assert (np.abs(shift) <= [2.0, 0.5]).all()
    for axis, half in ((0, 2.0), (1, 0.5)):
        assert stats.kstest(shift[:, axis], stats.uniform(-half, 2 * half).cdf).pvalue > 1e-4
    assert abs(np.corrcoef(shift.T)[0, 1]) < 4.0 / math.sqrt(4000)
    known = truth(scenario, found)
    plots = found.chunk.position.reshape(4000, 4, 2)
    along = plots[..., 0] * np.cos(known.theta) + plots[..., 1] * np.sin(known.theta)
    np.testing.assert_allclose(along, np.broadcast_to(known.rho, along.shape), atol=1e-9)
    np.testing.assert_allclose(known.middle[:, 0], plots.mean(axis=1))
    np.testing.assert_allclose(found.states.paths(7)[0], plots[7])


def test_a_spread_changes_nothing_but_where_the_target_is():
    still, moved = scene(6, targets=[SPREAD.model_copy(update={"spread": 0.0})]), scene(6, targets=[SPREAD])
    one, other = drawn(still, 9, 5), drawn(moved, 9, 5)
    np.testing.assert_array_equal(one.origin, other.origin)
    own = one.origin >= 0
    np.testing.assert_array_equal(one.chunk.position[~own], other.chunk.position[~own])
    apart = other.chunk.position[own] - one.chunk.position[own]
    np.testing.assert_allclose(apart, np.broadcast_to(other.states.shift[0, 0], apart.shape), atol=1e-12)


def test_a_fixed_number_of_plots_a_scan_and_a_batch():
    fixed = [ExactClutter(count=7, per="scan"), ExactClutter(count=90, per="batch", region=CORNER)]
    scenario = scene(5, targets=[]).model_copy(update={"clutter": fixed})
    found = drawn(scenario, 11, 0, 300)
    assert (np.diff(found.chunk.offsets) == 5 * 7 + 90).all()
    inside = found.chunk.position[:, 0] < 0.0
    scans = found.chunk.scan
    of_scan = np.array(
        [np.bincount(scans[~inside].reshape(300, -1)[trial], minlength=5) for trial in range(300)]
    )
    assert (of_scan == 7).all()
    # Each plot of the batch falls into any scan alike, and anywhere in its region.
    batch = np.bincount(scans[inside], minlength=5)
    assert stats.chisquare(batch).pvalue > 1e-4
    for axis, (low, high) in enumerate(((-20.0, -10.0), (5.0, 6.0))):
        place = found.chunk.position[inside, axis]
        assert stats.kstest(place, stats.uniform(low, high - low).cdf).pvalue > 1e-4


@steady
@given(seeds, st.integers(0, MOST_TRIALS - 4), st.integers(1, 4))
def test_trials_with_fixed_numbers_are_the_same_alone_as_in_a_chunk(seed, first, trials):
    fixed = [ExactClutter(count=9, per="batch"), PoissonClutter(rate=2.0), ExactClutter(count=2)]
    scenario = scene(4, targets=[SPREAD], probability=0.8).model_copy(update={"clutter": fixed})
    chunk = drawn(scenario, seed, first, trials)
    for index in range(trials):
        alone = drawn(scenario, seed, first + index)
        assert_same(part(chunk, index), part(alone, 0))
        np.testing.assert_array_equal(chunk.states.position[index], alone.states.position[0])


def test_clutter_around_the_targets_lies_in_the_box_of_their_paths():
    scenario = scene(11).model_copy(
        update={"clutter": [ExactClutter(count=500, per="batch", over="targets")]}
    )
    place = drawn(scenario, 2).without_targets().chunk.position
    assert len(place) == 500
    # (40, 20) to (52, 27.2) and (20, 80) to (32, 72.8)
    assert place.min(axis=0) == pytest.approx([20.0, 20.0], abs=0.5)
    assert place.max(axis=0) == pytest.approx([52.0, 80.0], abs=0.5)
    assert ((place >= [20.0, 20.0]) & (place <= [52.0, 80.0])).all()
