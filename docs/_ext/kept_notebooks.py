"""Notebooks lie at the root of the repository; they are brought here, where Sphinx looks for pages."""

import shutil
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.config import Config

ROOT = Path(__file__).parents[2] / "notebooks"


def bring(app: Sphinx, _: Config) -> None:
    """Copy what has changed, and take away what is no more."""
    here = Path(app.srcdir) / "notebooks"
    pages = [*ROOT.glob("*.ipynb"), *ROOT.glob("*/README.md")]
    wanted = {here / page.relative_to(ROOT): page for page in pages}
    for old in {*here.rglob("*.ipynb"), *here.rglob("*.md")} - wanted.keys():
        old.unlink()
    for copy, page in wanted.items():
        # an unchanged page keeps its time, so that it is not read again
        if not copy.exists() or copy.read_bytes() != page.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(page, copy)


def setup(app: Sphinx) -> dict[str, bool]:
    """Make it known to Sphinx."""
    app.connect("config-inited", bring)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
