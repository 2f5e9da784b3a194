"""The design of a quantisation beside trials: votes, detection, false cells, and the advisor's pick.

Run it with `python benchmarks/quantisation.py`; it takes some minutes. `--quick` takes fewer trials: enough
to see that everything works, too few for the bounds.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TypeVar

import numpy as np
from measure import verdict
from scipy import stats

from algorithms.quantisation.advisor import SearchGrid, Survey, advise, centred_grid, default_search, survey
from algorithms.quantisation.prediction import predict
from algorithms.quantisation.question import Question, TargetLine
from algorithms.quantisation.rules import widest_row
from algorithms.quantisation.spread import VoteDistribution
from hough_tui.quantisation.confirmation import Trials, run_trials
from hough_tui.quantisation.designs import Demands, question_of
from scenarios.model import Scenario

Answer = TypeVar("Answer")

QUICK = "--quick" in sys.argv
TRIALS = 400 if QUICK else 6_000
FRESH_TRIALS = 2_000 if QUICK else 60_000
SEED, FRESH_SEED = 1, 2
WORKERS = 2

SPREADS = (0.5, 1.0, 2.0, 4.0)
"""R/σ of the settings that are predicted."""

WIDTHS = (1.5, 2.5, 4.0, 8.0)
"""Δρ/σ of the settings that are predicted."""

SCENES = [
    # The course report's scene, with misses.
    Scenario.model_validate(
        {
            "name": "two-crossing",
            "scans": 15,
            "interval": 4,
            "region": {"x": [0, 100], "y": [0, 100]},
            "sensor": {"sigma": 0.1, "detection_probability": 0.9},
            "clutter": [{"rate": 50}],
            "targets": [
                {"position": [40, 20], "velocity": [0.3, 0.18]},
                {"position": [20, 80], "velocity": [0.3, -0.18]},
            ],
        }
    ),
    # Few scans, little clutter, a fast target.
    Scenario.model_validate(
        {
            "name": "five-scans",
            "unit": "m",
            "scans": 5,
            "interval": 2,
            "region": {"x": [-20000, 20000], "y": [0, 30000]},
            "sensor": {"sigma": 60},
            "clutter": [{"rate": 8}],
            "targets": [{"position": [-5000, 12000], "velocity": [250, 90]}],
        }
    ),
    # Noise that differs on the axes, targets of different speed, dense clutter in a flat region.
    Scenario.model_validate(
        {
            "name": "flat-region",
            "scans": 20,
            "interval": 1,
            "region": {"x": [0, 60], "y": [0, 15]},
            "sensor": {"sigma": [0.05, 0.1], "detection_probability": 0.8},
            "clutter": [{"rate": 40}],
            "targets": [
                {"position": [10, 4], "velocity": [0.4, 0.1]},
                {"position": [30, 12], "velocity": [-0.15, -0.2]},
                {"position": [45, 2], "velocity": [0.0, 0.3]},
            ],
        }
    ),
    # Many scans, most of them without a plot of the target.
    Scenario.model_validate(
        {
            "name": "rare-plots",
            "scans": 60,
            "interval": 1,
            "region": {"x": [80, 160], "y": [100, 160]},
            "sensor": {"sigma": 0.1, "detection_probability": 0.35},
            "clutter": [{"rate": 15}],
            "targets": [{"position": [100, 120], "velocity": [0.4, 0.2]}],
        }
    ),
]


def side_by_side(calls: Iterable[Callable[[], Answer]]) -> list[Answer]:
    """Return what calls return that release the interpreter's lock."""
    with ThreadPoolExecutor(WORKERS) as pool:
        return [done.result() for done in [pool.submit(call) for call in calls]]


def votes_of_a_line() -> None:
    """Print how far real votes are from the distribution, in its distribution function."""
    random = np.random.default_rng(1)
    count, extent, sigma = 200_000, 20.0, 0.1
    print("  plots anywhere along the line")
    for radius, delta in ((0.1, None), (0.4, None), (0.0, None), (None, 0.9)):
        delta = float(np.arcsin(2.0 * radius / extent)) if delta is None else delta
        noise = sigma if radius != 0.4 else 1e-6
        votes = VoteDistribution.of_line(noise, (-0.5 * extent, 0.5 * extent), delta, 17.0)
        along = random.uniform(-0.5 * extent, 0.5 * extent, count)
        found = 17.0 * np.cos(delta) + along * np.sin(delta) + random.normal(0.0, noise, count)
        away = stats.kstest(found, votes.distribution).statistic
        print(f"    R/σ {votes.radius / noise:10.4g}  {away:.4f} (bound 0.01: {verdict(away, 0.01)})")
    print("  plots of evenly spaced scans, R = 4σ")
    for scans in (5, 10, 20, 40):
        along = extent * (np.arange(scans) / (scans - 1) - 0.5)
        away = []
        # The second distribution is that of a line longer by one step, of which each scan has its own step.
        for longer in (1.0, scans / (scans - 1)):
            half = 0.5 * extent * longer
            delta = float(np.arcsin(8.0 * sigma / extent))
            votes = VoteDistribution.of_line(sigma, (-half, half), delta, 0.0)
            x = np.linspace(-10.0 * sigma, 10.0 * sigma, 20_001)
            mixture = stats.norm.cdf((x[:, None] - along * np.sin(delta)) / sigma).mean(axis=1)
            away.append(float(np.abs(mixture - votes.distribution(x)).max()))
        print(f"    {scans:3} scans  {away[0]:.4f}  with a line of {scans} steps {away[1]:.4f}")


def mean_shares() -> None:
    """Print the mean shares of votes in a cell of 4 σ."""
    shares = [VoteDistribution(1.0, -ratio, ratio).mean_share(4.0) for ratio in (0.0, 1.0, 2.0, 4.0)]
    print("  Δρ = 4σ, R/σ 0, 1, 2, 4:", ", ".join(f"{share:.3f}" for share in shares))


def binomial(question: Question, line: TargetLine, theta_step: float, rho_step: float, votes: int) -> float:
    """Return P_D of a line with a binomial number of votes, as if each plot lay anywhere along it."""
    places = (np.arange(24) + 0.5) / 24 - 0.5
    others = question.other_votes(line, rho_step)
    own = np.arange(line.scans + 1)
    half, total = 0.5 * line.extent, 0.0
    for delta in theta_step * places:
        spread = VoteDistribution.of_line(line.sigma, (-half, half), float(delta))
        for share in spread.share(rho_step * places, rho_step):
            law = stats.binom.pmf(own, line.scans, question.detection_probability * share)
            total += float(law @ stats.poisson.sf(votes - own - 1, others))
    return total / len(places) ** 2


def predictions() -> None:
    """Print predicted beside measured rates of the home cell, and false cells, over many settings."""
    print("  scene          R/σ  Δρ/σ   T   P_D predicted  measured  3 × 3   false predicted  measured")
    misses, binomial_misses, ratios, blocks = [], [], [], []
    for scene in SCENES:
        question = question_of(scene)
        settings = []
        for spread in SPREADS:
            # Bins of the line that spreads most.
            widest = min(widest_row(line.sigma, line.extent, spread) for line in question.lines)
            for width in WIDTHS:
                step = width * min(line.sigma for line in question.lines)
                grid = centred_grid(question, int(np.ceil(np.pi / widest)), step)
                votes = next(t for t in range(1, 999) if predict(question, grid, t).false_cells <= 20.0)
                settings.append((spread, width, grid, votes))
        trials = side_by_side(
            partial(run_trials, [scene], grid, TRIALS, SEED, 200) for _, _, grid, _ in settings
        )
        for (spread, width, grid, votes), found in zip(settings, trials, strict=True):
            told = predict(question, grid, votes)
            rate, false = found.rate(votes), float(found.false_cells(votes).mean())
            print(
                f"  {scene.name:13} {spread:4.1f} {width:5.1f} {votes:4} {told.p_detection:12.3f}"
                f" {rate:11.3f} {found.block_rate(votes):8.3f} {told.false_cells:13.2f} {false:11.2f}"
            )
            plain = [
                binomial(question, line, grid.theta_step, grid.rho_step, votes) for line in question.lines
            ]
            misses.append(told.p_detection - rate)
            binomial_misses.append(float(np.mean(plain)) - rate)
            blocks.append(found.block_rate(votes) - rate)
            ratios.append(told.false_cells / false)
    worst, off = float(np.abs(misses).max()), float(np.abs(np.array(ratios) - 1.0).max())
    print(f"  {len(misses)} settings, {TRIALS:,} trials each")
    print(f"  P_D: rms {rms(misses):.4f}, worst {worst:.4f} (bound 0.03: {verdict(worst, 0.03)})")
    print(
        f"  P_D with binomial votes: rms {rms(binomial_misses):.4f}, "
        f"worst {float(np.abs(binomial_misses).max()):.4f}"
    )
    print(f"  success within 3 × 3 cells lies {np.mean(blocks):.3f} above the home cell")
    print(f"  false cells: worst {100.0 * off:.1f} % off (bound 10 %: {verdict(off, 0.1)})")


def rms(values: list[float]) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def picks() -> None:
    """Print the advisor's pick beside the best of a search by trials alone, both judged by fresh trials."""
    for scene, bound in zip(SCENES, (1.0, 0.5, 10.0, 3.0), strict=True):
        question = question_of(scene, Demands(false_cells=bound))
        search = small_search(question)
        advice = advise(question, search)
        tried = brute_force(scene, question, search)
        best, ours = tried.best(bound), (advice.grid, advice.votes)
        row, width = np.unravel_index(
            int(np.argmax(np.where(tried.is_allowed, best.p_detection, -1.0))), tried.is_allowed.shape
        )
        theirs = (
            centred_grid(question, int(search.theta_bins[row]), float(search.rho_step[width])),
            int(best.votes[row, width]),
        )
        judged: list[Trials] = side_by_side(
            partial(run_trials, [scene], grid, FRESH_TRIALS, FRESH_SEED, 200) for grid, _ in (ours, theirs)
        )
        rates = [found.rate(votes) for found, (_, votes) in zip(judged, (ours, theirs), strict=True)]
        cells = [
            float(found.false_cells(votes).mean())
            for found, (_, votes) in zip(judged, (ours, theirs), strict=True)
        ]
        print(f"  {scene.name}, {tried.is_allowed.sum()} settings, at most {bound:g} false cells")
        for name, (grid, votes), rate, false in zip(
            ("advisor", "by trials"), (ours, theirs), rates, cells, strict=True
        ):
            print(
                f"    {name:9} {grid.theta_bins:4} rows, Δρ {grid.rho_step:g}, {votes} votes: "
                f"P_D {rate:.4f}, {false:.3f} false cells"
            )
        behind = rates[1] - rates[0]
        print(f"    behind by {behind:.4f} (bound 0.01: {verdict(behind, 0.01)})")


def small_search(question: Question) -> SearchGrid:
    """Return every other quantisation of the default search."""
    whole = default_search(question)
    return SearchGrid(whole.theta_bins[1::2], whole.rho_step[::2])


def brute_force(scene: Scenario, question: Question, search: SearchGrid) -> Survey:
    """Return P_D and false cells of a search by trials alone."""
    told = survey(question, search)
    most = told.p_detection.shape[-1]
    places = [(int(row), int(width)) for row, width in np.argwhere(told.is_allowed)]
    trials = side_by_side(
        partial(
            run_trials,
            [scene],
            centred_grid(question, int(search.theta_bins[row]), float(search.rho_step[width])),
            TRIALS // 2,
            SEED,
            most,
        )
        for row, width in places
    )
    p_detection = np.zeros_like(told.p_detection)
    cells = np.full_like(told.false_cells, np.inf)
    for (row, width), found in zip(places, trials, strict=True):
        p_detection[row, width] = [found.rate(votes) for votes in range(1, most + 1)]
        cells[row, width] = [found.false_cells(votes).mean() for votes in range(1, most + 1)]
    return Survey(search, told.is_allowed, p_detection, cells)


def answers() -> None:
    """Print how long the advisor takes for its default search."""
    for scene in SCENES:
        question = question_of(scene)
        advise(question)
        times = []
        for _ in range(7):
            began = time.perf_counter()
            advice = advise(question)
            times.append(time.perf_counter() - began)
        size = advice.survey.is_allowed.size
        value = float(np.median(times))
        print(
            f"  {scene.name:13} {size} settings, {1e3 * value:4.0f} ms (bound 200 ms: {verdict(value, 0.2)})"
        )


if __name__ == "__main__":
    for title, part in {
        "Kolmogorov-Smirnov distance of votes": votes_of_a_line,
        "mean share of a line's votes in its cell": mean_shares,
        "time of the default search": answers,
        "predicted and measured": predictions,
        "the advisor's pick": picks,
    }.items():
        print(title)
        part()
