"""What the README prints is run, at its own size; it stays short, and what it points to is there."""

import re
from pathlib import Path

import pytest

from cogmap.commands import app

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert len([line for line in example.splitlines() if line]) == 12
    exec(compile(example, "README.md", "exec"), {})  # noqa: S102
    scores, numbers = capsys.readouterr().out.splitlines()
    assert "heading_median_deg" in scores
    assert numbers == "(1, 1, 0)"


def test_it_is_read_in_two_minutes() -> None:
    lines = README.splitlines()
    assert len(lines) <= 90
    headings = [line.removeprefix("## ") for line in lines if line.startswith("## ")]
    assert headings == [
        "Install, and two commands",
        "In Python",
        "What you can do",
        "What is shown",
        "Limits",
        "Citing",
    ]


def test_every_command_and_picture_exists() -> None:
    root = Path(__file__).parents[1]
    there = re.findall(r"\]\((.*?)\)", README)
    assert len(there) > 20
    assert [link for link in there if not (root / link).is_file()] == []
    (moving,) = [link for link in there if link.endswith(".gif")]
    assert (root / moving).stat().st_size < 2_000_000
    makefile = (root / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"`?make (\w+)", README):
        if target != "and":
            assert f"\n{target}:" in makefile
    for command in re.findall(r"^cogmap (\w+)", README, re.MULTILINE):
        assert command in app
