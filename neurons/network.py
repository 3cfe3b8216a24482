"""The network: its layers in a row, and the stages in which they learn."""

from __future__ import annotations

import math
from contextlib import suppress

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.atlas.atlas import Atlas
from neurons.atlas.heading_axis import heading_axes
from neurons.atlas.metric_map import MetricMap
from neurons.atlas.synchronisation import synchronise
from neurons.errors import NeuronsError
from neurons.layers.afferents import Afferents
from neurons.layers.charts import Charts
from neurons.layers.heading_cells import HeadDirectionCells
from neurons.layers.olfaction import Olfaction
from neurons.layers.place_cells import PlaceCells
from neurons.layers.readout import Readout
from neurons.layers.sanger import Sanger

EPOCHS = {"code": 4, "charts": 6, "olfaction": 1, "cells": 2, "metric_map": 1, "afferents": 1}
"""Stages of development, in order, and how many epochs of views each lasts."""
STAGES = tuple(EPOCHS)
IN_ORDER = "metric_map"
"""The stage that learns from the order of views."""
WINNERS = (12, 4)
"""Charts that learn from a view, at the beginning and at the end of their stage."""
SMELLING = 16
"""Charts that learn the smell of a view."""
EIGENVALUE = 0.999
"""Least agreement of the phases in an atlas that can be trusted; at .998 headings have been seen 12° off."""
SIGNS = 0.995
"""Least agreement of the heading axes on a direction of turning."""


class Network(nn.Module):
    """Code, charts, olfaction, readout, two populations and a metric map, learning one after the other.

    Each layer learns during its own critical period, and those before it are then fixed: first the code, then
    the charts; then each chart learns how smell changes across it; then the charts agree on a compass, the
    cells share out what is recalled; from the order of views the metric map learns where places are and by
    how much the compass is off there; and at last the cells' afferents from sight are learnt. From the third
    stage on, all but what the cells compete for are sums.

    Parameters
    ----------
    features, odorants
        Inputs.
    charts, components, place_cells, heading_cells
        Sizes.
    most_charts
        Up to how many charts are added, while the guard says that the atlas is too coarse: their number is
        doubled, and all that follows the code is learnt again.
    epoch
        Views in an epoch, the unit of the critical periods.
    generator
        Draws the initial weights.
    """

    views_seen: Tensor
    stage_index: Tensor
    agreement: Tensor

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
        epoch: int,
        generator: torch.Generator,
    ) -> None:
        super().__init__()
        self.epoch = epoch
        self.most_charts = most_charts
        self.code = Sanger(features, components, generator=generator)
        self.charts = Charts(charts, components, generator=generator)
        self.olfaction = Olfaction(charts, odorants)
        self.readout = Readout(charts, components, odorants)
        self.place = PlaceCells(place_cells, charts, odorants)
        self.heading = HeadDirectionCells(heading_cells, charts, generator=generator)
        self.metric_map = MetricMap(place_cells, odorants)
        self.register_buffer("views_seen", torch.zeros((), dtype=torch.int64))
        self.register_buffer("stage_index", torch.zeros((), dtype=torch.int64))
        self.register_buffer("agreement", torch.full((2,), torch.nan))

    @property
    def stage(self) -> str:
        """The stage of development that the next view falls into; the last one never ends."""
        return next(stage for stage in reversed(STAGES) if self.begins(stage) <= int(self.views_seen))

    def begins(self, stage: str) -> int:
        """How many views come before a stage."""
        return self.epoch * sum(EPOCHS[before] for before in STAGES[: STAGES.index(stage)])

    def learn(
        self, strips: Float[Tensor, "views features"], log_odours: Float[Tensor, "views odorants"]
    ) -> None:
        """Let the layer whose period it is learn from a batch."""
        self.advance_stage()
        stage = self.stage
        self.views_seen += len(strips)
        if stage == "code":
            self.code.partial_fit(strips)
            return
        codes = self.code(strips)
        if stage == "charts":
            self.charts.partial_fit(codes, winners=self._winners(), window=float(self.epoch))
        elif stage == "olfaction":
            nearest = self.charts.excite(codes, SMELLING)
            width = self.readout.spacing[nearest.chart]
            weight = torch.exp(-0.5 * nearest.squared_distance / width**2)
            coordinates = self.charts.coordinates(codes, nearest.chart)
            self.olfaction.partial_fit(nearest.chart, weight, coordinates, log_odours)
        else:
            excited = self.readout.excite(self.charts, codes)
            headings, odours = self.readout(self.charts, codes, excited)
            if stage == "cells":
                self.place.compete(odours, window=float(self.epoch))
                self.heading.compete(headings, window=float(self.epoch))
            elif stage == "metric_map":
                self.metric_map.partial_fit(self.place, odours, headings)
            else:
                corrected = headings + self.metric_map(self.place, odours).offset
                self.place.afferents.partial_fit(excited, self.place.instruct(excited, odours))
                self.heading.afferents.partial_fit(excited, self.heading.tuning(corrected))

    def diagnosis(self) -> str:
        """Say why this map cannot be trusted, or nothing when it can."""
        if self.stage != STAGES[-1]:
            return f"it is still in its {self.stage!r} stage; show it more views"
        return self.atlas_diagnosis()

    def atlas_diagnosis(self) -> str:
        """Say in what the charts do not agree, or nothing when they do."""
        signs, phases = self.agreement.tolist()
        if not math.isfinite(phases):
            return "no loop of its charts closes after a turn; use more charts or more views"
        if phases < EIGENVALUE:
            return (
                f"the phases of its charts agree only to {phases:.4f}, below {EIGENVALUE}: "
                "the atlas is too coarse; use more charts"
            )
        if signs < SIGNS:
            return f"its heading axes agree only to {signs:.3f}; use more charts or more odour sources"
        return ""

    def metric_diagnosis(self) -> str:
        """Say why there is no metric map, or nothing when there is one."""
        if self.stage != STAGES[-1]:
            return f"this map is still in its {self.stage!r} stage; show it more views"
        return self.metric_map.diagnosis()

    def _winners(self) -> int:
        """Charts that learn from the next view, falling geometrically over their stage."""
        share = min(
            1.0, max(0.0, (int(self.views_seen) - self.begins("charts")) / (EPOCHS["charts"] * self.epoch))
        )
        first, last = WINNERS
        return round(float(first * (last / first) ** share))

    def advance_stage(self) -> None:
        """Fix what came before the present stage, once."""
        while int(self.stage_index) < STAGES.index(self.stage):
            self.stage_index += 1
            entered = STAGES[int(self.stage_index)]
            if entered == "olfaction":
                self.charts.freeze()
                self.readout.spacing = Atlas.of(self.charts.centres).spacing
            elif entered == "cells":
                self._orient()
                if self.atlas_diagnosis() and len(self.charts) < self.most_charts:
                    self._add_charts()
            elif entered == "afferents":
                self.metric_map.solve()
                edges = Atlas.of(self.charts.centres).edges
                self.place.disambiguate(self.readout.intercepts, self.readout.phases, edges)

    def _orient(self) -> None:
        atlas = Atlas.of(self.charts.centres)
        intercepts, jacobians = self.olfaction.solve()
        axes = heading_axes(self.charts.tangents, jacobians, atlas)
        compass = None
        with suppress(NeuronsError):  # no ring closes: `agreement` stays NaN, which `diagnosis` tells
            compass = synchronise(self.charts.centres, axes, atlas)
            self.agreement = torch.tensor([compass.sign_agreement, compass.eigenvalue])
        self.readout.solve(atlas, compass, intercepts, jacobians)

    def _add_charts(self) -> None:
        """Double the charts where they lie farthest apart, and go back to the stage in which they learn."""
        count, odorants = len(self.charts), self.place.centres.shape[1]
        self.charts.grow(Atlas.of(self.charts.centres).edges, min(count, self.most_charts - count))
        count = len(self.charts)
        self.olfaction = Olfaction(count, odorants)
        self.readout = Readout(count, self.charts.centres.shape[1], odorants)
        self.place = PlaceCells(len(self.place.centres), count, odorants)
        self.heading.afferents = Afferents(count, len(self.heading.preferred))
        self.agreement.fill_(torch.nan)
        self.stage_index.fill_(STAGES.index("charts"))
        self.views_seen.fill_(self.begins("charts"))
