"""Angles of tensors in radians: wrapped to (−π, π], and their circular mean."""

import torch
from jaxtyping import Float
from torch import Tensor


def wrap_angle(angle: Float[Tensor, "*shape"]) -> Float[Tensor, "*shape"]:
    """Wrap angles (rad) to (−π, π], (θ + π) mod 2π − π."""
    turn = torch.remainder(angle + torch.pi, 2 * torch.pi)
    # The remainder begins at 0, which is −π, and ends before 2π, which is π.
    return torch.where(turn == 0, 2 * torch.pi, turn) - torch.pi


def mean_angle(
    angle: Float[Tensor, "views angles"], weight: Float[Tensor, "views angles"]
) -> Float[Tensor, "views"]:
    """Circular mean arg Σ w exp iθ of the angles (rad) in each row."""
    return torch.atan2((weight * angle.sin()).sum(dim=1), (weight * angle.cos()).sum(dim=1))
