from collections.abc import Callable

import numpy as np
import pytest
from neurospatial.stats.shuffle import compute_shuffle_pvalue
from scipy import stats

from cogmap.cells.measures.information import spatial_information
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.shuffling import shuffle_test
from cogmap.errors import CogmapError


@pytest.fixture
def walk() -> np.ndarray:
    """A slow walk, reflected at the walls of a 2×2 m room."""
    steps = np.random.default_rng(0).normal(0, 0.1, (4000, 2)).cumsum(axis=0)
    return np.abs((steps + 1) % 4 - 2) - 1


def test_p_agrees_with_neurospatial(walk: np.ndarray) -> None:
    rates = np.random.default_rng(1).gamma(0.5, 1, (4000, 6))

    def statistic(rates: np.ndarray) -> np.ndarray:
        return np.corrcoef(walk[:, 0], rates.T)[0, 1:]

    found = shuffle_test(statistic, rates, np.random.default_rng(0), shuffles=39)
    np.testing.assert_array_equal(found.observed, statistic(rates))
    expected = [compute_shuffle_pvalue(o, n) for o, n in zip(found.observed, found.shuffled.T, strict=True)]
    np.testing.assert_allclose(found.p_value, expected)
    assert found.shuffled.shape == (39, 6)


def test_shuffles_are_circular_shifts_of_at_least_so_many_views() -> None:
    seen = []

    def statistic(rates: np.ndarray) -> np.ndarray:
        seen.append(rates)
        return rates[0]

    rates = np.stack([np.arange(12.0), 100 + np.arange(12.0)], axis=1)
    shuffle_test(statistic, rates, np.random.default_rng(0), shuffles=200, least_shift=3)
    first, *others = seen
    np.testing.assert_array_equal(first, rates)
    shifts = [int(-other[0, 0]) % 12 for other in others]
    assert sorted(set(shifts)) == [3, 4, 5, 6, 7, 8, 9]
    for shift, other in zip(shifts, others, strict=True):
        np.testing.assert_array_equal(other, np.roll(rates, shift, axis=0))


def test_place_cells_stand_out_and_p_is_uniform_for_cells_that_know_nothing(
    walk: np.ndarray, bump: Callable
) -> None:
    def information(rates: np.ndarray) -> np.ndarray:
        return spatial_information(rate_maps(rates, walk))

    rng = np.random.default_rng(2)
    elsewhere = np.abs((rng.normal(0, 0.1, (300, 4000, 2)).cumsum(axis=1) + 1) % 4 - 2) - 1
    ignorant = np.stack([bump(other, (0.3, -0.2)) for other in elsewhere], axis=1)
    place = np.stack([bump(walk, (0.5, 0.5)), bump(walk, (-0.4, 0.1))], axis=1)
    found = shuffle_test(information, np.concatenate([place, ignorant], axis=1), rng, shuffles=99)
    np.testing.assert_allclose(found.p_value[:2], 0.01)
    assert stats.kstest(found.p_value[2:], "uniform").pvalue > 0.01
    # Slow cells are tied to the place by chance: a null that scrambles the views would believe them all.
    scrambled = information(ignorant[rng.permutation(len(walk))])
    assert (found.observed[2:] > scrambled).all()


def test_unknown_statistics() -> None:
    def statistic(rates: np.ndarray) -> np.ndarray:
        return np.where(rates[0] > 0, rates[0], np.nan)

    rates = np.tile([1.0, 0, 2], (10, 1))
    rates[3:, 2] = 0
    found = shuffle_test(statistic, rates, np.random.default_rng(0), shuffles=9, least_shift=4)
    # The first cell always reaches itself; the third is mostly unknown, which speaks against it.
    np.testing.assert_array_equal(found.p_value, [1, np.nan, 1])


def test_same_generator_same_null(walk: np.ndarray) -> None:
    def null(seed: int) -> np.ndarray:
        rates = walk + 1
        return shuffle_test(lambda r: r[7], rates, np.random.default_rng(seed), shuffles=5).shuffled

    np.testing.assert_array_equal(null(0), null(0))
    assert (null(0) != null(1)).any()


def test_bad_input_is_refused() -> None:
    rng, rates = np.random.default_rng(0), np.ones((10, 1))
    with pytest.raises(CogmapError, match="rates is not finite"):
        shuffle_test(lambda r: r[0], rates * np.nan, rng)
    with pytest.raises(CogmapError, match="0 shuffles make no null"):
        shuffle_test(lambda r: r[0], rates, rng, shuffles=0, least_shift=1)
    for shift in (0, 6):
        with pytest.raises(CogmapError, match=f"10 views cannot shift by {shift}"):
            shuffle_test(lambda r: r[0], rates, rng, least_shift=shift)
