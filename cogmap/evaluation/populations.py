"""Populations of cells: a map grown from a walk, cells that compete for anything, and their measures."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import torch
from jaxtyping import Float

from arena import Arena, Disc, Recording
from cogmap.cells import (
    RateMaps,
    Tuning,
    bin_edges,
    heading_statistics,
    place_coverage,
    place_fields,
    place_statistics,
    position_errors,
    rate_maps,
    tuning_curves,
)
from cogmap.cells.measures.correlations import correlations
from cogmap.errors import UntrustedMapWarning
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import BATCH, CognitiveMap
from cogmap.threads import one_thread
from neurons.layers.place_cells import PlaceCells
from neurons.network import EPOCHS

MOST_CHARTS = 3000


def grow_map(walk: Recording, parameters: Mapping[str, Any], *, seed: int) -> CognitiveMap:
    """Learn a map with 3,000 charts, or a third as many as views when these are fewer than 9,000.

    Parameters of `CognitiveMap` that are given go before these.
    """
    usual = {"charts": min(MOST_CHARTS, len(walk) // 3), "seed": seed}
    return CognitiveMap(**{**usual, **parameters}).fit(walk.views, walk.odours)


def perceive(cmap: CognitiveMap, views: Any) -> Activity:
    """Let a map look; one that is not to be trusted says so in the metrics, not in a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UntrustedMapWarning)
        return cmap.perceive(views)


def trust_report(cmap: CognitiveMap) -> dict[str, Any]:
    """Whether a map is to be trusted, and why not."""
    return {"trusted": cmap.trusted_, "reason": cmap.reason_}


def competing_cells(
    train: Float[np.ndarray, "train inputs"],
    *test: Float[np.ndarray, "_ inputs"],
    seed: int,
    cells: int = 150,
) -> list[Float[np.ndarray, "_ cells"]]:
    """Let the place cells' layer compete for any inputs, as many and as long as in a map; rates in Hz."""
    inputs = torch.from_numpy(np.asarray(train, np.float32))
    order = np.random.default_rng(seed)
    layer = PlaceCells(cells, 1, inputs.shape[1])
    with one_thread():
        for _ in range(EPOCHS["cells"]):
            for rows in torch.from_numpy(order.permutation(len(inputs))).split(BATCH):
                layer.compete(inputs[rows], window=float(len(inputs)))
        return [layer.tuning(torch.from_numpy(np.asarray(batch, np.float32))).numpy() for batch in test]


class GroundTruth(NamedTuple):
    """The truth that cells are measured against."""

    train: Float[np.ndarray, "train 3"]
    """Poses of the views that were learnt from: m, m, rad."""
    poses: Float[np.ndarray, "views 3"]
    """Poses of fresh views, on which cells are measured."""
    reachable: Float[np.ndarray, "points 2"]
    """Places that the body can reach, m."""

    @classmethod
    def of(
        cls, room: Arena, train: Float[np.ndarray, "train 3"], poses: Float[np.ndarray, "views 3"]
    ) -> GroundTruth:
        """Take all of the room as within reach."""
        return cls(train, poses, room.sample_free(20_000, Disc().radius, np.random.default_rng(0)))

    def maps(self, rates: Float[np.ndarray, "views cells"]) -> RateMaps:
        """Rate maps on bins that all populations share; a cell without a compass, of rate NaN, is silent."""
        walked = np.concatenate([self.train[:, :2], self.poses[:, :2]])
        edges = bin_edges(np.concatenate([walked, self.reachable]))
        return rate_maps(np.nan_to_num(rates), self.poses[:, :2], edges=edges, visited=edges.visited(walked))

    def tuning(self, rates: Float[np.ndarray, "views cells"]) -> Tuning:
        """Rate maps and tuning curves, to be drawn."""
        return Tuning(self.maps(rates), tuning_curves(np.nan_to_num(rates), self.poses[:, 2]))

    def measure(self, rates: Float[np.ndarray, "views cells"]) -> CellMetrics:
        """Measure every cell both as a place cell and as a head-direction cell."""
        positions, headings = self.poses[:, :2], self.poses[:, 2]
        rates, maps = np.nan_to_num(rates), self.maps(rates)
        place = place_statistics(rates, positions, headings, maps=maps)
        heading = heading_statistics(rates, positions, headings, maps=maps)
        mine = heading[["preferred_direction_rad", "mean_vector_length", "drift_deg"]]
        table = place.drop(columns="passing").join(mine)
        table["place_passing"], table["heading_passing"] = place["passing"], heading["passing"]
        covered = place_coverage(
            place_fields(maps), place["passing"].to_numpy(), maps.edges.visited(self.reachable)
        )
        return CellMetrics(table, covered)

    def position(
        self, train: Float[np.ndarray, "train signals"], test: Float[np.ndarray, "views signals"]
    ) -> dict[str, float]:
        """Errors of the positions that 4-nearest-neighbour regression reads from signals."""
        away = position_errors(train, self.train[:, :2], test, self.poses[:, :2])
        return {
            "position_median_m": float(np.median(away)),
            "position_p95_m": float(np.percentile(away, 95)),
        }


class CellMetrics(NamedTuple):
    """A population, measured."""

    table: pd.DataFrame
    """Columns of `place_statistics` and `heading_statistics`, `place_passing` and `heading_passing`."""
    place_coverage: float
    """Reachable area inside some passing field."""

    @property
    def place_figures(self) -> dict[str, float]:
        """What it is worth as a population of place cells."""
        return {
            "place_cells_passing": float(self.table["place_passing"].mean()),
            "place_coverage": self.place_coverage,
            **_median(self.table, "in_field_direction_vector", "field_area_m2"),
        }

    @property
    def heading_figures(self) -> dict[str, float]:
        """What it is worth as a population of head-direction cells."""
        return {
            "heading_cells_passing": float(self.table["heading_passing"].mean()),
            **_median(self.table, "mean_vector_length", "drift_deg"),
        }


def map_correlations(first: RateMaps, second: RateMaps) -> Float[np.ndarray, "cells"]:
    """Correlate the maps of the same cells over the bins that both know; NaN where one is flat."""
    one, other = (maps.rates.reshape(len(maps.rates), -1) for maps in (first, second))
    return correlations(one, other)


def as_one_table(populations: dict[str, CellMetrics]) -> pd.DataFrame:
    """Join the tables of several populations, with their names in the column `population`."""
    parts = [found.table.reset_index().assign(population=name) for name, found in populations.items()]
    return pd.concat(parts, ignore_index=True)


def _median(table: pd.DataFrame, *columns: str) -> dict[str, float]:
    """Medians over the cells that have a value, left out where none has."""
    medians = table[list(columns)].median().dropna()
    return {str(name): float(value) for name, value in medians.items()}
