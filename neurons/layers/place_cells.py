"""Place cells: units that compete for recalled smells."""

from collections.abc import Iterator

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from neurons.atlas.disambiguation import place_branches
from neurons.layers.afferents import Afferents
from neurons.layers.charts import rows_of
from neurons.layers.readout import ChartActivity

BLOCK = 256
"""Smells evaluated together: what a core's cache holds for a thousand cells."""


class PlaceCells(nn.Module):
    """Competitive learning on log odour, then afferents from sight.

    Each smell o moves the nearest unit alone, so that units spread as evenly as they can, and is learnt by a
    few more, so that fields overlap: c_i is the running mean of what unit i was nearest to, and Σ_i the
    running covariance about it of what it was among the nearest to. Fields follow the geometry of the smells:

        r_i(o) = peak · exp(−½ (o − c_i)ᵀ Σ_i⁻¹ (o − c_i)).

    With few odours a smell can mean several places. `disambiguate` makes a unit keep to one of them in
    sight, by the charts that it listens to; in the dark it remains ambiguous.

    Parameters
    ----------
    cells, charts, odorants
        Sizes.
    peak
        Rate of a cell at the middle of its field, Hz.
    flatness
        Smallest variance of a tuning in any direction, as a fraction of its mean variance: along
        a direction in which its smells hardly vary a unit would else fire in a sheet without width.
    """

    def __init__(
        self, cells: int, charts: int, odorants: int, *, peak: float = 20.0, flatness: float = 0.05
    ) -> None:
        super().__init__()
        self.peak, self.flatness = peak, flatness
        self.centres: Tensor = nn.Buffer(torch.zeros(cells, odorants))
        # not 0: a unit that never won would have a field without width
        self.covariances: Tensor = nn.Buffer(torch.eye(odorants).repeat(cells, 1, 1))
        self.wins: Tensor = nn.Buffer(torch.zeros(cells))
        self.responsibility: Tensor = nn.Buffer(torch.zeros(cells))
        self.initialised: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.branches: Tensor = nn.Buffer(torch.ones(charts, cells, dtype=torch.bool))
        self.afferents = Afferents(charts, cells)

    def compete(
        self, log_odours: Float[Tensor, "views odorants"], *, window: float, winners: int = 6
    ) -> None:
        """Learn from a batch of smells; the first smells become the centres.

        The nearest unit moves; the nearest `winners` learn how wide they are, which sets how much fields
        overlap. `window` is how many views a unit remembers when it averages.
        """
        cells = len(self.centres)
        initialised = int(self.initialised)
        if initialised < cells:
            fresh = log_odours[: cells - initialised]
            self.centres[initialised : initialised + len(fresh)] = fresh
            self.initialised += len(fresh)
            log_odours = log_odours[len(fresh) :]
        if not len(log_odours):
            return
        # `cdist` would take ten times as long for so few odorants
        distance = (log_odours[:, None] - self.centres).square().sum(dim=2)
        unit = distance.topk(min(winners, cells), dim=1, largest=False).indices
        deviation = log_odours[:, None] - self.centres[unit]
        flat = unit.flatten()
        # a batch longer than the window forgets everything, and not more than that
        self.responsibility *= max(0.0, 1 - len(log_odours) / window)
        self.responsibility.index_add_(0, flat, distance.new_ones(len(flat)))
        # a unit that has not won yet has no weight to divide by, and its numerators are zero
        rate = 1 / self.responsibility.clamp(min=1e-6)
        # about centres that have not moved yet: around the new ones first wins would have no spread at all
        spread = (deviation[..., None] * deviation[:, :, None]).flatten(0, 1)
        fed = torch.zeros_like(self.responsibility).index_add_(0, flat, distance.new_ones(len(flat)))
        drawn = torch.zeros_like(self.covariances).index_add_(0, flat, spread)
        self.covariances += rate[:, None, None] * (drawn - fed[:, None, None] * self.covariances)
        # the nearest alone: units that learn alike are drawn to one spot, and leave holes beside it
        nearest = unit[:, 0]
        self.wins *= max(0.0, 1 - len(log_odours) / window)
        self.wins.index_add_(0, nearest, distance.new_ones(len(nearest)))
        shift = torch.zeros_like(self.centres).index_add_(0, nearest, deviation[:, 0])
        self.centres += (1 / self.wins.clamp(min=1e-6))[:, None] * shift

    def disambiguate(
        self,
        smells: Float[Tensor, "charts odorants"],
        phases: Float[Tensor, "charts"],
        edges: Int[Tensor, "edges 2"],
    ) -> None:
        """Let each unit keep to one place, given the charts' log odours, headings (rad) and overlaps."""
        self.branches = place_branches(self.tuning(smells), phases, edges)

    def instruct(
        self, excited: ChartActivity, log_odours: Float[Tensor, "views odorants"]
    ) -> Float[Tensor, "views cells"]:
        """Rates in Hz that a smell demands as far as the excited charts are those of the unit's place."""
        here = torch.einsum("nw,nwc->nc", excited.weight, rows_of(self.branches, excited.chart).float())
        return here * self.tuning(log_odours)

    def tuning(self, log_odours: Float[Tensor, "views odorants"]) -> Float[Tensor, "views cells"]:
        """Rates in Hz that smell alone demands."""
        rates = log_odours.new_empty(len(log_odours), len(self.centres))
        demanded = self._exponents(log_odours)
        # at least 2e-22 of the peak: exp is twenty times slower where floats become subnormal
        for exponent, evoked in zip(demanded, rates.split(BLOCK), strict=True):
            torch.exp(exponent.to(rates.dtype).clamp_(-50.0, 0), out=evoked).mul_(self.peak)
        return rates

    def share(self, log_odours: Float[Tensor, "views odorants"]) -> Float[Tensor, "views cells"]:
        """Give each cell's part of the rate of all, r_i / Σ r, also where every rate is next to nothing."""
        # softmax takes the largest exponent away: far from all centres rates are 0, and their shares 0 / 0
        shares = [torch.softmax(exponent, dim=1) for exponent in self._exponents(log_odours)]
        return torch.cat(shares).to(log_odours.dtype)

    def _exponents(self, log_odours: Float[Tensor, "views odorants"]) -> Iterator[Float[Tensor, "_ cells"]]:
        """Give −½ (o − c)ᵀ P (o − c), P = Σ⁻¹, block by block.

        It is −½ P · (o oᵀ) + (P c) · o − ½ cᵀ P c, one matrix product on (o oᵀ, o).
        """
        odorants = self.centres.shape[1]
        # a unit that has learnt a single smell has no variance of its own
        mean = torch.diagonal(self.covariances, dim1=1, dim2=2).mean(dim=1).clamp(min=1e-9)
        # eigenvalues are then within `flatness` and odorants × mean: safe to invert
        floor = self.flatness * mean[:, None, None] * torch.eye(odorants, device=mean.device)
        # In double precision, as the three terms are large and cancel.
        precision = torch.linalg.inv((self.covariances + floor).double())
        centres = self.centres.double()
        pull = torch.einsum("cop,cp->co", precision, centres)
        # P is symmetric: its entries and those of o oᵀ pair up in either order
        weights = torch.cat([-0.5 * precision.flatten(1), pull], dim=1).T
        height = -0.5 * (pull * centres).sum(dim=1)
        for smells in log_odours.double().split(BLOCK):
            pairs = (smells[:, :, None] * smells[:, None]).flatten(1)
            yield torch.addmm(height, torch.cat([pairs, smells], dim=1), weights)
