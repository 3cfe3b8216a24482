"""The heading axis of each chart: the direction along which smell does not change, turning on the spot."""

from typing import NamedTuple

import torch
from jaxtyping import Float
from torch import Tensor

from neurons.atlas.atlas import Atlas


class HeadingAxes(NamedTuple):
    """Directions in which charts smell no change, one each."""

    axes: Float[Tensor, "charts components"]
    """Unit vectors n_k, up to sign."""
    felt: float
    """How much of the change of smell along them is the same in neighbouring charts, median share: what is
    left of noise where turning is not smelt, near 1 where it is."""


def heading_axes(
    tangents: Float[Tensor, "charts d components"],
    jacobians: Float[Tensor, "charts d odorants"],
    atlas: Atlas,
) -> HeadingAxes:
    """Find the unit vectors n_k, up to sign, along which the pooled odour gradients vanish.

    Walking changes the smell and turning does not, so the heading axis is the null direction of the odour
    Jacobian: with G_j = U_jᵀ J_j pooled over neighbours j of k, M_k = Σ (U_k G_j)(U_k G_j)ᵀ, the axis is the
    eigenvector of the smallest eigenvalue; lines n nᵀ are then averaged over the neighbours.
    """
    gradients = tangents.mT @ jacobians
    # unit length, so that charts where smell is steep do not outvote the others
    gradients = gradients / gradients.square().sum(dim=(1, 2), keepdim=True).sqrt().clamp(min=1e-12)
    pooled = torch.einsum("kdc,kpco->kpdo", tangents, gradients[atlas.pool])
    change = torch.einsum("kpdo,kpeo->kde", pooled, pooled)
    axes = torch.einsum("kd,kdc->kc", _eigenvectors(change)[:, :, 0], tangents)
    # n nᵀ and not n, as the sign of an eigenvector is arbitrary
    lines = torch.einsum("kdc,kpc->kpd", tangents, axes[atlas.pool])
    mean_line = torch.einsum("kpd,kpe->kde", lines, lines)
    # the line that all agree on has the largest eigenvalue, and noise is spread over the others
    axes = torch.einsum("kd,kdc->kc", _eigenvectors(mean_line)[:, :, -1], tangents)
    along = torch.einsum("kc,kpco->kpo", axes, gradients[atlas.pool])
    power = along.square().sum(dim=2).mean(dim=1).clamp(min=1e-12)
    felt = along.mean(dim=1).square().sum(dim=1) / power
    return HeadingAxes(axes, float(felt.median()))


def _eigenvectors(matrices: Float[Tensor, "charts d d"]) -> Float[Tensor, "charts d d"]:
    """Give the eigenvectors of symmetric matrices in the order of their eigenvalues, on any device."""
    # in double precision, as the smallest eigenvalue may be the square of what is small already
    found: Tensor = torch.linalg.eigh(matrices.double().cpu()).eigenvectors
    return found.to(matrices)
