import numpy as np
import pytest
from jaxtyping import TypeCheckError

from arena.angles import wrap_angle
from tests.type_checks import CALLS, begin, first_calls


def add_one(number: int) -> int:
    return number + 1


def refused(function, wrong: object) -> bool:
    try:
        function(wrong)
    except Exception as error:  # noqa: BLE001  beartype makes its own
        return "beartype" in type(error).__module__
    return False


def test_the_first_calls_of_each_test_are_checked() -> None:
    begin()
    checked, other = first_calls(add_one), first_calls(add_one)
    assert all(checked(number) == number + 1 for number in range(CALLS - 1))
    assert refused(checked, 0.5)
    assert checked(0.5) == 1.5
    assert refused(other, 0.5)
    begin()
    assert refused(checked, 0.5)


def test_what_the_project_calls_is_checked() -> None:
    with pytest.raises(TypeCheckError, match="Type-check error"):
        wrap_angle(["no angle"])
    assert wrap_angle(np.array([0.5])) == 0.5
