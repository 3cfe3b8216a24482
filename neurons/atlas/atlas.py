"""The atlas: which charts overlap, how far apart they lie, and the displacement across each overlap."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor

OVERLAPS = 8
"""Nearest charts that a chart overlaps."""
POOL = 12
"""Nearest charts, itself included, over which a chart pools what it knows of smell."""


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
    def of(cls, centres: Float[Tensor, "charts components"]) -> Atlas:
        """Find the neighbourhoods of chart centres."""
        count = len(centres)
        distance = torch.cdist(centres, centres, compute_mode="donot_use_mm_for_euclid_dist")
        nearest = distance.topk(min(max(POOL, OVERLAPS + 1), count), dim=1, largest=False)
        overlap = nearest.indices[:, 1 : OVERLAPS + 1]
        here = torch.arange(count)[:, None].expand_as(overlap)
        pairs = torch.stack([torch.minimum(here, overlap), torch.maximum(here, overlap)], dim=2)
        return cls(
            pool=nearest.indices[:, :POOL],
            edges=torch.unique(pairs.flatten(0, 1), dim=0),
            spacing=nearest.values[:, 1 : OVERLAPS + 1].square().mean(dim=1).sqrt(),
        )
