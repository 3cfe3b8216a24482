"""Pieces of an atlas: charts that hang together, as those of one room do, apart from those of another."""

import numpy as np
import torch
from jaxtyping import Int
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from torch import Tensor

from neurons.atlas.atlas import Atlas


def pieces(
    atlas: Atlas, points: Tensor, *, longest: float = 1.6, least: float = 0.05
) -> list[Int[Tensor, "charts"]]:
    """Find the pieces into which an atlas falls: the charts of each, ascending, the first chart's first.

    Parameters
    ----------
    atlas, points
        Overlaps of charts, and where the charts lie.
    longest
        Overlaps join pieces up to this many times the spacing of either chart. Some chart of every room has
        its nearest neighbours in another; within a room hardly any overlap is as long.
    least
        Share of the charts that a piece has at least. A few charts apart are no room: they stay with the
        piece that is nearest to them.
    """
    count = len(points)
    k, j = atlas.edges.T
    length = (points[k] - points[j]).norm(dim=1)
    near = (length < longest * torch.minimum(atlas.spacing[k], atlas.spacing[j])).cpu().numpy()
    k, j = (end.cpu().numpy()[near] for end in (k, j))
    graph = csr_array((np.ones(len(k)), (k, j)), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    sizes = np.bincount(label)
    large = np.flatnonzero(sizes >= least * count)
    if len(large) < 2:
        return [torch.arange(count, device=points.device)]
    home = np.isin(label, large)
    if not home.all():
        rooms = torch.from_numpy(np.flatnonzero(home)).to(points.device)
        lost = torch.from_numpy(np.flatnonzero(~home)).to(points.device)
        nearest = torch.cdist(points[lost], points[rooms]).argmin(dim=1)
        label[lost.cpu().numpy()] = label[rooms[nearest].cpu().numpy()]
    return [torch.from_numpy(np.flatnonzero(label == piece)).to(points.device) for piece in large]
