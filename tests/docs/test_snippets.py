"""Every Python block of the documentation runs, every command is one, every room and every plan is read."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from arena import Arena
from cogmap import Plan
from cogmap.commands import app
from cogmap.sweeps.points import points_of
from tests.docs.snippets import DOCS, blocks, commands, pages

PAGES = [page for page in pages() if page.is_relative_to(DOCS)]


def name(page: Path) -> str:
    return page.relative_to(DOCS).as_posix()


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python")], ids=name)
def test_the_python_of_a_page_runs_in_order(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for index, text in enumerate(blocks(page, "toml")):
        said = tomllib.loads(text)
        (tmp_path / f"{said.get('name', f'plan{index}')}.toml").write_text(text, encoding="utf-8")
    names: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, name(page), "exec"), names)  # noqa: S102
    out = capsys.readouterr().out
    assert "nan" not in out
    assert out.count("print") == 0
    assert len(out.splitlines()) >= sum(block.count("print(") for block in blocks(page, "python"))


@pytest.mark.parametrize("page", [page for page in pages() if commands(page)], ids=lambda page: page.stem)
def test_every_command_can_be_parsed(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for words in commands(page):
        if words[:2] == ["cogmap", "portable"]:
            words = words[2:] or words  # noqa: PLW2901
        if words[0] == "cogmap":
            tokens = [word for word in words[1:] if word != "&&"]
            app.parse_args(tokens, exit_on_error=False, print_error=False)
        else:
            assert words[0] in {"make", "pip", "python", ".", "dask"}, words


def test_every_toml_block_is_a_room_or_a_plan(tmp_path: Path) -> None:
    told = 0
    for page in PAGES:
        for text in blocks(page, "toml"):
            told += 1
            if "experiment" in tomllib.loads(text):
                assert len(points_of(Plan.parse(text))) > 1, page
            else:
                room = tmp_path / "room.toml"
                room.write_text(text, encoding="utf-8")
                assert Arena.load(room).walkable.area > 1, page
    assert told
