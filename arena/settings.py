"""The values that describe a body, a nose or a motion: checked once, then never changed."""

from pydantic import BaseModel, ConfigDict, ValidationError

from arena.errors import ArenaError


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
            super().__init__(**fields)
        except ValidationError as error:
            raise ArenaError(f"{type(self).__name__}: {complaint(error)}") from None


def complaint(error: ValidationError) -> str:
    """Say in one line where the first mistake is, what was given there and what is wrong with it."""
    first = error.errors()[0]
    # A quoted key in TOML may hold a line break.
    keys = [str(key) if str(key).isprintable() else repr(key) for key in first["loc"]]
    given = first["input"]
    shown = (
        f" is {given!r}"
        if isinstance(given, str | int | float) and first["type"] != "extra_forbidden"
        else ""
    )
    return f"{'.'.join(keys) or 'the arena'}{shown}: {first['msg'].removeprefix('Value error, ')}"
