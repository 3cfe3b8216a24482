"""What the README prints is run, at its own size; words are learnt from fewer descriptors, of small views."""

import re
from pathlib import Path

import pytest

from arena import Camera
from cogmap import Plan
from cogmap.commands import app
from cogmap.features import vocabulary
from cogmap.sweeps.points import points_of

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_python_examples_run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    look = Camera.perspective
    monkeypatch.setattr(vocabulary, "EXAMPLES", 2000)
    monkeypatch.setattr(Camera, "perspective", lambda width=160, height=120: look(width, height))
    for example in re.findall(r"```python\n(.*?)```", README, re.DOTALL):
        exec(compile(example, "README.md", "exec"), {})  # noqa: S102
    scores, numbers, coordinates, swept = capsys.readouterr().out.splitlines()
    assert "heading_median_deg" in scores
    assert numbers == "(1, 1, 0)"
    assert coordinates.startswith("(400, 2) 1 ")
    assert coordinates.endswith(" 1.0")
    assert swept == "2 True"


def test_the_sweep_can_be_begun() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", README, re.DOTALL)
    assert len(points_of(Plan.parse(text))) == 18


def test_every_command_and_picture_exists() -> None:
    root = Path(__file__).parents[1]
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", README):
        assert (root / picture).is_file()
    makefile = (root / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"`?make (\w+)", README):
        if target != "and":
            assert f"\n{target}:" in makefile
    for command in re.findall(r"^cogmap (\w+)", README, re.MULTILINE):
        assert command in app
