import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.inputs import check_choice, check_views, checked_count, log_odours


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
