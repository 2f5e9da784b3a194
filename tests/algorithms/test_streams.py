from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numba import njit
from scipy import stats

from algorithms.streams import normal_pair, philox, uniform_pair

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

word = st.integers(0, 2**32 - 1)
ALL_ONES = 2**32 - 1


def blocks(seed, *counter):
    return [int(part) for part in philox(np.uint64(seed), *map(np.uint64, counter))]


def philox_by_the_paper(key, counter):
    """Philox-4x32-10 in whole numbers of any size (Salmon et al. 2011, section 3.3)."""
    high_key, low_key = key >> 32, key & ALL_ONES
    r0, l0, r1, l1 = counter
    for number in range(10):
        k0 = (low_key + number * 0x9E3779B9) % 2**32
        k1 = (high_key + number * 0xBB67AE85) % 2**32
        h0, m0 = divmod(r0 * 0xD2511F53, 2**32)
        h1, m1 = divmod(r1 * 0xCD9E8D57, 2**32)
        r0, l0, r1, l1 = h1 ^ l0 ^ k0, m1, h0 ^ l1 ^ k1, m0
    return [r0, l0, r1, l1]


# The known-answer vectors of the authors' library, Random123 (kat_vectors).
@pytest.mark.parametrize(
    ("counter", "key", "expected"),
    [
        ([0, 0, 0, 0], [0, 0], "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
        ([ALL_ONES] * 4, [ALL_ONES] * 2, "408f276d 41c83b0e a20bc7c6 6d5451fd"),
        (
            [0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344],
            [0xA4093822, 0x299F31D0],
            "d16cfe09 94fdcceb 5001e420 24126ea1",
        ),
    ],
)
def test_the_known_answers_of_random123(counter, key, expected):
    seed = key[0] | key[1] << 32
    assert blocks(seed, *counter) == [int(part, 16) for part in expected.split()]


@steady
@given(st.integers(0, 2**64 - 1), word, word, word, word)
def test_every_block_is_that_of_the_paper(seed, a, b, c, d):
    assert blocks(seed, a, b, c, d) == philox_by_the_paper(seed, [a, b, c, d])


@steady
@given(st.integers(0, 2**64 - 1), word, word, word, word)
def test_uniform_numbers_have_27_bits_of_one_word_and_26_of_the_next(seed, block, scan, source, trial):
    a, b, c, d = philox_by_the_paper(seed, [block, scan, source, trial])
    expected = ((a >> 5) * 2**26 + (b >> 6)) / 2**53, ((c >> 5) * 2**26 + (d >> 6)) / 2**53
    found = uniform_pair(np.uint64(seed), block, scan, source, trial)
    assert found == expected
    assert all(0.0 <= number < 1.0 for number in found)


@steady
@given(st.integers(0, 2**64 - 1), word, word)
def test_normal_numbers_are_those_of_box_and_muller(seed, block, trial):
    u, v = uniform_pair(np.uint64(seed), block, 2, 3, trial)
    x, y = normal_pair(np.uint64(seed), block, 2, 3, trial)
    assert math.hypot(x, y) == pytest.approx(math.sqrt(-2.0 * math.log1p(-u)), abs=1e-12)
    assert math.atan2(y, x) % (2 * math.pi) == pytest.approx(2 * math.pi * v, abs=1e-9)


@njit
def _columns(seed, count, word_to_vary):
    found = np.empty((4, count))
    for k in range(count):
        words = [0, 0, 0, 0]
        words[word_to_vary] = k
        found[0, k], found[1, k] = uniform_pair(seed, words[0], words[1], words[2], words[3])
        found[2, k], found[3, k] = normal_pair(seed, words[0], words[1], words[2], words[3])
    return found


@pytest.mark.parametrize("varied", range(4))
def test_numbers_along_each_word_of_the_counter_are_uniform_and_normal(varied):
    count = 20_000
    found = _columns(np.uint64(3), count, varied)
    # P[√n·D > 2.2] is 1.3e-4 (Kolmogorov).
    for numbers, law in zip(found, ("uniform", "uniform", "norm", "norm"), strict=True):
        assert stats.kstest(numbers, law).statistic * math.sqrt(count) < 2.2
    # Correlations of independent numbers have a standard deviation of 1/√n.
    for numbers in found:
        assert abs(np.corrcoef(numbers[:-1], numbers[1:])[0, 1]) < 4 / math.sqrt(count)
    assert abs(np.corrcoef(found[0], found[1])[0, 1]) < 4 / math.sqrt(count)
    assert abs(np.corrcoef(found[2], found[3])[0, 1]) < 4 / math.sqrt(count)


@pytest.mark.parametrize("seed", [1, 2**31, 2**32, 2**63, 2**64 - 1])
def test_seeds_that_differ_in_one_half_give_other_numbers(seed):
    assert uniform_pair(np.uint64(seed), 0, 0, 0, 0) != uniform_pair(np.uint64(0), 0, 0, 0, 0)
