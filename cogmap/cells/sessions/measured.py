"""Cells of a session, measured: rate maps, tuning curves, statistics, and what chance would make of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from jaxtyping import Float, Real

from cogmap.cells.measures.both import join_statistics
from cogmap.cells.measures.fields import PlaceFields, place_fields
from cogmap.cells.measures.heading import heading_statistics
from cogmap.cells.measures.information import spatial_information
from cogmap.cells.measures.place import place_statistics
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.rates.shuffling import shuffle_test
from cogmap.cells.rates.tuning import mean_vectors, tuning_curves
from cogmap.cells.sessions.session import Session

SHIFT = 30.0
"""s by which a shuffle shifts at least: by then the animal is elsewhere."""
LEAST_BINS = 5
"""That make a place field."""


@dataclass(frozen=True, eq=False)
class MeasuredSession:
    """What the cells of a session tell of place and heading: each part is worked out when first asked for."""

    session: Session
    bin: float = 0.1
    """Side of a bin of the rate maps, m."""
    smoothing: float = 0.15
    """Of the rate maps, m."""
    shuffles: int = 200
    seed: int = 0
    """Of the shuffles."""

    @cached_property
    def maps(self) -> RateMaps:
        """Rate maps."""
        return rate_maps(self.session.rates, self.session.positions, self.bin, self.smoothing)

    @cached_property
    def fields(self) -> PlaceFields:
        """Place fields, of five bins at least."""
        return place_fields(self.maps, least_area=LEAST_BINS * self.bin**2)

    @cached_property
    def curves(self) -> Float[np.ndarray, "cells bins"] | None:
        """Tuning curves; None where nobody knows the headings."""
        headings = self.session.headings
        return None if headings is None else tuning_curves(self.session.rates, headings)

    @cached_property
    def place(self) -> pd.DataFrame:
        """`place_statistics` of every cell."""
        return place_statistics(
            self.session.rates,
            self.session.positions,
            self.session.headings,
            maps=self.maps,
            fields=self.fields,
            smoothing=self.smoothing,
        )

    @cached_property
    def heading(self) -> pd.DataFrame | None:
        """`heading_statistics` of every cell; None where nobody knows the headings."""
        if self.session.headings is None:
            return None
        return heading_statistics(
            self.session.rates,
            self.session.positions,
            self.session.headings,
            maps=self.maps,
            smoothing=self.smoothing,
            seconds=self.session.seconds,
        )

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a cell: `population`, `cell`, `join_statistics`, and chances of so much.

        Those are `spatial_information_p`, `mean_vector_length_p`, from rates shifted in time by 30 s or more
        (by a quarter of the session where it is short), and `rayleigh_p`.
        """
        of_heading = pd.Series(np.nan, index=self.place.index)
        table = join_statistics(self.place, self.heading).assign(
            spatial_information_p=self._chance(self._information),
            mean_vector_length_p=of_heading if self.heading is None else self._chance(self._vectors),
            rayleigh_p=of_heading if self.heading is None else self.heading["rayleigh_p"],
        )
        table.insert(0, "cell", list(self.session.names))
        table.insert(0, "population", list(self.session.populations))
        return table.reset_index(drop=True)

    def _chance(self, statistic: Callable[[np.ndarray], np.ndarray]) -> Float[np.ndarray, "cells"]:
        least = max(1, min(round(SHIFT / self.session.seconds), len(self.session) // 4))
        rng = np.random.default_rng(self.seed)
        return shuffle_test(
            statistic, self.session.rates, rng, shuffles=self.shuffles, least_shift=least
        ).p_value

    def _information(self, rates: Real[np.ndarray, "views cells"]) -> Float[np.ndarray, "cells"]:
        edges, visited = self.maps.edges, self.maps.visited
        return spatial_information(
            rate_maps(rates, self.session.positions, self.bin, self.smoothing, edges=edges, visited=visited)
        )

    def _vectors(self, rates: Real[np.ndarray, "views cells"]) -> Float[np.ndarray, "cells"]:
        headings = self.session.headings
        if headings is None:
            return np.full(rates.shape[1], np.nan)
        return np.asarray(np.abs(mean_vectors(tuning_curves(rates, headings))))
