"""Ambiguity of an atlas: whether what is most alike to a sense is near over the atlas, or elsewhere."""

import numpy as np
import torch
from jaxtyping import Float, Int
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree
from torch import Tensor


def far_share(
    told: Float[Tensor, "charts features"],
    edges: Int[Tensor, "edges 2"],
    *,
    nearest: int = 3,
    far: int = 5,
    asked: int = 300,
) -> float:
    """Share of the charts most alike in what is told of them that are far from each other over the atlas.

    Parameters
    ----------
    told
        Of each chart, such that the distance is how much two differ.
    edges
        Overlapping charts.
    nearest
        Charts that are most like one.
    far
        Steps over overlaps beyond which they are not near.
    asked
        Charts to look at, evenly by number.

    Returns
    -------
    From 0 to 1; NaN where anything told is.
    """
    if told.isnan().any():
        return float("nan")
    points = told.double().cpu().numpy()
    k, j = edges.cpu().numpy().T
    looked = np.arange(0, len(points), max(1, len(points) // asked))
    alike = np.asarray(KDTree(points).query(points[looked], min(nearest + 1, len(points)))[1])
    graph = csr_array((np.ones(2 * len(k)), (np.r_[k, j], np.r_[j, k])), shape=(len(points),) * 2)
    steps = np.take_along_axis(dijkstra(graph, unweighted=True, indices=looked, limit=far), alike, axis=1)
    # a chart is no steps from itself, wherever it stands among its likes
    return float(np.isinf(steps).sum() / (len(looked) * nearest))


def poses_told(
    smells: Float[Tensor, "charts odorants"],
    headings: Float[Tensor, "charts"],
    edges: Int[Tensor, "edges 2"],
) -> Float[Tensor, "charts odorants_and_2"]:
    """Put log odours and headings (rad) of charts together, each in units of its median across overlaps.

    Position and heading are all that a pose is. So what smells alike and heads alike is one pose, near to
    itself over the atlas too, unless a smell means several places, or places that look alike have been taken
    for one, whose headings then are made up.
    """
    k, j = edges.T
    # tiny, so that smells that are all the same leave the headings to decide
    unit = (smells[k] - smells[j]).norm(dim=1).median().clamp(min=1e-12)
    turn = torch.sin((headings[k] - headings[j]) / 2).abs().median().mul(2).clamp(min=1e-12)
    return torch.cat([smells / unit, headings.cos()[:, None] / turn, headings.sin()[:, None] / turn], dim=1)
