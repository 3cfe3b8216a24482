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
    assert doubt(1, 1, [sure, unsure, sure], []) == ""
    assert doubt(1, 1, [unsure, unsure, sure], []) != ""


def test_another_graph_must_count_as_many() -> None:
    draws = [bars(3, 0.5)]
    assert doubt(1, 1, draws, [(25, bars(1.01, 0.99))]) == ""
    assert doubt(1, 1, draws, [(25, bars(1.02, 1.01))]) == "with 25 neighbours it is 2"


def test_each_dimension_has_its_pair() -> None:
    draw = bars((MARGINS[1][1] + MARGINS[2][1]) / 2)
    assert doubt(1, 0, [draw], []) != ""
    assert doubt(2, 0, [draw], []) == ""
