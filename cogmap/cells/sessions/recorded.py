"""What a source holds before it is brought to metres and samples: spike trains, or rates, and a track."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from cogmap.errors import CogmapError

ONE_POPULATION = "cells"
"""What all cells are called that nobody has sorted."""


class Series(NamedTuple):
    """Values over time, as some library keeps them."""

    times: Float[np.ndarray, "samples"]
    """s."""
    values: Float[np.ndarray, "samples *axes"]
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

    def __post_init__(self) -> None:
        if self.times.ndim != 1 or len(self.times) < 2:
            raise CogmapError(
                f"the times of the track have shape {self.times.shape}; give two samples or more"
            )
        if self.positions.shape != (len(self.times), 2):
            raise CogmapError(
                f"the positions of the track have shape {self.positions.shape} for {len(self.times)} times; "
                "give x and y for each"
            )
        if self.headings is not None and self.headings.shape != self.times.shape:
            raise CogmapError(
                f"the headings of the track have shape {self.headings.shape} for {len(self.times)} times; "
                "give one for each"
            )
        late = np.flatnonzero(~(np.diff(self.times) > 0))
        if not np.isfinite(self.times).all() or len(late):
            at = late[0] if len(late) else 0
            raise CogmapError(
                f"the times of the track do not increase at sample {at + 1}, where {self.times[at + 1]:g} s "
                f"follows {self.times[at]:g} s; sort the samples and keep one a time"
            )


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
