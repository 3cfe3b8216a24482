"""Head-direction cells: units that compete for headings."""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.angles import wrap_angle
from neurons.layers.afferents import Afferents
from neurons.layers.place_cells import PEAK

CONCENTRATION = 5.0
"""κ of the von Mises tuning: a full width at half height of 61°."""
WINNERS = 3
"""Units that learn from one heading."""


class HeadDirectionCells(nn.Module):
    """Competitive learning on the circle, then afferents from sight.

    Units share out the headings as their preferred directions p_i; the tuning is

        r_i(θ) = 20 Hz · exp(κ (cos(θ − p_i) − 1)).

    Parameters
    ----------
    cells, charts
        Sizes.
    generator
        Draws the initial preferred directions.
    """

    preferred: Tensor
    responsibility: Tensor

    def __init__(self, cells: int, charts: int, *, generator: torch.Generator) -> None:
        super().__init__()
        self.register_buffer("preferred", 2 * torch.pi * torch.rand(cells, generator=generator) - torch.pi)
        self.register_buffer("responsibility", torch.zeros(cells))
        self.afferents = Afferents(charts, cells)

    def compete(self, headings: Float[Tensor, "views"], *, window: float) -> None:
        """Learn from a batch of headings (rad); `window` is in views."""
        apart = wrap_angle(headings[:, None] - self.preferred)
        unit = apart.abs().topk(min(WINNERS, len(self.preferred)), dim=1, largest=False).indices
        flat = unit.flatten()
        self.responsibility *= max(0.0, 1 - len(headings) / window)
        self.responsibility.index_add_(0, flat, torch.ones(len(flat)))
        pull = torch.zeros_like(self.responsibility).index_add_(0, flat, apart.gather(1, unit).flatten())
        self.preferred = wrap_angle(self.preferred + pull / self.responsibility.clamp(min=1e-6))

    def tuning(self, headings: Float[Tensor, "views"]) -> Float[Tensor, "views cells"]:
        """Rates in Hz that a heading demands."""
        return PEAK * torch.exp(CONCENTRATION * (torch.cos(headings[:, None] - self.preferred) - 1))
