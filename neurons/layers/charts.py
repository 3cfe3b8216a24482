"""Charts of the view manifold: competing centres, each with tangents learnt from what it wins."""

from typing import NamedTuple

import torch
from jaxtyping import Float, Int, Shaped
from torch import Tensor, nn

DIMENSIONS = 3
"""Degrees of freedom of a body on the floor, hence tangents per chart."""


def rows_of(table: Shaped[Tensor, "rows *row"], index: Int[Tensor, "*index"]) -> Shaped[Tensor, "..."]:
    """Take rows of a table, `table[index]`; whole ones, which is several times as fast."""
    rows = table.index_select(0, index.flatten())
    return rows.reshape(*index.shape, *table.shape[1:])


class NearestCharts(NamedTuple):
    """Which charts each view excites, and how strongly."""

    chart: Int[Tensor, "views winners"]
    """Nearest first."""
    squared_distance: Float[Tensor, "views winners"]


class Charts(nn.Module):
    """Competitive local PCA: K centres C_k tile the codes, each with tangents U_k along the manifold.

    A view z excites its m nearest centres. The centre of rank r learns with h = exp(−2 r / m): C_k moves to
    the running mean of h z, and U_k follows Sanger's rule on the residuals z − C_k, normalised by their
    variance as in `neurons.layers.sanger.Sanger`. `freeze` makes the tangents orthonormal; after it
    nothing here changes any more.

    Parameters
    ----------
    charts, components
        K and the length of a code.
    generator
        Draws the initial tangents.

    References
    ----------
    Martinetz, Berkovich & Schulten (1993), 'Neural-gas' network. IEEE Trans. Neural Networks 4 (competition
    by rank).
    Kambhatla & Leen (1997), Dimension reduction by local principal component analysis. Neural Computation 9.
    """

    def __init__(self, charts: int, components: int, *, generator: torch.Generator) -> None:
        super().__init__()
        # orthonormal from the start, as Sanger's rule expects of rows that are to part
        draws = torch.randn(charts, components, DIMENSIONS, generator=generator)
        self.centres: Tensor = nn.Buffer(torch.zeros(charts, components))
        self.tangents: Tensor = nn.Buffer(torch.linalg.qr(draws).Q.mT.contiguous())
        self.responsibility: Tensor = nn.Buffer(torch.zeros(charts))
        self.variances: Tensor = nn.Buffer(torch.zeros(charts, DIMENSIONS))
        self.initialised: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))

    def __len__(self) -> int:
        return len(self.centres)

    def excite(self, codes: Float[Tensor, "views components"], winners: int) -> NearestCharts:
        """Find the nearest centres of each code, nearest first."""
        chart = self._nearest(codes, winners)
        # subtracting codes directly keeps the digits that |c|² − 2 z·c loses near a centre
        return NearestCharts(chart, self.residuals(codes, chart).square().sum(dim=2))

    def coordinates(
        self, codes: Float[Tensor, "views components"], chart: Int[Tensor, "views winners"]
    ) -> Float[Tensor, "views winners 3"]:
        """Chart coordinates U_k (z − C_k) of each code in the charts it excites."""
        residuals = self.residuals(codes, chart)
        return torch.einsum("nwdc,nwc->nwd", rows_of(self.tangents, chart), residuals)

    def residuals(
        self, codes: Float[Tensor, "views components"], chart: Int[Tensor, "views winners"]
    ) -> Float[Tensor, "views winners components"]:
        """Differences z − C_k of each code from the charts it excites."""
        return codes[:, None] - rows_of(self.centres, chart)

    def partial_fit(self, codes: Float[Tensor, "views components"], *, winners: int, window: float) -> None:
        """Let a batch of codes compete.

        The first K codes ever seen, over as many batches as it takes, become the centres; the rest compete.
        `winners` is m; `window` is how many views a centre remembers when it averages.
        """
        initialised = int(self.initialised)
        fresh, rest = codes[: len(self) - initialised], codes[len(self) - initialised :]
        self.centres[initialised : initialised + len(fresh)] = fresh
        self.initialised += len(fresh)
        if len(rest):
            self._compete(rest, winners=winners, window=window)

    def grow(self, overlapping: Int[Tensor, "edges 2"], count: int) -> None:
        """Add so many charts, halfway between those of the given pairs that lie farthest apart."""
        one, other = overlapping.T
        length = (self.centres[one] - self.centres[other]).norm(dim=1)
        longest = length.topk(min(count, len(length))).indices
        one, other = one[longest], other[longest]
        self.centres = torch.cat([self.centres, (self.centres[one] + self.centres[other]) / 2])
        self.tangents = torch.cat([self.tangents, self.tangents[one]])
        self.responsibility = torch.cat([self.responsibility, self.responsibility.new_zeros(len(longest))])
        self.variances = torch.cat([self.variances, self.variances.new_zeros(len(longest), DIMENSIONS)])
        self.initialised.fill_(len(self.centres))

    def _nearest(self, codes: Float[Tensor, "views components"], winners: int) -> Int[Tensor, "views _"]:
        # |z − c|² less |z|², which is the same for all charts: one product for the batch
        squared = torch.addmm(self.centres.square().sum(dim=1), codes, self.centres.T, alpha=-2.0)
        return squared.topk(min(winners, len(self)), dim=1, largest=False).indices

    def _compete(self, codes: Float[Tensor, "views components"], *, winners: int, window: float) -> None:
        chart = self._nearest(codes, winners)
        # the last of m winners learns about e⁻² as much as the first, whatever m is
        h = torch.exp(-2.0 * torch.arange(chart.shape[1], device=codes.device) / chart.shape[1])
        # only what has won is touched: a third of the charts, and of the memory
        won, flat = chart.flatten().unique(return_inverse=True)
        weight = h.repeat(len(codes))
        # index_add_ on one thread adds in the order of views, so that the same seed gives the same bits
        fed = codes.new_zeros(len(won)).index_add_(0, flat, weight)
        # forgotten by the batch, and never below zero where a batch is longer than the window
        self.responsibility *= max(0.0, 1 - len(codes) / window)
        self.responsibility[won] += fed
        # with this batch in the sum a first win has the rate 1: the mean of what was won
        rate = 1 / self.responsibility[won]
        tangents = rows_of(self.tangents, won)
        # from centres before they move: all that follows is of one state
        residual = self.residuals(codes, chart).flatten(0, 1)
        y = torch.einsum("ndc,nc->nd", rows_of(tangents, flat), residual)
        weighted = weight[:, None] * y
        shift = codes.new_zeros(len(won), residual.shape[1]).index_add_(0, flat, weight[:, None] * residual)
        hebb = torch.zeros_like(tangents).index_add_(0, flat, weighted[:, :, None] * residual[:, None])
        cross = codes.new_zeros(len(won), DIMENSIONS, DIMENSIONS).index_add_(
            0, flat, weighted[:, :, None] * y[:, None]
        )
        self.centres.index_add_(0, won, rate[:, None] * shift)
        drive = self.variances[won][:, :, None] * tangents
        # sums over what was won, not means yet: one multiplication by `rate` below makes means of all terms
        decay = torch.tril(cross, diagonal=-1) @ tangents
        drive += rate[:, None, None] * (hebb - decay - fed[:, None, None] * drive)
        length = drive.norm(dim=2)
        self.variances[won] = length
        # views at its very centre drive a chart nowhere: it keeps the tangents that it was born with
        drive *= (1 / length)[:, :, None]
        self.tangents.index_copy_(0, won, torch.where(length[:, :, None] > 0, drive, tangents))

    def freeze(self) -> None:
        """Make the tangents of each chart orthonormal."""
        # QR keeps the span of the first d tangents for every d: they stay in the order of their variances
        self.tangents = torch.linalg.qr(self.tangents.mT).Q.mT.contiguous()
