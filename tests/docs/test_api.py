"""No public name is missing in the API: each package with a face has its page."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from tests.docs.snippets import DOCS, ROOT

SHOWN_ELSEWHERE = {"arena.motions", "cogmap.commands", "cogmap.pages.report"}
"""Names that `arena` has, too, and what documents itself on the command line."""


def faces() -> set[str]:
    """Packages that say what is public."""
    found = set()
    for path in (
        path for top in ("arena", "neurons", "cogmap") for path in (ROOT / top).rglob("__init__.py")
    ):
        named = [
            node for node in ast.parse(path.read_text(encoding="utf-8")).body if isinstance(node, ast.Assign)
        ]
        if any(
            isinstance(target, ast.Name) and target.id == "__all__"
            for node in named
            for target in node.targets
        ):
            found.add(".".join(path.parent.relative_to(ROOT).parts))
    return found


def shown(path: Path, pattern: str) -> set[str]:
    return set(re.findall(pattern, path.read_text(encoding="utf-8"), re.MULTILINE))


def test_every_package_with_a_face_has_a_page() -> None:
    pages = shown(DOCS / "_ext" / "every_public_name.py", r'^    "([\w.]+)": "')
    assert faces() - SHOWN_ELSEWHERE <= pages
    assert shown(DOCS / "api" / "index.md", r"^((?:arena|neurons|cogmap)[\w.]*)$") == pages
