"""The report's page: self-contained, no script, and nothing that is fetched from elsewhere."""

from __future__ import annotations

from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from cogmap.atomic import atomic_write, user_path
from cogmap.errors import CogmapError
from cogmap.pages.report.contents import read_contents

_PAGES = Environment(
    loader=PackageLoader("cogmap.pages.report", "."),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_MARK = '<meta name="generator" content="cogmap report">'
"""By which an earlier report is known."""


def report(folder: str | Path, out: str | Path | None = None) -> Path:
    """Write a result as one HTML page.

    Parameters
    ----------
    folder
        What `cogmap demo`, `cogmap experiment` or `cogmap sweep` wrote.
    out
        The page, `report.html` in the folder when None; an earlier report there is replaced at the end.

    Raises
    ------
    CogmapError
        When the folder is no result or damaged, something other than a report is at `out`, or it
        cannot be written.
    """
    folder = user_path(folder)
    out = folder / "report.html" if out is None else user_path(out)
    page = _PAGES.get_template("report.html").render(found=read_contents(folder), mark=_MARK)
    with atomic_write(out) as fresh:
        if out.exists() and (not out.is_file() or _MARK.encode() not in out.read_bytes()[:1000]):
            raise CogmapError(f"{out} exists and is not a report; choose another path or remove it first")
        fresh.write_text(page, encoding="utf-8")
    return out
