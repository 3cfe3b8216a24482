"""Moving least squares: how a map of places goes on between them, in smells, as their neighbours lie."""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.layers.place_cells import PlaceCells

FLATNESS = 0.1
"""Added to the covariance of a cell's neighbours, as a fraction of its mean: smells of a room are a surface,
and off it no neighbour tells how a map goes on."""


def near(place: PlaceCells) -> Float[Tensor, "cells cells"]:
    """How much of a cell's middle is shared out to another, in both directions; 0 to itself."""
    shared = place.share(place.centres).double()
    both = shared + shared.T
    return both - torch.diag(both.diagonal())


def ties(place: PlaceCells) -> Float[Tensor, "cells parts cells"]:
    """Give x_p and B_p = Σ_q K_pq x_q, the least squares at a cell on its neighbours, of positions x."""
    centres = place.centres.double()
    cells, odorants = centres.shape
    close = near(place)
    beside = centres - centres[:, None]
    weighed = (close / close.sum(dim=1, keepdim=True).clamp(min=1e-300))[:, :, None] * beside
    within = weighed.mT @ beside
    mean = within.diagonal(dim1=1, dim2=2).mean(dim=1).clamp(min=1e-12)
    within = within + FLATNESS * mean[:, None, None] * torch.eye(odorants).to(within)
    slopes = torch.linalg.solve(within, weighed.mT)
    own = torch.eye(cells).to(slopes)
    return torch.cat([own[:, None], slopes - slopes.sum(dim=2, keepdim=True) * own[:, None]], dim=1)


def apart(place: PlaceCells) -> Float[Tensor, "cells cells"]:
    """Give the form Σ_pq W_pq |x_p − x_q|² of how far neighbours lie apart, 1 for a cell on average."""
    close = near(place)
    form = torch.diag(close.sum(dim=1)) - close
    # where the whole lies means nothing; 0 is as good as any
    return form / form.diagonal().mean() + 1e-6 * torch.eye(len(form)).to(form)


def affine(place: PlaceCells) -> Float[Tensor, "cells cells"]:
    """Project on what is one affine map of the smells of all cells, x_p = x_0 + B c_p."""
    centres = nn.functional.pad(place.centres.double(), (1, 0), value=1.0)
    basis: Tensor = torch.linalg.qr(centres).Q
    return basis @ basis.T


def patches_of(
    place: PlaceCells, log_odours: Float[Tensor, "views odorants"]
) -> tuple[Float[Tensor, "views cells"], Float[Tensor, "views features"]]:
    """Give the share w_p of each place cell and w_p (1, o − c_p)."""
    share = place.share(log_odours)
    beside = nn.functional.pad(log_odours[:, None] - place.centres, (1, 0), value=1.0)
    return share, (share[:, :, None] * beside).flatten(1)
