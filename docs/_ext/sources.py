"""The role ``:source:`path/of/a/file.py``` for files of the repository, which must be there."""

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

ROOT = Path(__file__).parents[2]
LOG = logging.getLogger(__name__)


def source(
    _: str, __: str, text: str, line: int, inliner: Any, *___: Any
) -> tuple[list[nodes.Node], list[nodes.system_message]]:
    """Show a path of the repository as code, and warn where there is no such file."""
    if not (ROOT / text).exists():
        LOG.warning(
            "there is no %s in the repository", text, location=(inliner.document.current_source, line)
        )
    return [nodes.literal(text, text)], []


def setup(app: Sphinx) -> dict[str, bool]:
    """Make it known to Sphinx."""
    app.add_role("source", source)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
