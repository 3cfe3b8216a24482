import json
from typing import Annotated

import numpy as np
import pytest
from pydantic import Field, ValidationError

from arena.errors import ArenaError
from arena.settings import Settings, checked_whole, plain


class Legs(Settings):
    count: Annotated[int, Field(ge=0)] = 4
    length: float = 0.1


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ({"count": -1}, "Legs: count is -1: Input should be greater than or equal to 0"),
        ({"count": "a\nb"}, "Legs: count is 'a\\nb': Input should be a valid integer"),
        ({"length": np.nan}, "Legs: length is nan: Input should be a finite number"),
        ({"length": np.zeros((2, 2))}, "Legs: length: Input should be a valid number"),
        ({"wings": 2}, "Legs: wings: Extra inputs are not permitted"),
        ({"wi\nngs": 2}, "Legs: 'wi\\nngs': Extra inputs are not permitted"),
    ],
)
def test_mistakes_are_said_in_one_line(fields: dict[str, object], says: str) -> None:
    with pytest.raises(ArenaError) as error:
        Legs(**fields)
    assert str(error.value).startswith(says)
    assert len(str(error.value).splitlines()) == 1


def test_settings_are_values() -> None:
    legs = Legs(count=6)
    assert legs == Legs(count=6, length=0.1) != Legs()
    assert legs.model_dump() == {"count": 6, "length": 0.1}
    with pytest.raises(ValidationError, match="frozen"):
        legs.count = 8


def test_numbers_are_pythons_whatever_they_were() -> None:
    legs = Legs(count=np.int64(6), length=np.float32(0.5))
    assert (type(legs.count), type(legs.length)) == (int, float)
    told = plain(
        {"a": np.int64(1), "b": [np.float32(0.5), (np.array([1]).all(), "x")], "c": np.zeros((1, 2))}
    )
    assert json.loads(json.dumps(told)) == {"a": 1, "b": [0.5, [True, "x"]], "c": [[0.0, 0.0]]}


@pytest.mark.parametrize("value", [-1, 1.0, "1", True, None])
def test_whole_numbers_are_whole(value: object) -> None:
    assert type(checked_whole("seed", np.uint8(3))) is int
    with pytest.raises(ArenaError, match=r"seed is .*; give a whole number of at least 0"):
        checked_whole("seed", value)
