"""The readout of a frozen atlas: what it says of a view's smell, and of which way it faces."""

from typing import NamedTuple

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from neurons.angles import mean_angle
from neurons.atlas.atlas import Atlas
from neurons.atlas.synchronisation import Compass
from neurons.layers.charts import Charts, NearestCharts, rows_of


class ChartActivity(NamedTuple):
    """Normalised activity of the charts that a view excites."""

    chart: Int[Tensor, "views winners"]
    weight: Float[Tensor, "views winners"]
    """Sums to one over the winners."""

    def of(self, views: Int[Tensor, "_"]) -> "ChartActivity":
        """Take some of the views."""
        return ChartActivity(self.chart[views], self.weight[views])


class Recalled(NamedTuple):
    """What the atlas recalls at the sight of views."""

    chart: Int[Tensor, "views winners"]
    weight: Float[Tensor, "views winners"]
    heading: Float[Tensor, "views"]
    """In the map's own frame, rad; NaN without a compass."""
    odour: Float[Tensor, "views odorants"]
    """Log concentrations."""

    @property
    def excited(self) -> ChartActivity:
        """Which charts are active, and how much."""
        return ChartActivity(self.chart, self.weight)


class Readout(nn.Module):
    """Reads heading and odour off the charts that a view excites.

    A view z excites its nearest charts with weights w ∝ exp(−|z − C_k|² / 2 h_k²), h_k a fraction of the
    chart's spacing.

        θ̂ = arg Σ w exp i(φ_k + c n_k·(z − C_k)),        ô = Σ w ô_k,  ô_k = a_k + J_kᵀ U_k (z − C_k).

    Charts of several places that look alike do not average: first w ← w exp(−|ô_k − ô_b|² / 2 (t m)²), b the
    chart whose smell ô_b the others support most, by the sum of w_k exp(−|ô_k − ô_b|² / 2 (t m)²), and m² the
    median squared misfit of a view's smell to its chart (`neurons.layers.charts.Charts`).

    Parameters
    ----------
    charts, components, odorants, tangents
        Sizes.
    winners
        Charts that speak for a view: two along each dimension of a body on the floor.
    breadth
        Width h_k of a chart's receptive field, in units of its spacing: wide enough that a view between
        charts hears several, narrow enough that none speaks where its tangents no longer fit.
    tolerance
        t, by how many usual misfits the smells of one place may differ; infinite lets all winners average.
    """

    def __init__(
        self,
        charts: int,
        components: int,
        odorants: int,
        tangents: int,
        *,
        winners: int = 8,
        breadth: float = 0.7,
        tolerance: float = 1.4,
    ) -> None:
        super().__init__()
        self.winners, self.breadth, self.tolerance = winners, breadth, tolerance
        self.spacing: Tensor = nn.Buffer(torch.ones(charts))
        # NaN, not 0: what is read too early must not pass for a heading or a smell
        self.phases: Tensor = nn.Buffer(torch.full((charts,), torch.nan))
        self.turning: Tensor = nn.Buffer(torch.full((charts, components), torch.nan))
        self.intercepts: Tensor = nn.Buffer(torch.full((charts, odorants), torch.nan))
        self.jacobians: Tensor = nn.Buffer(torch.full((charts, tangents, odorants), torch.nan))

    def solve(
        self,
        atlas: Atlas,
        compass: Compass | None,
        intercepts: Float[Tensor, "charts odorants"],
        jacobians: Float[Tensor, "charts d odorants"],
    ) -> None:
        """Take over what the charts have agreed on; without a compass headings stay NaN."""
        self.spacing = atlas.spacing
        self.intercepts, self.jacobians = intercepts, jacobians
        if compass is not None:
            # the scale goes into the axes once, not into the angle of every view
            self.phases, self.turning = compass.phases, compass.turning

    def excite(
        self,
        charts: Charts,
        codes: Float[Tensor, "views components"],
        log_odours: Float[Tensor, "views odorants"] | None = None,
    ) -> ChartActivity:
        """Activity of the nearest charts, as seen or as seen and smelt."""
        return self.activity(charts.excite(codes, self.winners, log_odours))

    def activity(self, nearest: NearestCharts) -> ChartActivity:
        """Activity of charts that have been found to be the nearest."""
        width = self.breadth * self.spacing[nearest.chart]
        # softmax takes the largest exponent away: a view far from all charts would else have weights 0 / 0
        weight = torch.softmax(-0.5 * nearest.squared_distance / width**2, dim=1)
        return ChartActivity(nearest.chart, weight)

    def forward(
        self, charts: Charts, codes: Float[Tensor, "views components"], excited: ChartActivity
    ) -> Recalled:
        """Let the excited charts vote, and read off those that agree."""
        chart, weight = excited
        coordinates, jacobians = charts.coordinates(codes, chart), rows_of(self.jacobians, chart)
        smells = self.intercepts[chart] + torch.einsum("nwd,nwdo->nwo", coordinates, jacobians)
        weight = self._vote(weight, smells, charts.misfits[1])
        # the difference before the product: n·z and n·C_k are large and nearly equal
        residuals = charts.residuals(codes, chart)
        angle = self.phases[chart] + torch.einsum("nwc,nwc->nw", rows_of(self.turning, chart), residuals)
        # as directions: a mean of angles tears at ±π, and whole turns drop out unwrapped
        heading = mean_angle(angle, weight)
        odour = torch.einsum("nw,nwo->no", weight, smells)
        return Recalled(chart, weight, heading, odour)

    def _vote(
        self,
        weight: Float[Tensor, "views winners"],
        smells: Float[Tensor, "views winners odorants"],
        misfit: Float[Tensor, ""],
    ) -> Float[Tensor, "views winners"]:
        """Let the winners whose smells differ from that with most support fall silent."""
        apart = (smells[:, :, None] - smells[:, None]).square().sum(dim=3)
        kin = torch.exp(-0.5 * apart / (self.tolerance**2 * misfit.clamp(min=1e-12)))
        best = (kin @ weight[:, :, None]).argmax(dim=1)
        weight = weight * kin.gather(1, best[:, :, None].expand(-1, -1, kin.shape[2]))[:, 0]
        return weight / weight.sum(dim=1, keepdim=True)
