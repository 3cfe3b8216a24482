from pathlib import Path

import pytest

from arena.errors import ArenaError
from arena.paths import user_path


def test_a_tilde_at_the_beginning_is_the_home(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/somewhere")
    assert user_path("~/walk.zarr") == Path("/somewhere/walk.zarr")
    assert user_path(Path("~/walk.zarr")) == Path("/somewhere/walk.zarr")
    assert user_path("walk~.zarr") == Path("walk~.zarr")


def test_an_unknown_home_is_told() -> None:
    with pytest.raises(ArenaError, match="~nobody-of-this-name/walk begins with a home that is not known"):
        user_path("~nobody-of-this-name/walk")
