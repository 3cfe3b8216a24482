"""The view manifold, the shape that images lie on: words, neighbour graph, coordinates, loop, holes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import scipy.sparse as sp
from jaxtyping import Float

from cogmap.cells import fit_heading_frame, heading_errors
from cogmap.experiments import Conditions, pose_columns
from cogmap.features import BagOfWords
from cogmap.graph.neighbour_graph import neighbourhood_means
from cogmap.shape import Betti, LandmarkIsomap, betti, circular_coordinate, intrinsic_dimension


class ViewManifold(NamedTuple):
    """What is known of a walk from its images alone."""

    words: sp.csr_array
    """Bags of words (views, words)."""
    graph: sp.csr_array
    """Their neighbour graph."""
    embedding: Float[np.ndarray, "views coordinates"]
    """Each view at the mean of its own and its neighbours' places."""
    phase: Float[np.ndarray, "views"]
    """Along the loop, rad; NaN outside the largest piece."""
    shape: Betti
    dimension: float
    """Of the embedding before the means, which flatten it."""

    def metrics(self, poses: Float[np.ndarray, "views 3"]) -> dict[str, Any]:
        """Degrees of freedom, Betti numbers and their margins, and how the loop agrees with the heading.

        `betti_margin` is π over its threshold of the weakest bar that counts, `betti_rejected` that of the
        strongest that does not.
        """
        accepted, rejected = zip(*self.shape.margins, strict=True)
        turn = self._turn(poses)
        return {
            "dimension": self.dimension,
            "betti": list(self.shape.numbers),
            "betti_votes": list(self.shape.votes),
            "betti_resolved": list(self.shape.resolved),
            "betti_margin": min((over for over in accepted if over is not None), default=None),
            "betti_rejected": max((over for over in rejected if over is not None), default=None),
            "heading_resultant": float(abs(np.nanmean(np.exp(1j * turn)))),
            "loop_error_median_deg": float(np.rad2deg(np.nanmedian(abs(turn)))),
        }

    def table(self, poses: Float[np.ndarray, "views 3"]) -> pd.DataFrame:
        """Pose, coordinates and phase, turned into the true frame, of every view."""
        coordinates = {f"coordinate_{index}": values for index, values in enumerate(self.embedding.T)}
        loop = poses[:, 2] + self._turn(poses)
        return pd.DataFrame({**pose_columns(poses), "loop_rad": loop, **coordinates})

    def _turn(self, poses: Float[np.ndarray, "views 3"]) -> Float[np.ndarray, "views"]:
        """Signed error in rad of the phase as a heading; NaN where there is no phase."""
        known = np.isfinite(self.phase)
        phase, headings = self.phase[known], poses[known, 2]
        turn = np.full(len(poses), np.nan)
        turn[known] = heading_errors(phase, headings, fit_heading_frame(phase, headings))
        return turn


def view_manifold(views: Any, conditions: Conditions, *, coordinates: int = 10) -> ViewManifold:
    """Find the shape of a set of images; no truth is needed and none is given.

    There are more `coordinates` than views have degrees of freedom, whatever these are.
    """
    words = BagOfWords(seed=conditions.seed, progress=conditions.progress).fit_transform(views)
    isomap = LandmarkIsomap(coordinates, metric="cosine", seed=conditions.seed).fit(words)
    return ViewManifold(
        words=words,
        graph=isomap.graph_,
        embedding=neighbourhood_means(isomap.graph_) @ isomap.embedding_,
        phase=circular_coordinate(isomap.graph_, seed=conditions.seed).phase,
        shape=betti(isomap.graph_, "precomputed", seed=conditions.seed),
        dimension=intrinsic_dimension(isomap.embedding_),
    )
