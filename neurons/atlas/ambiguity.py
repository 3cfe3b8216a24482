"""Ambiguity of an atlas: whether smell and heading tell its charts apart, or fit several places."""

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree
from torch import Tensor


def ambiguous_share(
    smells: Float[Tensor, "charts odorants"],
    headings: Float[Tensor, "charts"],
    edges: Int[Tensor, "edges 2"],
    *,
    nearest: int = 3,
    far: int = 5,
    asked: int = 300,
) -> float:
    """Share of the charts most alike in smell and heading that are far from each other over the atlas.

    Position and heading are all that a pose is. So what smells alike and heads alike is one pose, near to
    itself over overlapping charts too, unless a smell means several places, or places that look alike have
    been taken for one and its headings are made up. Differences of smell and of heading count in units of
    their medians across an overlap.

    Parameters
    ----------
    smells
        Log odours of the charts.
    headings
        In the map's own frame, rad; NaN without a compass.
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
    From 0 to 1; NaN without a compass.
    """
    if headings.isnan().any():
        return float("nan")
    odour, angle = smells.double().cpu().numpy(), headings.double().cpu().numpy()
    k, j = edges.cpu().numpy().T
    # tiny, so that smells that are all the same leave the headings to decide
    unit = max(float(np.median(np.linalg.norm(odour[k] - odour[j], axis=1))), 1e-12)
    turn = max(float(np.median(np.abs(np.angle(np.exp(1j * (angle[k] - angle[j])))))), 1e-12)
    told = np.column_stack([odour / unit, np.cos(angle) / turn, np.sin(angle) / turn])
    looked = np.arange(0, len(told), max(1, len(told) // asked))
    alike = np.asarray(KDTree(told).query(told[looked], nearest + 1)[1])
    graph = csr_array((np.ones(2 * len(k)), (np.r_[k, j], np.r_[j, k])), shape=(len(told),) * 2)
    steps = dijkstra(graph, unweighted=True, indices=looked, limit=far)
    # a chart is no steps from itself, wherever it stands among its likes
    return float(np.isinf(np.take_along_axis(steps, alike, axis=1)).sum() / (len(looked) * nearest))
