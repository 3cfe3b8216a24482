"""The quasi-metric of views: how distances along their manifold relate to how far the body moved."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import scipy.sparse as sp
from jaxtyping import Float
from scipy.stats import spearmanr

from cogmap.evaluation.pose_agreement import motion_distances
from cogmap.graph.shortest_paths import Paths


class QuasiMetric(NamedTuple):
    """Distances between pairs of views, and what they say by place."""

    pairs: pd.DataFrame
    """`source`, `target`, `motion_m` and `geodesic`, a row a pair."""
    places: pd.DataFrame
    """`x_m`, `y_m`, `heading_rad` and `distortion` of each source."""
    metrics: dict[str, Any]


def quasi_metric(
    graph: sp.csr_array,
    poses: Float[np.ndarray, "views 3"],
    seed: int = 0,
    *,
    sources: int = 300,
    targets: int = 300,
) -> QuasiMetric:
    """Compare shortest paths in a neighbour graph with how far apart the poses are.

    A body is as far from another pose as √(Δx² + Δy² + (0.5 m/rad · Δθ)²), obstacles aside. The distortion at
    a view is the median over its partners of geodesic over motion distance, over the same of all pairs: 2
    where moving changes the view twice as much as it does elsewhere.

    Parameters
    ----------
    graph
        Symmetric lengths, as from `neighbour_graph`.
    poses
        Where the views were taken: m, m, rad.
    seed
        Draws the pairs.
    sources, targets
        Views from which, and to which, distances are measured; their product is the number of pairs.
    """
    rng = np.random.default_rng(seed)
    views = len(poses)
    starts = rng.choice(views, min(sources, views), replace=False)
    ends = rng.choice(views, min(targets, views), replace=False)
    geodesic = Paths(graph).lengths(starts, ends)
    motion = motion_distances(poses[starts], poses[ends])
    joined = np.isfinite(geodesic) & (motion > 0)
    ratio = np.where(joined, geodesic / np.where(motion > 0, motion, 1), np.nan)
    distortion = np.nanmedian(ratio, axis=1) / np.nanmedian(ratio)
    rows, columns = np.nonzero(joined)
    pairs = {
        "source": starts[rows],
        "target": ends[columns],
        "motion_m": motion[joined],
        "geodesic": geodesic[joined],
    }
    places = pd.DataFrame(poses[starts], columns=["x_m", "y_m", "heading_rad"]).assign(distortion=distortion)
    low, high = np.percentile(distortion, [5, 95])
    metrics = {
        "geodesic_rank_correlation": float(spearmanr(motion[joined], geodesic[joined]).statistic),
        "distortion_p5": float(low),
        "distortion_p95": float(high),
        "joined_pairs": float(joined.mean()),
    }
    return QuasiMetric(pd.DataFrame(pairs), places, metrics)
