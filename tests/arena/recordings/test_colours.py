import numpy as np
import pytest

from arena.errors import ArenaError
from arena.recordings.colours import as_rgb

ROW = [0, 1, 128, 255]


def rgb(*levels: int) -> np.ndarray:
    return np.repeat(np.array([levels], np.uint8)[..., None], 3, axis=2)


@pytest.mark.parametrize(
    "picture",
    [
        np.array([ROW], np.uint8),
        np.array([ROW], np.uint8)[..., None],
        rgb(*ROW),
        np.array([ROW], np.uint16) * 257,
        (np.array([ROW], np.uint16) * 257).astype(">u2"),
        np.array([ROW]) / 255,
        (np.array([ROW]) / 255).astype(np.float32),
        (np.array([ROW]) / 255).astype(np.float16),
        (np.array([ROW]) / 255).tolist(),
    ],
    ids=["grey", "grey with an axis", "RGB", "16 bit", "from another machine", "float64", "32", "16", "list"],
)
def test_the_same_grey_from_everywhere(picture: np.ndarray) -> None:
    made = as_rgb(picture, "it")
    assert made.dtype == np.uint8
    assert made.flags.c_contiguous
    np.testing.assert_array_equal(made, rgb(*ROW))


def test_colours_keep_their_order_and_opacity_goes() -> None:
    picture = np.array([[[10, 20, 30, 7], [40, 50, 60, 0]]], np.uint8)
    np.testing.assert_array_equal(as_rgb(picture, "it"), [[[10, 20, 30], [40, 50, 60]]])
    np.testing.assert_array_equal(as_rgb(picture / 255, "it"), [[[10, 20, 30], [40, 50, 60]]])


def test_rounding_is_to_the_nearest() -> None:
    np.testing.assert_array_equal(as_rgb(np.array([[127.4, 127.6]]) / 255, "it"), rgb(127, 128))
    np.testing.assert_array_equal(as_rgb(np.array([[128, 129, 65535]], np.uint16), "it"), rgb(0, 1, 255))
    np.testing.assert_array_equal(as_rgb(np.array([[-1e-7, 1 + 1e-7]]), "it"), rgb(0, 255))


def test_truth_is_black_and_white() -> None:
    np.testing.assert_array_equal(as_rgb(np.array([[True, False]]), "it"), rgb(255, 0))


@pytest.mark.parametrize(
    ("picture", "words"),
    [
        (np.zeros((3, 4, 5), np.uint8), r"it is of shape \(3, 4, 5\); transpose it: its colours come first"),
        (np.zeros((4, 5, 2), np.uint8), r"it is of shape \(4, 5, 2\); \(height, width\)"),
        (np.zeros(4, np.uint8), r"it is of shape \(4,\)"),
        (np.zeros((0, 4), np.uint8), r"it is of shape \(0, 4\)"),
        (np.zeros((4, 5), int), "it is int64, whose white may be anything"),
        (np.full((4, 5), "x"), "it is <U1, whose"),
        (np.full((4, 5), 200.0), "it has values from 200 to 200; floats go from 0"),
        (np.array([[0.0, -0.1]]), "it has values from -0.1 to 0;"),
        (np.array([[0.0, np.nan]]), "it has values from nan to nan"),
    ],
)
def test_what_is_no_picture(picture: np.ndarray, words: str) -> None:
    with pytest.raises(ArenaError, match=words):
        as_rgb(picture, "it")
