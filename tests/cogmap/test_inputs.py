import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.inputs import check_array, check_choice, check_samples, check_views, checked_count, log_odours


@pytest.mark.parametrize("value", [0, -3, 2.5, "7", None, True])
def test_counts_are_whole_and_positive(value: object) -> None:
    with pytest.raises(CogmapError, match="charts"):
        checked_count("charts", value)


def test_counts_may_be_numpy() -> None:
    assert checked_count("charts", np.int64(3)) == 3


def test_choices_are_told() -> None:
    check_choice("metric", "cosine", ("euclidean", "cosine"))
    with pytest.raises(CogmapError, match="unknown metric 'manhattan'; choose one of euclidean, cosine"):
        check_choice("metric", "manhattan", ("euclidean", "cosine"))


def test_log_odours() -> None:
    smells = np.array([[1.0, np.e], [np.e**2, 1.0]])
    np.testing.assert_allclose(log_odours(smells), [[0, 1], [2, 0]], atol=1e-6)
    for bad in (np.inf, np.nan, 0.0, -1.0):
        with pytest.raises(CogmapError, match="view 1"):
            log_odours(np.array([[1.0], [bad]]))


def test_views_must_be_images() -> None:
    check_views(np.zeros((2, 4, 5, 3), np.uint8), (4, 5, 3))
    for bad in ([1, 2], np.zeros((2, 4, 5), np.uint8), np.zeros((2, 4, 5, 3))):
        with pytest.raises(CogmapError, match="uint8"):
            check_views(bad)


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


def test_what_a_recording_lacks_is_told() -> None:
    with pytest.raises(CogmapError, match="there are no odours"):
        log_odours(None)
    with pytest.raises(CogmapError, match="there are no poses"):
        check_array("poses", None, (3, 3))
