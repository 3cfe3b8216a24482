"""Trial of a map: a walk to learn from, a fresh walk, what the map makes of both, and the truth about it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.figure import Figure

from arena import Brownian, Camera, Disc, Motion, Recording
from cogmap.evaluation.ground_truth import CellMetrics, GroundTruth, as_one_table
from cogmap.evaluation.populations import grow_map, perceive, reachable_places
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Conditions
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.plots import plot_cell_types, plot_examples


@dataclass(frozen=True, eq=False)
class Trial:
    """What is learnt from one walk and measured on another; each part is worked out when first asked for.

    `dataclasses.replace` changes one thing, another nose or other parameters of the map, and keeps the walks.
    """

    conditions: Conditions
    walk: Recording
    fresh: Recording
    reachable: Float[np.ndarray, "points 2"] | None = None
    """Places that count as within reach, m; those of the walk that is learnt from when None."""

    @classmethod
    def of(
        cls, conditions: Conditions, motion: Motion | None = None, *, camera: Camera | None = None
    ) -> Trial:
        """Walk twice, brownian and with a panoramic camera unless told; all of the room is within reach."""
        motion, camera = motion or Brownian(), camera or Camera.panoramic()
        return cls(
            conditions,
            conditions.explore(motion, camera),
            conditions.explore(motion, camera, fresh=True),
            reachable_places(conditions.room, conditions.body or Disc()),
        )

    @cached_property
    def truth(self) -> GroundTruth:
        """Where both walks really led."""
        train = self.walk.require("poses")
        reachable = train[:, :2] if self.reachable is None else self.reachable
        return GroundTruth(train, self.fresh.require("poses"), reachable)

    @cached_property
    def cmap(self) -> CognitiveMap:
        """The map that is learnt from the walk."""
        conditions = self.conditions
        return grow_map(self.walk, conditions.map, seed=conditions.seed, progress=conditions.progress)

    @cached_property
    def codes(self) -> tuple[Float[np.ndarray, "train components"], Float[np.ndarray, "views components"]]:
        """Sanger codes of the views of both walks."""
        return self.cmap.encode(self.walk.views), self.cmap.encode(self.fresh.views)

    @cached_property
    def smells(self) -> tuple[Float[np.ndarray, "train odorants"], Float[np.ndarray, "views odorants"]]:
        """Log odour that the nose has smelt on both walks."""
        return np.log(self.walk.require("odours")), np.log(self.fresh.require("odours"))

    @cached_property
    def train(self) -> Activity:
        """What the views that were learnt from evoke."""
        return perceive(self.cmap, self.walk.views)

    @cached_property
    def test(self) -> Activity:
        """What the fresh views evoke."""
        return perceive(self.cmap, self.fresh.views)

    @cached_property
    def place(self) -> CellMetrics:
        """The place cells, on the fresh views."""
        return self.truth.measure(self.test.place)

    @cached_property
    def heading(self) -> CellMetrics:
        """The head-direction cells, on the fresh views."""
        return self.truth.measure(self.test.heading)

    @cached_property
    def score(self) -> dict[str, float]:
        """Every figure of `cogmap.score`; without `reachable` all that was walked counts as within reach."""
        return score(
            self.test,
            self.truth.poses,
            train=(self.train, self.truth.train),
            reachable=self.reachable,
            cells=(self.place, self.heading),
        )

    @property
    def nose_figures(self) -> dict[str, float]:
        """Errors of the positions that the decoder of `score` reads from the raw nose."""
        return {f"nose_{key}": value for key, value in self.truth.position(*self.smells).items()}

    @property
    def figures(self) -> dict[str, float]:
        """What both populations are worth, and the score."""
        return {**self.place.place_figures, **self.heading.heading_figures, **self.score}


def show_cells(
    cells: dict[str, CellMetrics], *, silent: bool = True
) -> tuple[dict[str, pd.DataFrame], dict[str, Figure]]:
    """Give tables and figures of a result: every cell of these populations, and six of each.

    Unless told, a population that is `silent` has its place, an empty one, among the six.
    """
    table = as_one_table(cells)
    examples = {name: found.tuning for name, found in cells.items() if silent or found.rates.any()}
    return {"cells": table}, {"cells": plot_cell_types(table), "examples": plot_examples(examples)}
