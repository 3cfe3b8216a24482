from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import scipy.sparse as sp
import torch

from cogmap.errors import CogmapError
from cogmap.inputs import (
    AnyArray,
    as_array,
    check_array,
    check_choice,
    check_views,
    checked_array,
    checked_count,
    checked_headings,
    checked_number,
    checked_rates,
    checked_views,
    log_odours,
)


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


class Odd:
    """Whatever says that it is an array."""

    def __array__(self, dtype: object = None, copy: object = None) -> np.ndarray:
        return np.arange(6.0).reshape(3, 2)


@pytest.mark.parametrize(
    "values",
    [
        [[0, 1], [2, 3], [4, 5]],
        ((0, 1), (2, 3), (4, 5)),
        pd.DataFrame({"x": [0, 2, 4], "y": [1, 3, 5]}),
        pd.DataFrame({"x": [0, 2, 4], "y": [1, 3, 5]}, dtype="Int64"),
        torch.arange(6.0).reshape(3, 2).requires_grad_(),
        [torch.arange(2.0), torch.arange(2.0, 4.0), torch.arange(4.0, 6.0)],
        np.arange(6, dtype=">f4").reshape(3, 2),
        np.arange(6, dtype=np.uint8).reshape(3, 2),
        np.arange(6, dtype=np.float16).reshape(3, 2),
        Odd(),
    ],
)
def test_whatever_holds_numbers_is_an_array(values: AnyArray) -> None:
    array = checked_array("positions", values, (3, 2))
    np.testing.assert_array_equal(array, np.arange(6).reshape(3, 2))
    assert type(array) is np.ndarray
    assert array.dtype in (np.float32, np.float64)
    assert as_array("positions", values).dtype.isnative


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([[1, 2], [3]], "cannot be made an array"),
        (["a", "b"], "holds text or objects"),
        (pd.DataFrame({"x": [1.0], "cell": ["CA1"]}), "text|array"),
        (sp.csr_array(np.eye(3)), "holds a csr_array"),
        (np.ones(3) * 1j, "holds complex numbers"),
        (None, "there are no positions"),
    ],
)
def test_what_holds_no_numbers_is_refused(values: object, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        as_array("positions", values)


def test_what_is_masked_or_missing_is_not_believed() -> None:
    masked = np.ma.masked_greater([[1.0, 1023.0]], 1000)
    for values in (masked, pd.DataFrame({"x": [1], "y": [pd.NA]}, dtype="Int64")):
        with pytest.raises(CogmapError, match="not finite in 1 of 1 views"):
            checked_array("positions", values, (None, 2))


@pytest.mark.parametrize(
    ("shape", "wanted", "hint"),
    [
        ((5,), (None, None), r"rates\[:, None\]"),
        ((5, 3), (5, 2), r"rates\[:, :2\]"),
        ((2, 5), (5, 2), r"rates\.T"),
        ((5, 1), (5,), r"rates\[:, 0\]"),
    ],
)
def test_a_wrong_shape_is_told_what_would_fit(
    shape: tuple[int, ...], wanted: tuple[int | None, ...], hint: str
) -> None:
    with pytest.raises(CogmapError, match=hint):
        checked_array("rates", np.ones(shape), wanted)


def test_rates_are_never_negative() -> None:
    assert checked_rates(np.zeros((4, 3), bool)).dtype == float
    with pytest.raises(CogmapError, match="down to -1 Hz"):
        checked_rates(-np.ones((4, 3)))


def test_headings_beyond_two_turns_are_not_believed() -> None:
    turn = np.linspace(-4 * np.pi, 4 * np.pi, 9)
    np.testing.assert_array_equal(checked_headings(turn, 9), turn)
    with pytest.raises(CogmapError, match=r"from -180 to 170, farther than two turns .* look like degrees"):
        checked_headings(np.arange(-180.0, 180.0, 10))
    with pytest.raises(CogmapError, match=r"may be unwrapped; give .*angle"):
        checked_headings(np.linspace(0, 400, 9))


@pytest.mark.parametrize("value", [-1, np.nan, np.inf, "1", True, None])
def test_numbers_are_finite_and_not_below_the_least(value: object) -> None:
    assert type(checked_number("smell", np.float32(0.5))) is float
    with pytest.raises(CogmapError, match="smell is"):
        checked_number("smell", value)


def test_views_are_taken_as_tensors_and_lists_and_left_alone_when_lazy() -> None:
    views = np.arange(2 * 4 * 5 * 3, dtype=np.uint8).reshape(2, 4, 5, 3)
    for given in (torch.from_numpy(views), list(views), [torch.from_numpy(view) for view in views]):
        np.testing.assert_array_equal(checked_views(given, (4, 5, 3)), views)
    lazy = SimpleNamespace(shape=views.shape, dtype=views.dtype)
    assert checked_views(lazy) is lazy


@pytest.mark.parametrize(
    ("views", "hint"),
    [
        (torch.zeros((2, 3, 4, 5), dtype=torch.uint8), "colours come last"),
        (np.zeros((4, 5, 3), np.uint8), r"views\[None\]"),
        (np.zeros((2, 4, 5), np.uint8), "each grey three times"),
        (np.zeros((2, 4, 5, 4), np.uint8), "fourth channel"),
        (np.zeros((2, 4, 5, 3), np.float32), r"rint\(255 \* views\)"),
    ],
)
def test_views_of_another_kind_are_told_what_would_fit(views: object, hint: str) -> None:
    with pytest.raises(CogmapError, match=hint):
        checked_views(views)


def test_what_a_recording_lacks_is_told() -> None:
    with pytest.raises(CogmapError, match="there are no odours"):
        log_odours(None)
    with pytest.raises(CogmapError, match="there are no poses"):
        check_array("poses", None, (3, 3))
