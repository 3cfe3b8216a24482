"""Disambiguation of a smell at two places: a place unit keeps to one, where its charts hang together."""

import numpy as np
import torch
from jaxtyping import Bool, Complex, Float, Int
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from torch import Tensor


def place_branches(
    rates: Float[Tensor, "charts cells"],
    phases: Float[Tensor, "charts"],
    edges: Int[Tensor, "edges 2"],
    *,
    active: float = 0.1,
    rival: float = 0.12,
) -> Bool[Tensor, "charts cells"]:
    """Say which charts a unit listens to: all, or those nearest to one place when its smell means several.

    The active charts of a unit fall into groups that hang together over the atlas. A group that does not go
    all around the compass is a part of a place, and joins the nearest group; one that then weighs little is
    none. With one place the unit is left alone. With several it keeps the one where the units before it fire
    least, unambiguous units being first, so that all places stay covered; every chart goes with the place it
    is fewest steps from.

    Parameters
    ----------
    rates
        Of each unit at the smell of each chart.
    phases
        Headings of the charts, rad; NaN without a compass, when every group that weighs enough is a place:
        as on a path where nobody turns, and the two directions are two places.
    edges
        Overlapping charts.
    active
        A chart where a unit fires at least at this part of its peak is one of its active charts.
    rival
        A group of active charts that evokes at least this part of what the strongest group does is a place.
    """
    # in double precision: sums over many charts are compared with each other and with shares
    evoked = rates.double().cpu().numpy()
    count, cells = evoked.shape
    k, j = edges.cpu().numpy().T
    graph = csr_array((np.ones(2 * len(k)), (np.r_[k, j], np.r_[j, k])), shape=(count, count))
    heading = np.exp(1j * phases.double().cpu().numpy())
    groups = [_places(rate, heading, graph, active, rival) for rate in evoked.T]
    kept = np.ones((count, cells), dtype=bool)
    covered = np.zeros(count)
    # unambiguous units first; the sort is stable, so that the rest are asked by number
    for cell in sorted(range(cells), key=lambda cell: len(groups[cell]) > 1):
        if len(groups[cell]) > 1:
            rate = evoked[:, cell]
            crowd = [float(rate[group] @ covered[group] / rate[group].sum()) for group in groups[cell]]
            steps = np.stack(
                [dijkstra(graph, unweighted=True, indices=group, min_only=True) for group in groups[cell]]
            )
            # of equals the first: a chart as far from two places goes to the one found first
            kept[:, cell] = steps.argmin(axis=0) == int(np.argmin(crowd))
        covered += evoked[:, cell] * kept[:, cell]
    return torch.from_numpy(kept).to(rates.device)


def _places(
    rate: Float[np.ndarray, "charts"],
    heading: Complex[np.ndarray, "charts"],
    graph: csr_array,
    active: float,
    rival: float,
) -> list[Int[np.ndarray, "_"]]:
    """Find the groups of active charts that hang together, parts of a place joined with the nearest group."""
    firing = np.flatnonzero((rate >= active * rate.max()) & (rate > 0))
    found, label = connected_components(graph[firing][:, firing], directed=False)
    weight = np.bincount(label, rate[firing], minlength=found)
    # a group of less than 3 % of the strongest is noise
    groups = [firing[label == group] for group in np.flatnonzero(weight >= 0.03 * weight.max(initial=0.0))]
    while len(groups) > 1:
        length = [abs(rate[group] @ heading[group]) / rate[group].sum() for group in groups]
        if np.isnan(length).any():  # without a compass nothing tells parts of a place
            break
        part = int(np.argmax(length))
        # around the compass headings cancel; an even half of it, a part of a place, has 2/π
        if length[part] < 0.5:
            break
        steps = dijkstra(graph, unweighted=True, indices=groups[part], min_only=True)
        lost = groups.pop(part)
        nearest = int(np.argmin([steps[group].min() for group in groups]))
        groups[nearest] = np.concatenate([groups[nearest], lost])
    heaviest = max((rate[group].sum() for group in groups), default=0.0)
    return [group for group in groups if rate[group].sum() >= rival * heaviest]
