"""Charts of the view manifold: they compete for what is seen and smelt, and learn tangents of sight."""

from typing import NamedTuple

import torch
from jaxtyping import Float, Int, Shaped
from scipy.stats import chi2
from torch import Tensor, nn

FIRST_TANGENTS = 3
"""With which a chart begins: the degrees of freedom of a body on the floor."""
TANGENTS = 6
"""To which they are widened, to see how many are along the manifold."""


def rows_of(table: Shaped[Tensor, "rows *row"], index: Int[Tensor, "*index"]) -> Shaped[Tensor, "..."]:
    """Take rows of a table, `table[index]`; whole ones, which is several times as fast."""
    rows = table.index_select(0, index.flatten())
    return rows.reshape(*index.shape, *table.shape[1:])


class NearestCharts(NamedTuple):
    """Which charts each view excites, and how strongly."""

    chart: Int[Tensor, "views winners"]
    """Nearest first."""
    squared_distance: Float[Tensor, "views winners"]


class Frames(NamedTuple):
    """Frames of chart coordinates: origins and axes."""

    centres: Float[Tensor, "charts components"]
    tangents: Float[Tensor, "charts d components"]


class Charts(nn.Module):
    """Competitive local PCA: K centres C_k tile the codes, each with tangents U_k along the manifold.

    A view z, where o was smelt (log odour), excites its m nearest charts by

        d_k² = |z − C_k|² + λ² |o − a_k|²,        λ² = κ² median |z − C_1|² / median |o − a_1|²,

    1 the winner: smell keeps places apart that look alike, and where one place is seen its weight λ is too
    small to move a border. The medians are running ones over the winners of an epoch: neither the order of
    views nor the noise of the nose need be known. That of smell is told from the lower decile, as if misfits
    were normal, since where most places look alike it would be that of two places. The chart of rank r learns
    with h = exp(−2 r / m): C_k and a_k move to the running means of h z and h o, and U_k follows Sanger's
    rule on the residuals z − C_k, normalised by their variance as in `neurons.layers.sanger.Sanger`. `widen`
    gives each chart more tangents than the manifold may have dimensions, `cut` leaves those along it, which
    their variances tell from those of curvature and noise (`neurons.layers.dimension`). `freeze` makes the
    tangents orthonormal; after it nothing here changes any more.

    Parameters
    ----------
    charts, components, odorants
        K and the lengths of a code and of a smell, 0 without a nose.
    generator
        Draws the initial tangents.
    smell
        κ, what the usual misfit of smell counts beside the usual misfit of sight; 0 lets sight alone compete.
    tangents
        d, rows of U_k to begin with.

    References
    ----------
    Martinetz, Berkovich & Schulten (1993), 'Neural-gas' network. IEEE Trans. Neural Networks 4 (competition
    by rank).
    Kambhatla & Leen (1997), Dimension reduction by local principal component analysis. Neural Computation 9.
    """

    def __init__(
        self,
        charts: int,
        components: int,
        odorants: int,
        *,
        generator: torch.Generator,
        smell: float = 0.5,
        tangents: int = FIRST_TANGENTS,
    ) -> None:
        super().__init__()
        self.smell = smell
        # orthonormal from the start, as Sanger's rule expects of rows that are to part
        draws = torch.randn(charts, components, tangents, generator=generator)
        self.centres: Tensor = nn.Buffer(torch.zeros(charts, components))
        self.smells: Tensor = nn.Buffer(torch.zeros(charts, odorants))
        self.tangents: Tensor = nn.Buffer(torch.linalg.qr(draws).Q.mT.contiguous())
        self.responsibility: Tensor = nn.Buffer(torch.zeros(charts))
        self.variances: Tensor = nn.Buffer(torch.zeros(charts, tangents))
        self.initialised: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.misfits: Tensor = nn.Buffer(torch.ones(2))
        self.measured: Tensor = nn.Buffer(torch.zeros(()))
        # without a nose there is no misfit of smell to measure
        self.median_over_decile = (
            float(chi2.ppf(0.5, odorants) / chi2.ppf(0.1, odorants)) if odorants else 0.0
        )

    def __len__(self) -> int:
        return len(self.centres)

    @property
    def dimensions(self) -> int:
        """How many tangents a chart has."""
        return self.tangents.shape[1]

    @property
    def spectra(self) -> Float[Tensor, "won d"]:
        """Shares of what a chart sees along its tangents, of those charts that have won views."""
        total = self.variances.sum(dim=1, keepdim=True)
        return (self.variances / total)[total[:, 0] > 0]

    @property
    def smell_weight(self) -> Float[Tensor, ""]:
        """λ, units of code per unit of log odour; κ before any chart has won."""
        sight, smell = self.misfits
        weight: Tensor = self.smell * (sight / smell.clamp(min=1e-12)).sqrt()
        return weight

    @property
    def points(self) -> Float[Tensor, "charts components_and_odorants"]:
        """Give (C_k, λ a_k), between which distances are those of the competition."""
        return torch.cat([self.centres, self.smell_weight * self.smells], dim=1)

    def excite(
        self,
        codes: Float[Tensor, "views components"],
        winners: int,
        log_odours: Float[Tensor, "views odorants"] | None = None,
    ) -> NearestCharts:
        """Find the nearest charts of each view, nearest first; without smells, by sight alone."""
        chart = self._nearest(codes, winners, log_odours)
        # subtracting codes directly keeps the digits that |c|² − 2 z·c loses near a centre
        squared = self.residuals(codes, chart).square().sum(dim=2)
        if log_odours is not None:
            misfit = (log_odours[:, None] - rows_of(self.smells, chart)).square().sum(dim=2)
            squared += self.smell_weight**2 * misfit
        return NearestCharts(chart, squared)

    def coordinates(
        self, codes: Float[Tensor, "views components"], chart: Int[Tensor, "views winners"]
    ) -> Float[Tensor, "views winners d"]:
        """Chart coordinates U_k (z − C_k) of each code in the charts it excites."""
        residuals = self.residuals(codes, chart)
        return torch.einsum("nwdc,nwc->nwd", rows_of(self.tangents, chart), residuals)

    def residuals(
        self, codes: Float[Tensor, "views components"], chart: Int[Tensor, "views winners"]
    ) -> Float[Tensor, "views winners components"]:
        """Differences z − C_k of each code from the charts it excites."""
        return codes[:, None] - rows_of(self.centres, chart)

    @property
    def frames(self) -> Frames:
        """The frames of chart coordinates as they are now: a copy."""
        return Frames(self.centres.clone(), self.tangents.clone())

    def since(self, before: Frames) -> Float[Tensor, "charts f f"]:
        """Give what takes [1, u] of a view in a tangent plane from earlier frames to those of now."""
        flat = before.tangents.double()
        tangents = self.tangents.double()
        # rows part from right angles while they learn
        turn = torch.linalg.solve(flat @ flat.mT, flat @ tangents.mT).mT
        shift = torch.einsum("kdc,kc->kd", tangents, (before.centres - self.centres).double())
        change = torch.eye(1 + self.dimensions, dtype=torch.double, device=flat.device)
        change = change.repeat(len(self), 1, 1)
        change[:, 1:, 0], change[:, 1:, 1:] = shift, turn
        return change

    def partial_fit(
        self,
        codes: Float[Tensor, "views components"],
        log_odours: Float[Tensor, "views odorants"],
        *,
        winners: int,
        window: float,
    ) -> None:
        """Let a batch of views compete.

        The first K views ever seen, over as many batches as it takes, become the charts; the rest compete.
        `winners` is m; `window` is how many views a chart remembers when it averages.
        """
        first = int(self.initialised)
        count = min(len(codes), len(self) - first)
        self.centres[first : first + count] = codes[:count]
        self.smells[first : first + count] = log_odours[:count]
        self.initialised += count
        if count < len(codes):
            self._compete(codes[count:], log_odours[count:], winners=winners, window=window)

    def grow(self, overlapping: Int[Tensor, "edges 2"], count: int) -> None:
        """Add so many charts, halfway between those of the given pairs that lie farthest apart."""
        one, other = overlapping.T
        length = (self.points[one] - self.points[other]).norm(dim=1)
        longest = length.topk(min(count, len(length))).indices
        one, other = one[longest], other[longest]
        self.centres = torch.cat([self.centres, (self.centres[one] + self.centres[other]) / 2])
        self.smells = torch.cat([self.smells, (self.smells[one] + self.smells[other]) / 2])
        self.tangents = torch.cat([self.tangents, self.tangents[one]])
        self.responsibility = torch.cat([self.responsibility, self.responsibility.new_zeros(len(longest))])
        self.variances = torch.cat([self.variances, self.variances.new_zeros(len(longest), self.dimensions)])
        self.initialised.fill_(len(self.centres))

    def keep(self, kept: Int[Tensor, "kept"]) -> None:
        """Keep these charts alone."""
        for name in ("centres", "smells", "tangents", "responsibility", "variances"):
            setattr(self, name, self.get_buffer(name)[kept])
        self.initialised.fill_(len(kept))

    def widen(self) -> None:
        """Give each chart the tangents that it lacks of `TANGENTS`, at right angles to those that it has."""
        charts, components = self.centres.shape
        lacking = max(0, min(TANGENTS, components) - self.dimensions)
        if not lacking:
            return
        # of a generator of its own: a map that was saved and loaded has no other, and those that it began
        # with learn as if these were not there
        draws = torch.randn(charts, lacking, components, generator=torch.Generator().manual_seed(0))
        wide = torch.cat([self.tangents, draws.to(self.tangents)], dim=1)
        drawn = torch.linalg.qr(wide.mT).Q.mT[:, self.dimensions :]
        self.tangents = torch.cat([self.tangents, drawn], dim=1)
        self.variances = torch.cat([self.variances, self.variances.new_zeros(charts, lacking)], dim=1)

    def cut(self, dimensions: int) -> None:
        """Leave each chart so many tangents, those of the largest variances."""
        self.tangents = self.tangents[:, :dimensions].contiguous()
        self.variances = self.variances[:, :dimensions].contiguous()

    def _nearest(
        self,
        codes: Float[Tensor, "views components"],
        winners: int,
        log_odours: Float[Tensor, "views odorants"] | None,
    ) -> Int[Tensor, "views _"]:
        points, views = self.centres, codes
        if log_odours is not None:
            points, views = self.points, torch.cat([codes, self.smell_weight * log_odours], dim=1)
        # |z − c|² less |z|², which is the same for all charts: one product for the batch
        squared = torch.addmm(points.square().sum(dim=1), views, points.T, alpha=-2.0)
        return squared.topk(min(winners, len(self)), dim=1, largest=False).indices

    def _compete(
        self,
        codes: Float[Tensor, "views components"],
        log_odours: Float[Tensor, "views odorants"],
        *,
        winners: int,
        window: float,
    ) -> None:
        chart = self._nearest(codes, winners, log_odours)
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
        residuals, misfits = self.residuals(codes, chart), log_odours[:, None] - rows_of(self.smells, chart)
        self._measure(residuals[:, 0], misfits[:, 0], window)
        residual, misfit = residuals.flatten(0, 1), misfits.flatten(0, 1)
        y = torch.einsum("ndc,nc->nd", rows_of(tangents, flat), residual)
        weighted = weight[:, None] * y
        shift = codes.new_zeros(len(won), residual.shape[1]).index_add_(0, flat, weight[:, None] * residual)
        hebb = torch.zeros_like(tangents).index_add_(0, flat, weighted[:, :, None] * residual[:, None])
        products = weighted[:, :, None] * y[:, None]
        cross = products.new_zeros(len(won), *products.shape[1:]).index_add_(0, flat, products)
        self.centres.index_add_(0, won, rate[:, None] * shift)
        drift = codes.new_zeros(len(won), misfit.shape[1]).index_add_(0, flat, weight[:, None] * misfit)
        self.smells.index_add_(0, won, rate[:, None] * drift)
        drive = self.variances[won][:, :, None] * tangents
        # sums over what was won, not means yet: one multiplication by `rate` below makes means of all terms
        decay = torch.tril(cross, diagonal=-1) @ tangents
        drive += rate[:, None, None] * (hebb - decay - fed[:, None, None] * drive)
        length = drive.norm(dim=2)
        self.variances[won] = length
        # views at its very centre drive a chart nowhere: it keeps the tangents that it was born with
        drive *= (1 / length)[:, :, None]
        self.tangents.index_copy_(0, won, torch.where(length[:, :, None] > 0, drive, tangents))

    def _measure(
        self,
        residuals: Float[Tensor, "views components"],
        misfits: Float[Tensor, "views odorants"],
        window: float,
    ) -> None:
        """Keep running medians of the squared misfits of the winners, which say what smell is to count."""
        sight, smell = (each.square().sum(dim=1) for each in (residuals, misfits))
        # most views may be won by a place that only looks alike and smells of another, but not nine in ten
        usual = self.median_over_decile * smell.quantile(0.1)
        squares = torch.stack([sight.median(), usual])
        self.measured *= max(0.0, 1 - len(residuals) / window)
        self.measured += len(residuals)
        self.misfits += len(residuals) / self.measured * (squares - self.misfits)

    def freeze(self) -> None:
        """Make the tangents of each chart orthonormal."""
        # QR keeps the span of the first d tangents for every d: they stay in the order of their variances
        self.tangents = torch.linalg.qr(self.tangents.mT).Q.mT.contiguous()
