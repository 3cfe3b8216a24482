"""The page of `make bench`: what was measured, how, and beside what, in Markdown."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from cogmap.tables import as_markdown

HEAD = """# Performance

`make bench` writes this page. {processor}, {cores} cores; Python {python}, {libraries}.
Each subject says how busy the machine was (load over a minute, before and after); its cores are shared.

Where a peer is named, both work in turn in the same run. Speeds, a second, are those of each one's fastest
turn, and `ratio` is that of these two, above 1 where this code is faster; median, lowest and highest are over
the turns.
"""
COMPARED = {
    "peer": "beside",
    "per_s": "ours a second",
    "peer_per_s": "its",
    "ratio": "ratio",
    "ratio_median": "median",
    "ratio_lowest": "lowest",
    "ratio_highest": "highest",
}
"""What `benchmarks.timing.versus` tells, and its columns."""


class Parts(NamedTuple):
    """Rows of the tables of a subject, by names in words."""

    compared: list[dict[str, str]]
    grown: list[dict[str, str]]
    others: list[dict[str, str]]


def as_page(figures: Mapping[str, Any], said: Mapping[str, str], drawn: str) -> str:
    """Write all that was measured, in the order of `said`.

    Parameters
    ----------
    figures
        What `python -m benchmarks` prints.
    said
        By subject, how it is measured; those that are not among the figures are left out.
    drawn
        Where the figure of how cost grows is, from the page.
    """
    machine = dict(figures["machine"])
    known = {name: machine.pop(name) for name in ("processor", "cores", "python")}
    libraries = ", ".join(f"{name} {version}" for name, version in machine.items())
    sections = [section(name, figures[name], how, drawn) for name, how in said.items() if name in figures]
    return "\n".join([HEAD.format(**known, libraries=libraries), *sections])


def section(name: str, figures: Mapping[str, Any], how: str, drawn: str) -> str:
    """Write of one subject: how it is measured, and its tables."""
    rest = dict(figures)
    load = f"Load: {rest.pop('load_before'):.1f} before, {rest.pop('load_after'):.1f} after."
    parts = Parts([], [], [])
    sort(rest, (), parts)
    picture = [f"![Log–log plots of seconds against sizes]({drawn})"] if parts.grown else []
    tables = [as_markdown(rows) for rows in parts if rows]
    return "\n\n".join([f"## {name.capitalize()}", how, load, *picture, *tables]) + "\n"


def sort(figures: Mapping[str, Any], path: tuple[str, ...], into: Parts) -> None:
    """Put a record, and those in it, into the tables where they belong."""
    name, rest = " ".join(path).replace("_", " "), dict(figures)
    if "exponent" in rest:
        into.grown.append(grown(name, rest))
        return
    if "peer" in rest:
        row = {column: number(rest.pop(key, "")) for key, column in COMPARED.items()}
        row["ratio"] = row["ratio"] or str(rest.pop("not_measured"))
        into.compared.append({"what": name, **row})
    for key, value in rest.items():
        if isinstance(value, Mapping):
            sort(value, (*path, key), into)
        elif value != "":
            into.others.append({"figure": f"{name} {key}".strip().replace("_", " "), "value": number(value)})


def grown(name: str, figures: Mapping[str, Any]) -> dict[str, str]:
    """Tell the smallest and the largest size, their seconds, and the exponent between them."""
    what, by = name.split(" by ")
    sizes, seconds = figures["sizes"], figures["seconds"]
    return {
        "what": what,
        "by": f"{number(sizes[0])} to {number(sizes[-1])} {by}",
        "seconds": f"{number(seconds[0])} to {number(seconds[-1])}",
        "exponent": f"{figures['exponent']:.2f} ± {figures['exponent_error']:.2f}",
        "between the two largest": f"{np.log(seconds[-1] / seconds[-2]) / np.log(sizes[-1] / sizes[-2]):.2f}",
    }


def number(value: float | str) -> str:
    """Print a number so that it reads well: three digits, or all of a thousand and more."""
    if isinstance(value, str):
        return value
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"
