"""The atlas: which charts overlap, how far apart they lie, and the displacement across each overlap."""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor


@dataclass(frozen=True)
class Atlas:
    """Neighbourhoods of frozen charts.

    Attributes
    ----------
    pool
        The nearest charts of each chart, itself first.
    edges
        Pairs (k, j), k < j, of overlapping charts, each once, in order.
    spacing
        Root-mean-square distance to the overlapping charts, in units of the code.
    """

    pool: Int[Tensor, "charts pool"]
    edges: Int[Tensor, "edges 2"]
    spacing: Float[Tensor, "charts"]

    @classmethod
    def of(cls, centres: Float[Tensor, "charts components"], *, overlaps: int = 8, pool: int = 12) -> "Atlas":
        """Find the neighbourhoods of chart centres.

        Parameters
        ----------
        centres
            C_k.
        overlaps
            Nearest charts that a chart overlaps: enough to hang together in three dimensions, and near enough
            for a straight step from centre to centre.
        pool
            Nearest charts, itself included, over which a chart pools what it knows of smell: a gradient of
            one chart leaves its null direction to the noise.
        """
        count = len(centres)
        wanted = min(max(pool, overlaps + 1), count)
        # one product ranks them; it loses the digits of neighbours far from the origin, so a few more are
        # taken, and measured exactly
        squared = torch.addmm(centres.square().sum(dim=1), centres, centres.T, alpha=-2.0)
        near = squared.topk(min(wanted + 8, count), dim=1, largest=False).indices
        distance, order = (centres[:, None] - centres[near]).norm(dim=2).sort(dim=1, stable=True)
        nearest = near.gather(1, order[:, :wanted])
        # exact distances put the chart itself first, at 0
        overlap = nearest[:, 1 : overlaps + 1]
        here = torch.arange(count, device=centres.device)[:, None].expand_as(overlap)
        # smaller index first: k → j and j → k become equal, and `unique` keeps one
        pairs = torch.stack([torch.minimum(here, overlap), torch.maximum(here, overlap)], dim=2)
        return cls(
            pool=nearest[:, :pool],
            edges=torch.unique(pairs.flatten(0, 1), dim=0),
            spacing=distance[:, 1 : overlaps + 1].square().mean(dim=1).sqrt(),
        )
