import numpy as np
import pytest

from cogmap.cells.checks import check_array, check_samples
from cogmap.errors import CogmapError


@pytest.mark.parametrize("shape", [(5, 3), (4, 2), (5,), (5, 2, 1)])
def test_wrong_shape_is_named(shape: tuple[int, ...]) -> None:
    with pytest.raises(CogmapError, match=r"positions has shape .*, not \(5, 2\)"):
        check_array("positions", np.zeros(shape), (5, 2))


def test_any_length_but_zero() -> None:
    check_array("rates", np.zeros((7, 1)), (None, None))
    with pytest.raises(CogmapError, match=r"not \(any, any\)"):
        check_array("rates", np.zeros((7, 0)), (None, None))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_not_finite_is_counted(value: float) -> None:
    array = np.zeros((6, 2))
    array[[3, 5], 1] = value
    with pytest.raises(CogmapError, match="not finite in 2 of 6 views, first in view 3"):
        check_array("odours", array, (None, 2))


def test_samples_must_fit_the_rates() -> None:
    rates, positions, headings = np.zeros((4, 3)), np.zeros((4, 2)), np.zeros(4)
    check_samples(rates, positions=positions, headings=headings)
    with pytest.raises(CogmapError, match="rates has shape"):
        check_samples(headings)
    with pytest.raises(CogmapError, match="positions has shape"):
        check_samples(rates, positions=positions[:3])
    with pytest.raises(CogmapError, match="headings has shape"):
        check_samples(rates, headings=headings[:3])
    with pytest.raises(CogmapError, match="down to -1 Hz"):
        check_samples(rates - 1)
