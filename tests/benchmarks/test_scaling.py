import time

import numpy as np
import pytest

from benchmarks.scaling import FACES, growth, hall, spent


def test_exponent_of_a_power_law_is_found_without_error() -> None:
    found = growth((1, 4, 16, 64, 256), lambda size: 3e-3 * size**1.5)
    assert found["sizes"] == [1, 4, 16, 64, 256]
    assert found["seconds"] == pytest.approx([0.003, 0.024, 0.192, 1.536, 12.288])
    assert found["exponent"] == pytest.approx(1.5)
    assert found["exponent_error"] < 1e-6


def test_error_is_that_of_a_straight_line_through_logarithms() -> None:
    sizes, seconds = np.array([10, 20, 40, 80]), np.array([1.1, 1.8, 4.4, 7.2])
    costs = dict(zip(sizes.tolist(), seconds.tolist(), strict=True))
    found = growth(tuple(costs), costs.__getitem__)
    x, y = np.log(sizes) - np.log(sizes).mean(), np.log(seconds) - np.log(seconds).mean()
    slope = (x @ y) / (x @ x)
    assert found["exponent"] == pytest.approx(slope)
    left = y - slope * x
    assert found["exponent_error"] == pytest.approx(np.sqrt((left @ left) / (len(x) - 2) / (x @ x)))


@pytest.mark.parametrize("faces", FACES)
def test_hall_has_as_many_faces_as_it_is_told(faces: int) -> None:
    assert len(hall(faces).surfaces.start) == faces


def test_the_least_of_the_runs_counts_but_not_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    now, turns = [0.0], iter([1.0, 4.0, 3.0, 5.0])
    monkeypatch.setattr(time, "process_time", lambda: now[0])

    def work() -> None:
        now[0] += next(turns)

    assert spent(work, 3) == 3.0
