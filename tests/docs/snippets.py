"""What the pages of the documentation and the README show to be typed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```", re.DOTALL | re.MULTILINE)


def pages() -> list[Path]:
    """Every page that is written by hand."""
    built = {DOCS / "_build", DOCS / "api", DOCS / "notebooks"}
    return [
        ROOT / "README.md",
        *sorted(page for page in DOCS.rglob("*.md") if not built & set(page.parents)),
    ]


def blocks(page: Path, language: str) -> list[str]:
    """Give the blocks of a page in one language, in order."""
    return [text for name, text in FENCE.findall(page.read_text(encoding="utf-8")) if name == language]


def commands(page: Path) -> list[list[str]]:
    """Split the commands of a page into words, without comments; lines that end in a backslash go on."""
    lines = "\n".join(blocks(page, "sh")).replace("\\\n", " ").splitlines()
    return [words for line in lines if (words := shlex.split(line, comments=True))]
