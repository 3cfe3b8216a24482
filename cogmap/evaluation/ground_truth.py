"""Ground truth, and populations of cells measured against it: rate maps, fields, statistics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float

from cogmap import cells
from cogmap.cells.measures.both import join_statistics
from cogmap.cells.measures.correlations import correlations


class GroundTruth(NamedTuple):
    """The truth that cells are measured against."""

    train: Float[np.ndarray, "train 3"]
    """Poses of the views that were learnt from: m, m, rad."""
    poses: Float[np.ndarray, "views 3"]
    """Poses of fresh views, on which cells are measured."""
    reachable: Float[np.ndarray, "points 2"]
    """Places that the body can reach, m."""

    @property
    def walked(self) -> Float[np.ndarray, "places 2"]:
        """Where the body has been on both walks, m."""
        return np.concatenate([self.train[:, :2], self.poses[:, :2]])

    @property
    def edges(self) -> cells.BinEdges:
        """Bins that all populations share."""
        return cells.bin_edges(np.concatenate([self.walked, self.reachable]))

    def measure(self, rates: Float[np.ndarray, "views cells"]) -> CellMetrics:
        """Measure cells on the fresh views; one without a compass, of rate NaN, is silent."""
        return CellMetrics(np.nan_to_num(rates), self)

    def position(
        self, train: Float[np.ndarray, "train signals"], test: Float[np.ndarray, "views signals"]
    ) -> dict[str, float]:
        """Errors of the positions that 4-nearest-neighbour regression reads from signals."""
        away = cells.position_errors(train, self.train[:, :2], test, self.poses[:, :2])
        return {
            "position_median_m": float(np.median(away)),
            "position_p95_m": float(np.percentile(away, 95)),
        }


@dataclass(frozen=True, eq=False)
class CellMetrics:
    """A population, measured: what is asked for is worked out then, and once."""

    rates: Float[np.ndarray, "views cells"]
    """In Hz, on the fresh views."""
    truth: GroundTruth

    @cached_property
    def maps(self) -> cells.RateMaps:
        """Rate maps."""
        edges = self.truth.edges
        visited = edges.visited(self.truth.walked)
        return cells.rate_maps(self.rates, self.truth.poses[:, :2], edges=edges, visited=visited)

    @cached_property
    def fields(self) -> cells.PlaceFields:
        """Place fields."""
        return cells.place_fields(self.maps)

    @cached_property
    def tuning(self) -> cells.Tuning:
        """Rate maps and tuning curves, to be drawn."""
        return cells.Tuning(self.maps, cells.tuning_curves(self.rates, self.truth.poses[:, 2]))

    @cached_property
    def place(self) -> pd.DataFrame:
        """`place_statistics` of every cell."""
        positions, headings = self.truth.poses[:, :2], self.truth.poses[:, 2]
        return cells.place_statistics(self.rates, positions, headings, maps=self.maps, fields=self.fields)

    @cached_property
    def heading(self) -> pd.DataFrame:
        """`heading_statistics` of every cell."""
        poses = self.truth.poses
        return cells.heading_statistics(self.rates, poses[:, :2], poses[:, 2], maps=self.maps)

    @property
    def table(self) -> pd.DataFrame:
        """`join_statistics` of both."""
        return join_statistics(self.place, self.heading)

    def coverage(self, places: Float[np.ndarray, "points 2"]) -> float:
        """Part of the area of these places (m) that is inside some passing field."""
        passing = self.place["passing"].to_numpy()
        return cells.place_coverage(self.fields, passing, self.maps.edges.visited(places))

    @property
    def place_figures(self) -> dict[str, float]:
        """What it is worth as a population of place cells."""
        return {
            "place_cells_passing": float(self.place["passing"].mean()),
            "place_coverage": self.coverage(self.truth.reachable),
            **_median(self.place, "in_field_direction_vector", "field_area_m2"),
        }

    @property
    def heading_figures(self) -> dict[str, float]:
        """What it is worth as a population of head-direction cells."""
        return {
            "heading_cells_passing": float(self.heading["passing"].mean()),
            **_median(self.heading, "mean_vector_length", "drift_deg"),
        }


def map_correlations(first: cells.RateMaps, second: cells.RateMaps) -> Float[np.ndarray, "cells"]:
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
