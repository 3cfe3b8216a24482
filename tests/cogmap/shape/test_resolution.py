import numpy as np
import pytest

from cogmap.shape.resolution import MARGINS, doubt

LEAST, MOST = MARGINS[1]


def bars(*over: float) -> np.ndarray:
    return np.array(over)


def test_what_stands_clear_of_the_threshold_is_resolved() -> None:
    assert doubt(1, 1, [bars(LEAST, MOST)], []) == ""
    assert doubt(1, 0, [bars(MOST, 0.1)], []) == ""
    assert doubt(1, 2, [bars(9, np.inf)], []) == ""
    assert doubt(0, 0, [bars()], []) == ""


@pytest.mark.parametrize(
    ("number", "draw", "reason"),
    [
        (1, bars(LEAST - 0.01, 0.5), "its weakest bar stands at"),
        (2, bars(3, LEAST - 0.01, 0.5), "its weakest bar stands at"),
        (1, bars(3, MOST + 0.01), "a bar that does not count stands at"),
        (0, bars(MOST + 0.01), "a bar that does not count stands at"),
        (1, bars(), "its weakest bar stands at 0.00"),
    ],
)
def test_a_close_call_is_not(number: int, draw: np.ndarray, reason: str) -> None:
    assert doubt(1, number, [draw], []).startswith(reason)


def test_the_median_draw_decides() -> None:
    sure, unsure = bars(3, 0.5), bars(1.01, 0.99)
    assert doubt(1, 1, [unsure, sure, sure], []) == ""
    assert doubt(1, 1, [sure, unsure, unsure], []) != ""


def test_another_look_must_count_as_many() -> None:
    draws, close = [bars(3, 0.5)], ("with 25 neighbours", bars(1.01, 0.99))
    assert doubt(1, 1, draws, [close]) == ""
    assert doubt(1, 1, draws, [close, ("without outliers", bars(1.02, 1.01))]) == "without outliers it is 2"


@pytest.mark.parametrize("dimension", [0, 1])
def test_of_pieces_and_loops_little_is_sure_near_the_threshold(dimension: int) -> None:
    assert doubt(dimension, 1, [bars(1.21, 0.89)], []) == ""
    assert doubt(dimension, 1, [bars(1.19, 0.89)], []) != ""
    assert doubt(dimension, 1, [bars(1.21, 0.91)], []) != ""


def test_voids_are_sure_nearer_to_it() -> None:
    assert doubt(2, 1, [bars(1.11, 0.96)], []) == ""
    assert doubt(2, 1, [bars(1.09, 0.96)], []) != ""
    assert doubt(2, 1, [bars(1.11, 0.98)], []) != ""
