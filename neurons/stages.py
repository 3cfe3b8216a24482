"""The stages of learning, critical periods one after the other: what each teaches, how long, from what."""

from abc import ABC, abstractmethod
from contextlib import suppress
from dataclasses import dataclass
from typing import ClassVar

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.atlas.atlas import Atlas
from neurons.atlas.heading_axis import heading_axes
from neurons.atlas.synchronisation import synchronise
from neurons.circuit import Circuit
from neurons.errors import NeuronsError


@dataclass(frozen=True)
class Batch:
    """Views that are learnt together, as the retina's strips, and what was smelt there."""

    strips: Float[Tensor, "views features"]
    log_odours: Float[Tensor, "views odorants"]
    progress: float
    """How much of the stage is over with this batch, from 0 to 1."""
    window: float
    """Views in an epoch: what a running mean remembers."""


@dataclass(frozen=True)
class Stage(ABC):
    """A critical period in which some layers learn while all others are fixed.

    A new stage is a class of this kind, and a line in the list of stages.

    Attributes
    ----------
    name
        What it is called in sentences and tables; no two stages of a network share one.
    epochs
        How many epochs of views it lasts; the last stage of a network never ends.
    in_order
        Whether it learns from the order of views, which is random in the epochs of other stages.
    sums
        Buffers to which each view adds, so that what maps have learnt apart can be added up; none where units
        compete, and what they learn depends on the order of views.
    recent
        Buffers that hold the last views of a walk, floating point; NaN where the next view follows none.
    """

    name: ClassVar[str]
    in_order: ClassVar[bool] = False
    sums: ClassVar[tuple[str, ...]] = ()
    recent: ClassVar[tuple[str, ...]] = ()
    epochs: int = 1

    def layers(self, circuit: Circuit) -> dict[str, nn.Module]:  # noqa: ARG002
        """Make layers of this stage alone, by names that the circuit lacks; again when charts are added."""
        return {}

    @abstractmethod
    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Let its layers learn from a batch."""

    def finish(self, circuit: Circuit) -> str | None:  # noqa: ARG002
        """Fix what was learnt; give the name of an earlier stage to go back to it."""
        return None


@dataclass(frozen=True)
class CodeStage(Stage):
    """Principal components of the retina's strips."""

    name = "code"
    epochs: int = 4

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Take a step of Sanger's rule."""
        circuit.code.partial_fit(batch.strips)


@dataclass(frozen=True)
class ChartStage(Stage):
    """Charts compete for codes, until they tile the manifold of views.

    Parameters
    ----------
    winners
        Charts that learn from a view, at the beginning and at the end: many unfold the tiling, few refine it.
    """

    name = "charts"
    epochs: int = 6
    winners: tuple[int, int] = (12, 4)

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Let the nearest charts learn, fewer and fewer, falling geometrically."""
        first, last = self.winners
        winners = round(float(first * (last / first) ** batch.progress))
        circuit.charts.partial_fit(circuit.code(batch.strips), winners=winners, window=batch.window)

    def finish(self, circuit: Circuit) -> None:
        """Freeze the charts, and measure how far apart they lie."""
        circuit.charts.freeze()
        circuit.readout.spacing = Atlas.of(circuit.charts.centres).spacing


@dataclass(frozen=True)
class OlfactionStage(Stage):
    """Each chart learns how smell changes across it; then the charts agree on a compass.

    Parameters
    ----------
    winners
        Charts that learn the smell of a view: twice those that are read, so that no chart lacks views.
    """

    name = "olfaction"
    sums = ("olfaction.gram", "olfaction.cross")
    winners: int = 16

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Add views to the regressions of the charts near them, with Gaussian weights."""
        codes = circuit.code(batch.strips)
        nearest = circuit.charts.excite(codes, self.winners)
        weight = torch.exp(-0.5 * nearest.squared_distance / circuit.readout.spacing[nearest.chart] ** 2)
        coordinates = circuit.charts.coordinates(codes, nearest.chart)
        circuit.olfaction.partial_fit(nearest.chart, weight, coordinates, batch.log_odours)

    def finish(self, circuit: Circuit) -> str | None:
        """Synchronise the charts; while they do not agree, add some and let all of them learn again."""
        self._orient(circuit)
        if circuit.atlas_diagnosis() and len(circuit.charts) < circuit.most_charts:
            circuit.add_charts()
            return ChartStage.name
        return None

    @staticmethod
    def _orient(circuit: Circuit) -> None:
        atlas = Atlas.of(circuit.charts.centres)
        intercepts, jacobians = circuit.olfaction.solve()
        axes = heading_axes(circuit.charts.tangents, jacobians, atlas)
        compass = None
        with suppress(NeuronsError):  # no ring closes: `agreement` stays NaN, which `diagnosis` tells
            compass = synchronise(circuit.charts.centres, axes, atlas)
            circuit.agreement = torch.tensor([compass.sign_agreement, compass.eigenvalue])
        circuit.readout.solve(atlas, compass, intercepts, jacobians)


@dataclass(frozen=True)
class CellStage(Stage):
    """Place cells share out the recalled smells, head-direction cells the headings."""

    name = "cells"
    epochs: int = 2

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Let the cells of both populations compete."""
        recalled = circuit.recall(batch.strips)
        circuit.place.compete(recalled.odour, window=batch.window)
        circuit.heading.compete(recalled.heading, window=batch.window)


@dataclass(frozen=True)
class MetricMapStage(Stage):
    """Where places are, and by how much the compass is off there, from the order of views."""

    name = "metric_map"
    in_order = True
    sums = tuple(f"metric_map.{name}" for name in ("spread", "ahead", "shared", "counted", "seen"))
    recent = ("metric_map.recent",)

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Add displacements."""
        recalled = circuit.recall(batch.strips)
        circuit.metric_map.partial_fit(circuit.place, recalled.odour, recalled.heading)

    def finish(self, circuit: Circuit) -> None:
        """Solve for positions and offsets, and let each place cell keep to one place."""
        circuit.metric_map.solve()
        edges = Atlas.of(circuit.charts.centres).edges
        circuit.place.disambiguate(circuit.readout.intercepts, circuit.readout.phases, edges)


@dataclass(frozen=True)
class AfferentStage(Stage):
    """The cells' afferents from sight, instructed by recalled smell and corrected heading."""

    name = "afferents"
    sums = tuple(
        f"{cells}.afferents.{name}" for cells in ("place", "heading") for name in ("association", "activity")
    )

    def learn(self, circuit: Circuit, batch: Batch) -> None:
        """Associate active charts with the rates that smell and heading demand."""
        excited, heading, odour = circuit.recall(batch.strips)
        corrected = heading + circuit.metric_map(circuit.place, odour).offset
        circuit.place.afferents.partial_fit(excited, circuit.place.instruct(excited, odour))
        circuit.heading.afferents.partial_fit(excited, circuit.heading.tuning(corrected))


STAGES: tuple[Stage, ...] = (
    CodeStage(),
    ChartStage(),
    OlfactionStage(),
    CellStage(),
    MetricMapStage(),
    AfferentStage(),
)
"""Stages in order; each stands on what those before it have fixed."""
