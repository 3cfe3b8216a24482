"""Activity of a cognitive map: what it says of views."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Bool, Float, Int


@dataclass(frozen=True)
class Activity:
    """Activity of a map's neurons, one row per view, float32.

    Attributes
    ----------
    place, heading
        Rates of place cells and head-direction cells, Hz.
    phase
        Heading in the map's own frame, rad in (−π, π]: an unknown rotation, possibly a mirror, of the true
        one. NaN in the dark and without a compass.
    odour
        Log concentration of each odorant, recalled from sight.
    position
        In the map's own metric frame, a similarity (with a mirror where `phase` has one) away from metres.
        NaN when the walk has taught no metric map.
    plain
        The same as the charts alone tell it, where `CognitiveMap.refine` has made `phase` and `position`
        finer; else None.
    novelty
        There too, how far the views are from those that the map was refined by, over what is usual among
        these: about 1 where places are known, many in another room.
    room
        In which of the map's rooms the views are, by number in the order in which they were learnt, int64; −1
        where in none of them. What else is said is then what the most similar room says.
    room_confidence
        From 0 to 1: how much less every other room is like the views. 1 in a map of one.
    """

    place: Float[np.ndarray, "views place_cells"]
    heading: Float[np.ndarray, "views heading_cells"]
    phase: Float[np.ndarray, "views"]
    odour: Float[np.ndarray, "views odorants"]
    position: Float[np.ndarray, "views 2"]
    plain: Activity | None = None
    novelty: Float[np.ndarray, "views"] | None = None
    room: Int[np.ndarray, "views"] | None = None
    room_confidence: Float[np.ndarray, "views"] | None = None

    def __len__(self) -> int:
        return len(self.phase)

    def __getitem__(self, views: slice | Int[np.ndarray, "_"] | Bool[np.ndarray, "_"]) -> Activity:
        """Take some of the views."""
        parts = ((each.name, getattr(self, each.name)) for each in fields(self))
        return replace(self, **{name: part[views] for name, part in parts if part is not None})
