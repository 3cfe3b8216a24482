"""What a source holds before it is brought to metres and samples: spike trains, or rates, and a track."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from cogmap.errors import CogmapError

ONE_POPULATION = "cells"
"""What all cells are called that nobody has sorted."""


class Series(NamedTuple):
    """Values over time, as some library keeps them."""

    times: Float[np.ndarray, "samples"]
    """s."""
    data: Float[np.ndarray, "samples *axes"]
    unit: str | None
    """As it is called there; None where it is not."""


@dataclass(frozen=True, eq=False)
class Track:
    """Where the animal was, NaN where the tracker lost it."""

    times: Float[np.ndarray, "samples"]
    """s, increasing."""
    positions: Float[np.ndarray, "samples 2"]
    headings: Float[np.ndarray, "samples"] | None = None
    unit: str | None = None
    """Of the positions, as the source calls it."""
    heading_unit: str | None = None
    notes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Recorded:
    """Cells with their spikes or rates, and the track beside them."""

    track: Track
    names: Sequence[str]
    populations: Sequence[str]
    trains: Sequence[Float[np.ndarray, "_"]] | None = None
    """s; None when only rates are known."""
    rates: Float[np.ndarray, "samples cells"] | None = None
    """Hz, at the samples of the track."""
    observed: Float[np.ndarray, "epochs 2"] | None = None
    """From when to when all cells were listened to, s; None for always."""
    notes: Mapping[str, Any] = field(default_factory=dict)


def track_of(
    times: ArrayLike,
    positions: ArrayLike,
    headings: ArrayLike | None = None,
    *,
    unit: str | None = None,
    heading_unit: str | None = None,
) -> Track:
    """Make a track of arrays, or say what is wrong with them.

    Raises
    ------
    CogmapError
        For shapes that do not fit each other, and times that do not increase.
    """
    when, places = np.asarray(times, dtype=float), np.asarray(positions, dtype=float)
    turns = None if headings is None else np.asarray(headings, dtype=float)
    if when.ndim != 1 or len(when) < 2:
        raise CogmapError(f"the times of the track have shape {when.shape}; give two samples or more")
    if places.shape != (len(when), 2):
        raise CogmapError(
            f"the positions of the track have shape {places.shape} for {len(when)} times; "
            "give x and y for each"
        )
    if turns is not None and turns.shape != when.shape:
        raise CogmapError(
            f"the headings of the track have shape {turns.shape} for {len(when)} times; give one for each"
        )
    late = np.flatnonzero(~(np.diff(when) > 0))
    if len(late):
        before, after = when[late[0] : late[0] + 2]
        raise CogmapError(
            f"the times of the track do not increase at sample {late[0] + 1}, where {after:g} s follows "
            f"{before:g} s; sort the samples and keep one a time"
        )
    return Track(when, places, turns, unit, heading_unit)
