"""Every Python block of the documentation runs, every command is one, every room and every plan is read."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from arena import Arena, Camera
from cogmap import Plan
from cogmap.commands import app
from cogmap.features import vocabulary
from cogmap.sweeps.points import points_of
from tests.docs.snippets import DOCS, ROOT, blocks, commands, pages

PRINTS = {
    "howto/animal.md": r"\s+fields .*\n0 +1 +[1-9].*\n\(1,\)\n\(4000, 2\) True\n",
    "howto/body.md": r"0.02\n\(40, 2\) \['circle', 'line'\]\n",
    "howto/camera.md": r"\(400, 20, 120, 3\) \(400, 3\) 39.9\n\(100, \d+\) \d.*\n",
    "howto/cell.md": r"fields +\d.*\nspatial_information +[1-9].*\n.*\n",
    "howto/many_rooms.md": r"2 \[.*0 1\]\n",
    "howto/motion.md": r"\(60, 3\) .*Spiral.*\n\(40, 2\)\n",
    "howto/room.md": r"my_room 3 \[False  True\]\n\(50, 15, 90, 3\) \(50, 3\)\n",
    "howto/sweep.md": r"2 True\n",
    "reference_of_the_world.md": r"",
    "results/paper.md": r"\(400, 2\) 1 \d+ 1.0\n",
}
"""What the Python of each page prints, as a pattern."""
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
    look = Camera.perspective
    monkeypatch.setattr(
        vocabulary, "EXAMPLES", 2000
    )  # words are learnt from fewer descriptors, of small views
    monkeypatch.setattr(Camera, "perspective", lambda width=160, height=120: look(width, height))
    names: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, name(page), "exec"), names)  # noqa: S102
    assert re.fullmatch(PRINTS[name(page)], capsys.readouterr().out)


@pytest.mark.parametrize("page", [page for page in pages() if commands(page)], ids=lambda page: page.stem)
def test_every_command_can_be_parsed(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for words in commands(page):
        called = words[2:] if words[:2] == ["cogmap", "portable"] else words
        if called[0] == "cogmap":
            app.parse_args(called[1:], exit_on_error=False, print_error=False)
        else:
            assert called[0] == "make", called
            assert f"\n{called[1]}:" in (ROOT / "Makefile").read_text(encoding="utf-8")


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
