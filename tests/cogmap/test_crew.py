from collections.abc import Iterator

import pytest

from cogmap import CogmapError, crew
from cogmap.crew import Wording, on_cluster, on_this_machine

WORDING = Wording("a square", "nothing is kept")


def square(number: int) -> int:
    return number * number


def test_one_process_takes_items_when_it_has_done_those_before() -> None:
    taken = list[int]()

    def numbers() -> Iterator[int]:
        for number in range(4):
            taken.append(number)
            yield number

    done = on_this_machine(square, numbers(), 1, WORDING)
    assert next(done) == 0
    assert len(taken) < 4
    assert list(done) == [1, 4, 9]


def test_what_the_work_raises_is_raised() -> None:
    with pytest.raises(TypeError, match="multiply"):
        list(on_this_machine(square, ["a", "b"], 1, WORDING))  # type: ignore[list-item]


def test_a_scheduler_that_is_not_there_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew, "PATIENCE", 0.5)
    with pytest.raises(CogmapError, match="no Dask scheduler answers at tcp://127"):
        list(on_cluster(square, [1], "tcp://127.0.0.1:9", WORDING))
