"""Counter-based random streams: the same numbers for the same counter, whoever asks, in whatever order.

The generator is Philox-4x32-10. Its key is the seed; its counter has four words, here
(block, scan, source, trial), so that every trial, scan and source of plots has a stream of its own.

References
----------
J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
"""

from __future__ import annotations

import math

import numpy as np

from algorithms.compiled import kernel

_LOW = np.uint64(0xFFFFFFFF)
_WORD = np.uint64(32)
_MULTIPLIER_0, _MULTIPLIER_1 = np.uint64(0xD2511F53), np.uint64(0xCD9E8D57)
_WEYL_0, _WEYL_1 = np.uint64(0x9E3779B9), np.uint64(0xBB67AE85)
_HIGH_BITS, _LOW_BITS, _SHIFT = np.uint64(5), np.uint64(6), np.uint64(26)
_UNIT = 1.0 / 9007199254740992.0  # 2⁻⁵³

ROUNDS = 10


@kernel
def philox(seed, word_0, word_1, word_2, word_3):  # type: ignore[no-untyped-def]
    """Return the four 32-bit words of one block, each as uint64.

    Parameters
    ----------
    seed : uint64, the key
    word_0, word_1, word_2, word_3 : uint64 below 2³², the counter
    """
    key_0, key_1 = seed & _LOW, seed >> _WORD
    for _ in range(ROUNDS):
        product_0, product_1 = _MULTIPLIER_0 * word_0, _MULTIPLIER_1 * word_2
        word_0, word_1, word_2, word_3 = (
            (product_1 >> _WORD) ^ word_1 ^ key_0,
            product_1 & _LOW,
            (product_0 >> _WORD) ^ word_3 ^ key_1,
            product_0 & _LOW,
        )
        key_0, key_1 = (key_0 + _WEYL_0) & _LOW, (key_1 + _WEYL_1) & _LOW
    return word_0, word_1, word_2, word_3


@kernel
def _to_unit(high, low):  # type: ignore[no-untyped-def]
    return float(((high >> _HIGH_BITS) << _SHIFT) | (low >> _LOW_BITS)) * _UNIT


@kernel
def uniform_pair(seed, block, scan, source, trial):  # type: ignore[no-untyped-def]
    """Return two independent numbers uniform in [0, 1), with 53 bits each."""
    a, b, c, d = philox(seed, np.uint64(block), np.uint64(scan), np.uint64(source), np.uint64(trial))
    return _to_unit(a, b), _to_unit(c, d)


@kernel
def normal_pair(seed, block, scan, source, trial):  # type: ignore[no-untyped-def]
    """Return two independent standard normal numbers.

    References
    ----------
    G. E. P. Box and M. E. Muller, Annals of Mathematical Statistics 29, 1958.
    """
    first, second = uniform_pair(seed, block, scan, source, trial)
    radius = math.sqrt(-2.0 * math.log(1.0 - first))
    return radius * math.cos(2.0 * math.pi * second), radius * math.sin(2.0 * math.pi * second)
