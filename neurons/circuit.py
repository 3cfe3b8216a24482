"""The circuit: all layers, and the way of a view through them."""

from math import isnan

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from neurons.atlas.atlas import Atlas
from neurons.atlas.metric_map import MetricMap
from neurons.guard import Guard
from neurons.layers.afferents import Afferents
from neurons.layers.charts import FIRST_TANGENTS, TANGENTS, Charts
from neurons.layers.dimension import dimension_votes
from neurons.layers.heading_cells import HeadDirectionCells
from neurons.layers.olfaction import Olfaction
from neurons.layers.place_cells import PlaceCells
from neurons.layers.readout import Readout, Recalled
from neurons.layers.sanger import Sanger


class Circuit(nn.Module):
    """Code, charts, olfaction, readout, two populations and a metric map.

    Parameters
    ----------
    features, odorants
        Inputs.
    charts, components, place_cells, heading_cells
        Sizes.
    most_charts
        Up to how many charts can be added.
    generator
        Draws the initial weights, on the processor; `to` takes the layers to another device, to learn there.
    smell
        κ, how much smell counts beside sight where charts compete (`neurons.layers.charts.Charts`).
    tangents
        Of each chart, to begin with; how many lie along the manifold is learnt.
    code
        That has learnt elsewhere already (`neurons.layers.sanger.Sanger.grown`), in place of `components` new
        ones.
    guard
        Bounds of what is trusted; the usual ones unless told.
    """

    def __init__(
        self,
        features: int,
        odorants: int,
        *,
        charts: int,
        most_charts: int,
        components: int,
        place_cells: int,
        heading_cells: int,
        generator: torch.Generator,
        smell: float = 0.5,
        tangents: int = FIRST_TANGENTS,
        code: Sanger | None = None,
        guard: Guard | None = None,
    ) -> None:
        super().__init__()
        self.most_charts = most_charts
        self.guard = guard or Guard()
        self.code = code or Sanger(features, components, generator=generator)
        components = len(self.code)
        self.charts = Charts(
            charts, components, odorants, generator=generator, smell=smell, tangents=tangents
        )
        self.olfaction = Olfaction(charts, odorants, tangents)
        self.readout = Readout(charts, components, odorants, tangents)
        self.place = PlaceCells(place_cells, charts, odorants)
        self.heading = HeadDirectionCells(heading_cells, charts, generator=generator)
        self.metric_map = MetricMap(place_cells, heading_cells, odorants)
        self.agreement: Tensor = nn.Buffer(torch.full((2,), torch.nan))
        self.connected: Tensor = nn.Buffer(torch.zeros((), dtype=torch.bool))
        self.spectrum: Tensor = nn.Buffer(torch.full((min(TANGENTS, components),), torch.nan))
        self.votes: Tensor = nn.Buffer(torch.full((len(self.spectrum) - 1,), torch.nan))
        self.felt: Tensor = nn.Buffer(torch.full((), torch.nan))
        self.ambiguity: Tensor = nn.Buffer(torch.full((2,), torch.nan))

    def recall(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"] | None = None,
    ) -> Recalled:
        """Tell heading and smell from sight; from both senses where the smell is given, too."""
        codes = self.code(strips)
        excited = self.readout.excite(self.charts, codes, log_odours)
        recalled: Recalled = self.readout(self.charts, codes, excited)
        return recalled

    def cut_code(self) -> None:
        """Leave a code that has grown what it needs; what stands on it is as before any view."""
        self.code.cut()
        charts = self.charts
        self.charts = Charts(
            len(charts),
            len(self.code),
            charts.smells.shape[1],
            # of its own: a map that was saved and loaded has none to go on with
            generator=torch.Generator().manual_seed(0),
            smell=charts.smell,
            tangents=charts.dimensions,
        )
        self._stand_on_charts()

    @property
    def dimension(self) -> tuple[int, float]:
        """Degrees of freedom that most charts tell, and the share of them that do; 0 and NaN before."""
        vote = float(self.votes.max())
        return (0, vote) if isnan(vote) else (int(self.votes.argmax()) + 1, vote)

    def atlas_diagnosis(self) -> str:
        """Say in what the charts do not agree, or nothing when they do."""
        signs, phases = self.agreement.tolist()
        return self.guard.atlas(signs, phases)

    def widen_charts(self) -> None:
        """Give each chart more tangents than the manifold may have dimensions, unless they have them."""
        before = self.charts.dimensions
        self.charts.widen()
        if self.charts.dimensions > before:
            self._stand_on_charts()

    def cut_charts(self) -> None:
        """Leave the charts as many tangents as most tell; where too few agree, as many as they began with."""
        spectra = self.charts.spectra
        if len(spectra):  # of views that are all the same nothing is told
            # a median along an axis is refused on devices that are to give the same bits twice
            self.spectrum, self.votes = spectra.quantile(0.5, dim=0), dimension_votes(spectra)
        agreed = float(self.votes.max()) >= self.guard.least_vote
        self.charts.cut(int(self.votes.argmax()) + 1 if agreed else FIRST_TANGENTS)
        self._stand_on_charts()

    def add_charts(self) -> None:
        """Double the charts where they lie farthest apart; what stands on them is as before any view."""
        count = len(self.charts)
        self.charts.grow(Atlas.of(self.charts.points).edges, min(count, self.most_charts - count))
        self._blank_cells()
        self.agreement.fill_(torch.nan)
        self.connected.zero_()
        self.ambiguity.fill_(torch.nan)
        self.spectrum.fill_(torch.nan)
        self.votes.fill_(torch.nan)
        self.felt.fill_(torch.nan)

    def keep_charts(self, kept: Int[Tensor, "kept"]) -> None:
        """Keep these charts alone; what stands on them is as before any view."""
        self.charts.keep(kept)
        self._blank_cells()
        self.readout.spacing = Atlas.of(self.charts.points).spacing

    def _blank_cells(self) -> None:
        """Let cells hear nothing yet of charts that are others than before."""
        self._stand_on_charts()
        count, cells = len(self.charts), len(self.place.centres)
        # place cells that have learnt before there were charts keep what they prefer
        self.place.branches = torch.ones(count, cells, dtype=torch.bool)
        self.place.afferents = Afferents(count, cells)
        # preferred directions stay as drawn: a map that was saved and loaded has no generator to go on with
        self.heading.afferents = Afferents(count, len(self.heading.preferred))
        self.to(self.agreement.device)  # where the layers are that these replace

    def _stand_on_charts(self) -> None:
        """Make what stands on the charts anew, of their number and tangents, as before any view."""
        charts, tangents, components = self.charts.tangents.shape
        odorants = self.place.centres.shape[1]
        self.olfaction = Olfaction(charts, odorants, tangents)
        self.readout = Readout(charts, components, odorants, tangents)
        self.to(self.agreement.device)
