"""Type checks at run time, of the first calls of each function in a test.

A check takes fifty microseconds, and what the thousandth call is given is seldom of another kind than the
tenth: to check all of them takes a third of the time of all tests.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

from beartype import beartype

CALLS = 20
"""That are checked, of each function in each test."""
_BEGUN = [0]
"""Number of tests that have begun."""


def begin() -> None:
    """Let every function be checked anew."""
    _BEGUN[0] += 1


def first_calls(function: Callable[..., Any]) -> Callable[..., Any]:
    """Check the first calls of a function since `begin`, by beartype."""
    checked, test, left = beartype(function), -1, 0

    @wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        nonlocal test, left
        if test != _BEGUN[0]:
            test, left = _BEGUN[0], CALLS
        if not left:
            return function(*given, **named)
        left -= 1
        return checked(*given, **named)

    return call
