"""Recorded paths of joints: columns by the names of a body's axes, and no sample missing."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from arena.errors import ArenaError
from arena.recordings.columns import names_of, read_columns
from arena.recordings.tracks import Times, check_finite, check_increasing


def read_joints(path: Path, names: Sequence[str]) -> tuple[Times, Float[np.ndarray, "samples axes"]]:
    """Read a recorded path of joints: `t` (s), and a column for each axis by its name, none of it missing.

    The files are those of `arena.read_track`.

    Raises
    ------
    ArenaError
        When the file cannot be read, lacks a column, where a sample has no number, and for times that do not
        increase.
    """
    found = names_of(path)
    missing = [name for name in ("t", *names) if name not in found]
    if missing:
        raise ArenaError(
            f"{path} has no column {' and no '.join(missing)}; it must have t, {', '.join(names)}"
        )
    columns, rows = read_columns(path, ("t", *names))
    for name, values in columns.items():
        check_finite(path, name, values, rows, whole=True)
    check_increasing(path, "t", columns["t"], rows)
    return columns["t"], np.stack([columns[name] for name in names], axis=1)
