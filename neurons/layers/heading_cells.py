"""Head-direction cells: units that compete for headings."""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.angles import wrap_angle
from neurons.layers.afferents import Afferents


class HeadDirectionCells(nn.Module):
    """Competitive learning on the circle, then afferents from sight.

    Units share out the headings as their preferred directions p_i; the tuning is

        r_i(θ) = peak · exp(κ (cos(θ − p_i) − 1)).

    Parameters
    ----------
    cells, charts
        Sizes.
    generator
        Draws the initial preferred directions.
    concentration
        κ of the von Mises tuning; 5 has a full width at half height of 61°.
    peak
        Rate at the preferred direction, Hz.
    """

    def __init__(
        self,
        cells: int,
        charts: int,
        *,
        generator: torch.Generator,
        concentration: float = 5.0,
        peak: float = 20.0,
    ) -> None:
        super().__init__()
        self.concentration, self.peak = concentration, peak
        self.preferred: Tensor = nn.Buffer(2 * torch.pi * torch.rand(cells, generator=generator) - torch.pi)
        self.responsibility: Tensor = nn.Buffer(torch.zeros(cells))
        self.afferents = Afferents(charts, cells)

    def compete(self, headings: Float[Tensor, "views"], *, window: float, winners: int = 3) -> None:
        """Learn from a batch of headings (rad).

        The nearest `winners` units learn from each: with the neighbours on both sides none is left behind.
        `window` is how many views a unit remembers when it averages.
        """
        # wrapped before they are ranked: −179° and 179° are neighbours
        apart = wrap_angle(headings[:, None] - self.preferred)
        unit = apart.abs().topk(min(winners, len(self.preferred)), dim=1, largest=False).indices
        flat = unit.flatten()
        # a batch longer than the window forgets everything, and not more than that
        self.responsibility *= max(0.0, 1 - len(headings) / window)
        self.responsibility.index_add_(0, flat, apart.new_ones(len(flat)))
        # deviations are averaged, not angles: those would tear at ±π
        pull = torch.zeros_like(self.responsibility).index_add_(0, flat, apart.gather(1, unit).flatten())
        self.preferred = wrap_angle(self.preferred + pull / self.responsibility.clamp(min=1e-6))

    def tuning(self, headings: Float[Tensor, "views"]) -> Float[Tensor, "views cells"]:
        """Rates in Hz that a heading demands."""
        # cos − 1 is never above 0: the peak is reached exactly, and nothing overflows whatever κ is
        return self.peak * torch.exp(self.concentration * (torch.cos(headings[:, None] - self.preferred) - 1))

    def share(self, headings: Float[Tensor, "views"]) -> Float[Tensor, "views cells"]:
        """Give each cell's part of the rate of all, r_i / Σ r."""
        return torch.softmax(self.concentration * torch.cos(headings[:, None] - self.preferred), dim=1)
