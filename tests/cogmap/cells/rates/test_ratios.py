import numpy as np

from cogmap.cells.rates.ratios import ratio


def test_nothing_over_nothing_is_unknown() -> None:
    np.testing.assert_array_equal(ratio(np.array([0.0, 1, 6]), np.array([0.0, 0, 3])), [np.nan, np.nan, 2])


def test_broadcasts_and_keeps_complex() -> None:
    quotient = ratio(np.array([[2j, 4.0]]), np.array([[2.0], [0.0]]))
    np.testing.assert_array_equal(quotient, [[1j, 2], [np.nan, np.nan]])


def test_float32_is_divided_in_float64() -> None:
    assert ratio(np.ones(1, np.float32), np.full(1, 3, np.float32))[0] == 1 / 3
