"""Many rooms: the rooms of a house, and what one map that has learnt some of them makes of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.resources import as_file, files

import numpy as np
from jaxtyping import Bool, Float

from arena import Arena, Recording
from cogmap import cells
from cogmap.cells.measures.correlations import correlations
from cogmap.evaluation.populations import perceive, usual_charts
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.trial import Trial
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap

HOUSE = (
    "furnished",
    "kitchen",
    "workshop",
    "reading_room",
    "picture_gallery",
    "bath",
    "storeroom",
    "parlour",
    "cellar",
    "sun_room",
)
"""6×5 m each, with shared and unshared materials, some with the same sources of odour; the first is of the
gallery."""
APART = 100
"""Added to the seed from room to room: the same seed would walk the same way in rooms of one shape."""


def room_of_house(name: str) -> Arena:
    """Load a room of the house."""
    with as_file(files(__package__) / "house" / f"{name}.toml") as path:
        return Arena.load(path)


def house_of(conditions: Conditions) -> list[Trial]:
    """Walk twice in each room of the house, to learn from and afresh; the first is that of the conditions."""
    return trials_of(conditions, [conditions.room, *map(room_of_house, HOUSE[1:])])


def trials_of(conditions: Conditions, rooms: list[Arena]) -> list[Trial]:
    """Walk twice in each of some rooms, to learn from and afresh."""
    return [
        Trial.of(replace(conditions, room=room, seed=conditions.seed + APART * number))
        for number, room in enumerate(rooms)
    ]


def blank_map(conditions: Conditions) -> CognitiveMap:
    """Give a map that has learnt nothing, as `cogmap.evaluation.populations.grow_map` makes it."""
    usual = {"charts": usual_charts(conditions.views), "seed": conditions.seed}
    return CognitiveMap(**{**usual, **conditions.map})


@dataclass(frozen=True, eq=False)
class Visit:
    """What a map makes of a room: of the views that it learnt there, and of fresh ones."""

    trial: Trial
    train: Activity
    test: Activity
    walk: Recording
    """Whose views are fresh."""

    @classmethod
    def of(cls, cmap: CognitiveMap, trial: Trial, fresh: Recording | None = None) -> Visit:
        """Look at both."""
        walk = fresh or trial.fresh
        return cls(trial, perceive(cmap, trial.walk.views), perceive(cmap, walk.views), walk)

    @property
    def figures(self) -> dict[str, float]:
        """The score; without views that are taken for those of a room which knows no headings."""
        test, train = (
            (seen[_headed(seen)], walk.require("poses")[_headed(seen)])
            for seen, walk in ((self.test, self.walk), (self.train, self.trial.walk))
        )
        return score(*test, train=train)

    @property
    def maps(self) -> cells.RateMaps:
        """Rate maps of the place cells, on bins that rooms of one shape share."""
        x0, y0, x1, y1 = self.trial.conditions.room.walkable.bounds
        edges = cells.bin_edges(np.array([(x0, y0), (x1, y1)]))
        return cells.rate_maps(np.nan_to_num(self.test.place), self.walk.require("poses")[:, :2], edges=edges)

    def recognised(self, room: int) -> float:
        """Share of the fresh views that are said to be of this room."""
        return float(np.mean(self.test.room == room))


def _headed(seen: Activity) -> Bool[np.ndarray, "views"]:
    known = np.isfinite(seen.phase)
    return known if known.any() else np.ones(len(seen), bool)


def population_correlation(one: cells.RateMaps, other: cells.RateMaps) -> float:
    """Correlate the population vectors of two sets of rate maps place by place, and give the mean.

    A population vector is the rates of all cells in a bin. Bins that either lacks are left out, as are those
    where all cells fire alike.

    References
    ----------
    Leutgeb, Leutgeb, Barnes, Moser, McNaughton & Moser (2005), Independent codes for spatial and episodic
    memory in hippocampal neuronal ensembles. Science 309.
    """
    both = (one.visited & other.visited).ravel()
    vectors = (maps.rates.reshape(len(maps.rates), -1)[:, both].T for maps in (one, other))
    return float(np.nanmean(correlations(*vectors)))


def rate_change(one: cells.RateMaps, other: cells.RateMaps) -> float:
    """Tell by how much mean rates of cells differ, |a − b| / (a + b), the median over cells that fire."""
    rates: list[Float[np.ndarray, "cells"]] = [
        np.nanmean(maps.rates.reshape(len(maps.rates), -1), axis=1) for maps in (one, other)
    ]
    total = rates[0] + rates[1]
    fire = total > 0
    return float(np.median(np.abs(rates[0] - rates[1])[fire] / total[fire]))


def active(maps: cells.RateMaps, least: float = 1.0) -> Float[np.ndarray, "cells"]:
    """Tell which cells are active in a room: those whose map reaches so many Hz; 1 or 0."""
    return np.asarray(np.nan_to_num(maps.rates).max(axis=(1, 2)) >= least, float)
