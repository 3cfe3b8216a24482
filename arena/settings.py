"""Settings: the values that describe a body, a nose or a motion, checked once, then never changed."""

from collections.abc import Mapping, Sequence
from reprlib import Repr
from typing import Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from arena.errors import ArenaError

Positive = Annotated[float, Field(ge=0.01, le=100)]
Spread = Annotated[float, Field(ge=0, le=100)]
Share = Annotated[float, Field(ge=0, le=1)]
Whole: TypeAlias = int | np.integer
"""A whole number, Python's or numpy's."""
AnyArray: TypeAlias = ArrayLike | Sequence[Any]
"""Numbers as people have them: arrays, nested lists, DataFrames, Series, tensors, what has `__array__`."""

_shortened = Repr()
_shortened.maxstring = 60


class Settings(BaseModel):
    """A frozen set of named parameters that says in one sentence what is wrong with a bad one.

    Raises
    ------
    ArenaError
        From the constructor, for an unknown parameter or a value out of its range (NaN always is).
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    def __init__(self, **fields: object) -> None:
        try:
            super().__init__(**plain(fields))
        except ValidationError as error:
            raise ArenaError(f"{type(self).__name__}: {first_error(error)}") from None


def plain(value: Any) -> Any:
    """Turn numpy's numbers and arrays into Python's, in tables and lists, too; JSON knows no others."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if type(value) in (list, tuple):
        return type(value)(map(plain, value))
    return value


def checked_whole(name: str, value: object, least: int = 0) -> int:
    """Return a whole number of at least `least`.

    Raises
    ------
    ArenaError
        For anything else.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise ArenaError(f"{name} is {value!r}; give a whole number of at least {least}")
    return int(value)


def first_error(error: ValidationError) -> str:
    """Say in one line where the first mistake is, what was given there and what is wrong with it."""
    first = error.errors()[0]
    place = first["loc"]
    if first["type"] != "extra_forbidden":
        # Which of several kinds of value was tried is no key.
        place = tuple(key for key in place if not str(key).startswith("<"))
    # A quoted key in TOML may hold a line break.
    keys = [str(key) if str(key).isprintable() else repr(key) for key in place]
    given = first["input"]
    # Python refuses to print whole numbers of more than 4300 digits.
    printable = isinstance(given, str | float) or (isinstance(given, int) and abs(given) < 10**20)
    shown = f" is {_shortened.repr(given)}" if printable and first["type"] != "extra_forbidden" else ""
    # What pydantic calls by the names of Python.
    in_toml = {"tuple_type": "Input should be a list", "model_type": "Input should be a table"}
    wrong = in_toml.get(first["type"], first["msg"].removeprefix("Value error, "))
    return f"{'.'.join(keys) or 'the arena'}{shown}: {wrong}"
