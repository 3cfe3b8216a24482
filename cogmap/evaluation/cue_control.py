"""Cue control: what cells follow when all that is seen turns by a quarter and all that is smelt stays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import Recording
from cogmap.cells import RateMaps, Tuning, bin_edges, mean_vectors, rate_maps, tuning_curves
from cogmap.evaluation.ground_truth import map_correlations


class CueControl(NamedTuple):
    """The same cells before and after what is seen has turned by 90° counter-clockwise about the origin."""

    before: Tuning
    after: Tuning

    @classmethod
    def of(
        cls,
        rates: tuple[Float[np.ndarray, "_ cells"], Float[np.ndarray, "_ cells"]],
        walks: tuple[Recording, Recording],
        reach: float,
    ) -> CueControl:
        """Tune rates (Hz) of two walks, on a square of bins as far from the origin as `reach` (m).

        A cell without a compass, of rate NaN, is silent.
        """
        edges = bin_edges(np.array([(-reach, -reach), (reach, reach)]))
        return cls(
            *(
                Tuning(
                    rate_maps(np.nan_to_num(fired), poses[:, :2], edges=edges),
                    tuning_curves(np.nan_to_num(fired), poses[:, 2]),
                )
                for fired, poses in zip(rates, (walk.require("poses") for walk in walks), strict=True)
            )
        )

    @property
    def correlations(self) -> pd.DataFrame:
        """How each cell's map correlates with the first one turned (`sight`), and as it was (`smells`)."""
        return pd.DataFrame(
            {
                "sight": map_correlations(turned(self.before.maps, 1), self.after.maps),
                "smells": map_correlations(self.before.maps, self.after.maps),
            }
        )

    @property
    def median_correlations(self) -> tuple[float, float]:
        """Medians over cells of `correlations`, of sight and of smells."""
        sight, smells = self.correlations.median().to_numpy(dtype=float)
        return float(sight), float(smells)

    @property
    def shift_deg(self) -> Float[np.ndarray, "cells"]:
        """How far each preferred direction has turned, counter-clockwise; NaN for a cell that is silent."""
        before, after = (mean_vectors(tuning.curves) for tuning in self)
        return np.asarray(np.rad2deg(np.angle(after * before.conj())))

    @property
    def maps_follow_sight(self) -> float:
        """Share of the cells whose map follows what is seen rather than what is smelt; silent ones do not."""
        found = self.correlations
        return float((found["sight"] > found["smells"]).mean())

    @property
    def directions_follow_sight(self) -> float:
        """Share of the cells whose preferred direction has turned by 90°, give or take 45°."""
        return float((abs(self.shift_deg - 90) < 45).mean())


def turned(maps: RateMaps, turns: int) -> RateMaps:
    """Turn square maps by so many quarters counter-clockwise."""
    # Row 0 is the lowest y, so that numpy's quarter turns go the other way.
    return RateMaps(np.rot90(maps.rates, -turns, axes=(1, 2)), np.rot90(maps.occupancy, -turns), maps.edges)
