"""Delimited text: what parts the cells, the encoding and the line of names are found out by reading."""

import csv
import re
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Int

from arena.errors import ArenaError

MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
"""Encodings by their byte order marks."""
DELIMITERS = ("\t", ";", ",")
"""What may part cells; the first that parts the names and most first lines is it: commas may be decimal."""
ABSENT = ("", "na", "n/a", "nan", "none", "null")
"""What trackers and spreadsheets write where there is no number, in any case."""
PEEK = 20
"""Lines that are looked at to find out how a file is written."""

Rows = Int[np.ndarray, " samples"]
"""Where in its file each sample is, for errors."""


class Layout(NamedTuple):
    """How a text is written."""

    encoding: str
    delimiter: str
    skipped: int
    """Lines before the names."""
    heads: int
    """Lines of names: one, or those of DeepLabCut."""
    names: tuple[str, ...]
    """Of the columns; in DeepLabCut's tables `frame`, then `nose.x`, or `rat1.nose.x` for one of several."""


def layout_of(path: Path) -> Layout:
    """Find out how a text is written.

    UTF-8 and UTF-16, with a byte order mark or without, and what is neither is taken for Windows' western
    code page; tabs, semicolons or commas, unless a first line such as `sep=;` says so; one line of names, or
    the three or four of DeepLabCut (scorer, individuals, bodyparts, coords), parts of a name joined by dots.

    Raises
    ------
    OSError, ValueError, csv.Error
        When it cannot be read, or is no text.
    """
    encoding = _encoding(path)
    with path.open(encoding=encoding, newline="") as file:
        lines = list(islice(file, PEEK))
    told = re.fullmatch(r"\s*sep=(.)\s*", lines[0], re.IGNORECASE) if lines else None
    skipped = 1 if told else 0
    while skipped < len(lines) and not lines[skipped].strip():
        skipped += 1
    lines = lines[skipped:]
    delimiter = told[1] if told else _delimiter(lines)
    table = list(_parsed(lines, delimiter))
    heads, names = _names(table)
    return Layout(encoding, delimiter, skipped, heads, names)


def read_delimited(path: Path, layout: Layout, wanted: Collection[str]) -> tuple[dict[str, list[str]], Rows]:
    """Read the cells of some columns, stripped, and on which line of the file each row ends.

    Empty lines are left out. An empty cell after the last name, as of a delimiter at the end, is none.

    Raises
    ------
    ArenaError
        For a row of too many or too few cells.
    OSError, ValueError, csv.Error
        When it cannot be read.
    """
    width = len(layout.names)
    index = {name: layout.names.index(name) for name in wanted}
    cells, rows = {name: list[str]() for name in wanted}, list[int]()
    with path.open(encoding=layout.encoding, newline="") as file:
        for _ in range(layout.skipped):
            next(file)
        lines = csv.reader(file, delimiter=layout.delimiter, strict=True)
        for _ in range(layout.heads):
            next(lines)
        for row in lines:
            if not row:
                continue
            if len(row) != width and not (len(row) == width + 1 and not row[-1].strip()):
                raise ArenaError(
                    f"{path}: row {lines.line_num + layout.skipped} has {len(row)} cells, not {width}; "
                    "fill it up"
                )
            rows.append(lines.line_num + layout.skipped)
            for name, at in index.items():
                cells[name].append(row[at].strip())
    return cells, np.array(rows, dtype=int)


def to_numbers(path: Path, cells: dict[str, list[str]], rows: Rows) -> dict[str, np.ndarray]:
    """Read cells as numbers, NaN where there is none; decimals have points, or all of them commas.

    Raises
    ------
    ArenaError
        For what is no number, and where some have commas and some points.
    """
    comma = [any("," in cell for cell in column) for column in cells.values()]
    point = [any("." in cell for cell in column) for column in cells.values()]
    if any(comma) and any(point):
        a, b = (list(cells)[marked.index(True)] for marked in (comma, point))
        raise ArenaError(
            f"{path} has numbers with commas, in {a}, and with points, in {b}; "
            "write all decimals alike, and no mark for thousands"
        )
    numbers = {}
    for name, column in cells.items():
        values = np.empty(len(column))
        for at, cell in enumerate(column):
            try:
                values[at] = np.nan if cell.lower() in ABSENT else float(cell.replace(",", "."))
            except ValueError:
                raise ArenaError(
                    f"{path}: row {rows[at]} has {name} = {cell!r}; give a number, "
                    "or nothing where it is missing"
                ) from None
        numbers[name] = values
    return numbers


def _encoding(path: Path) -> str:
    with path.open("rb") as file:
        start = file.read(4096)
    for mark, encoding in MARKS.items():
        if start.startswith(mark):
            return encoding
    # Names and numbers are ASCII for the most part: every second byte of UTF-16 is zero then.
    if len(start) > 3 and 0 in start[:4]:
        return "utf-16-le" if start[1] == 0 else "utf-16-be"
    try:
        # The last character may be cut.
        start.decode("utf-8")
    except UnicodeDecodeError as error:
        return "utf-8" if error.start > len(start) - 4 and len(start) == 4096 else "cp1252"
    return "utf-8"


def _parsed(lines: list[str], delimiter: str) -> Iterator[list[str]]:
    """Part some first lines, the last of which may end inside quotes."""
    return csv.reader(lines, delimiter=delimiter)


def _delimiter(lines: list[str]) -> str:
    for delimiter in DELIMITERS:
        widths = [len(row) for row in _parsed(lines, delimiter) if row]
        if widths and widths[0] > 1 and sorted(widths)[len(widths) // 2] > 1:
            return delimiter
    return ","


def _names(table: list[list[str]]) -> tuple[int, tuple[str, ...]]:
    """Find how many lines of names there are, and what they make."""
    if not table:
        return 0, ()
    firsts = [row[0].strip() if row else "" for row in table[:4]]
    if firsts[0] == "scorer" and "coords" in firsts:
        heads = firsts.index("coords") + 1
        parts = zip(*(row[1:] for row in table[1:heads]), strict=True)
        return heads, ("frame", *(".".join(part.strip() for part in name) for name in parts))
    # numpy.savetxt comments its line of names out.
    names = [name.strip() for name in table[0]]
    return 1, tuple([names[0].removeprefix("#").lstrip(), *names[1:]] if names else names)
