"""The stages of learning, critical periods one after the other: what each teaches, how long, from what."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, ClassVar, Generic, TypeVar

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from neurons.atlas.ambiguity import far_share, poses_told
from neurons.atlas.atlas import Atlas
from neurons.atlas.connection import LearntConnection
from neurons.atlas.heading_axis import heading_axes
from neurons.atlas.metric_map import SUMS
from neurons.atlas.synchronisation import synchronise
from neurons.circuit import Circuit
from neurons.errors import NeuronsError
from neurons.layers.readout import Recalled

Seen = TypeVar("Seen", Tensor, Recalled)
"""Views as a stage sees them: rows of a tensor, or what the atlas recalls."""


def joined(parts: Sequence[Seen]) -> Seen:
    """Put batches of the same kind together."""
    if isinstance(parts[0], Tensor):
        return torch.cat(list(parts))
    return Recalled(*(torch.cat(part) for part in zip(*parts, strict=True)))


def chosen(seen: Seen, views: Int[Tensor, "_"]) -> Seen:
    """Take some of the views."""
    if isinstance(seen, Tensor):
        return seen.index_select(0, views)
    return Recalled(*(part.index_select(0, views) for part in seen))


@dataclass(frozen=True)
class Batch(Generic[Seen]):
    """Views that are learnt together, as the stage sees them, and what was smelt there."""

    seen: Seen
    log_odours: Float[Tensor, "views odorants"]
    progress: float
    """How much of the stage is over with this batch, from 0 to 1."""
    window: float
    """Views in an epoch: what a running mean remembers."""


@dataclass(frozen=True)
class Stage(ABC, Generic[Seen]):
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
    follows
        Whether it takes what is new on a walk for a change of the room, and not for another room.
    """

    name: ClassVar[str]
    in_order: ClassVar[bool] = False
    sums: ClassVar[tuple[str, ...]] = ()
    recent: ClassVar[tuple[str, ...]] = ()
    follows: ClassVar[bool] = False
    epochs: int = 1

    def layers(self, circuit: Circuit) -> dict[str, nn.Module]:  # noqa: ARG002
        """Make layers of this stage alone, by names that the circuit lacks; again when charts are added."""
        return {}

    @staticmethod
    @abstractmethod
    def see(circuit: Circuit, strips: Float[Tensor, "views features"]) -> Seen:
        """Pass the retina's strips through layers that are fixed by now, to what this stage learns from.

        Stages that share this method see the same, and `fit` shows it to them without making it again.
        """

    @abstractmethod
    def learn(self, circuit: Circuit, batch: Batch[Seen]) -> None:
        """Let its layers learn from a batch."""

    def finish(self, circuit: Circuit) -> str | None:  # noqa: ARG002
        """Fix what was learnt; give the name of an earlier stage to go back to it."""
        return None

    def doubt(self, circuit: Circuit) -> None:
        """Take note that most of what is seen is new, in a stage that follows the room."""

    def diagnosis(self, circuit: Circuit) -> str:  # noqa: ARG002
        """Say why what was learnt is not to be trusted at present, or nothing when it is."""
        return ""


@dataclass(frozen=True)
class StripStage(Stage[Tensor]):
    """A stage that learns from the retina's strips themselves."""

    @staticmethod
    def see(circuit: Circuit, strips: Float[Tensor, "views features"]) -> Tensor:  # noqa: ARG004
        """Give the strips as they are."""
        return strips


@dataclass(frozen=True)
class CodedStage(Stage[Tensor]):
    """A stage that learns from codes."""

    @staticmethod
    def see(circuit: Circuit, strips: Float[Tensor, "views features"]) -> Tensor:
        """Give the principal components of the strips."""
        codes: Tensor = circuit.code(strips)
        return codes


@dataclass(frozen=True)
class RestStage(CodedStage):
    """Nothing more is learnt: sight alone has charts, and nothing that tells cells places and headings."""

    name = "rest"

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        """Let the views pass."""


@dataclass(frozen=True)
class RecallStage(Stage[Recalled]):
    """A stage that learns from what the atlas recalls."""

    @staticmethod
    def see(circuit: Circuit, strips: Float[Tensor, "views features"]) -> Recalled:
        """Give charts, heading and smell at the sight of the strips."""
        return circuit.recall(strips)


@dataclass(frozen=True)
class SmellStage(StripStage):
    """Place cells share out the smells themselves: an animal whose eyes are still closed."""

    name = "smell"
    epochs: int = 2

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        """Let the place cells compete."""
        circuit.place.compete(batch.log_odours, window=batch.window)


@dataclass(frozen=True)
class CodeStage(StripStage):
    """Principal components of the retina's strips."""

    name = "code"
    epochs: int = 4

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        """Take a step of Sanger's rule."""
        circuit.code.partial_fit(batch.seen)

    def finish(self, circuit: Circuit) -> None:
        """Leave a code that has grown as many components as it needs to tell views as well as before."""
        if int(circuit.code.fixed):
            circuit.cut_code()


@dataclass(frozen=True)
class ChartStage(CodedStage):
    """Charts compete for codes, until they tile the manifold of views.

    Parameters
    ----------
    winners
        Charts that learn from a view, at the beginning and at the end: many unfold the tiling, few refine it.
    widened
        From which progress on charts have more tangents than they may keep. Before, many learn from a view,
        and what a chart learns spans more than its own neighbourhood.
    """

    name = "charts"
    epochs: int = 6
    winners: tuple[int, int] = (12, 4)
    widened: float = 2 / 3

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        """Let the nearest charts learn, fewer and fewer, falling geometrically."""
        if batch.progress > self.widened:
            circuit.widen_charts()
        winners = self.winners_at(batch.progress)
        circuit.charts.partial_fit(batch.seen, batch.log_odours, winners=winners, window=batch.window)

    def winners_at(self, progress: float) -> int:
        """How many charts learn from a view when so much of the stage is over."""
        first, last = self.winners
        return round(float(first * (last / first) ** progress))

    def finish(self, circuit: Circuit) -> None:
        """Freeze the charts, leave them tangents along the manifold, and measure how far apart they lie."""
        circuit.charts.freeze()
        circuit.cut_charts()
        circuit.readout.spacing = Atlas.of(circuit.charts.points).spacing


@dataclass(frozen=True)
class OlfactionStage(CodedStage):
    """Each chart learns how smell changes across it; then the charts agree on a compass.

    Parameters
    ----------
    winners
        Charts that learn the smell of a view: twice those that are read, so that no chart lacks views.
    connection
        What is tried while charts do not agree, before any is added; None leaves them as they are.
    """

    name = "olfaction"
    sums = ("olfaction.gram", "olfaction.cross")
    winners: int = 16
    connection: LearntConnection | None = field(default_factory=LearntConnection)

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        """Add views to the regressions of the charts near them, with Gaussian weights."""
        codes = batch.seen
        nearest = circuit.charts.excite(codes, self.winners, batch.log_odours)
        weight = torch.exp(-0.5 * nearest.squared_distance / circuit.readout.spacing[nearest.chart] ** 2)
        coordinates = circuit.charts.coordinates(codes, nearest.chart)
        circuit.olfaction.partial_fit(nearest.chart, weight, coordinates, batch.log_odours)

    def finish(self, circuit: Circuit) -> str | None:
        """Synchronise the charts; while they do not agree, add some and let all of them learn again."""
        self.orient(circuit)
        if circuit.atlas_diagnosis() and len(circuit.charts) < circuit.most_charts:
            circuit.add_charts()
            return ChartStage.name
        return None

    def orient(self, circuit: Circuit, known: Float[Tensor, "charts"] | None = None) -> None:
        """Let charts agree on a compass; turned as near as can be to headings that are known already."""
        atlas = Atlas.of(circuit.charts.points)
        intercepts, jacobians = circuit.olfaction.solve()
        axes, felt = heading_axes(circuit.charts.tangents, jacobians, atlas)
        circuit.felt.fill_(felt)
        compass = None
        with suppress(NeuronsError):  # no ring closes: `agreement` stays NaN, which `diagnosis` tells
            compass = synchronise(circuit.charts.centres, axes, atlas)
            if self.connection and circuit.guard.atlas(compass.sign_agreement, compass.eigenvalue):
                gradients = circuit.charts.tangents.mT @ jacobians
                refined = self.connection.refine(
                    compass, circuit.charts.centres, gradients, intercepts, atlas
                )
                compass = max(compass, refined, key=lambda either: either.eigenvalue)
            if known is not None:
                compass = compass.turned_to(known)
            circuit.agreement = circuit.agreement.new_tensor([compass.sign_agreement, compass.eigenvalue])
            circuit.connected.fill_(compass.walking is not None)
        circuit.readout.solve(atlas, compass, intercepts, jacobians)


@dataclass(frozen=True)
class CellStage(RecallStage):
    """Place cells share out the recalled smells, head-direction cells the headings."""

    name = "cells"
    epochs: int = 2

    def learn(self, circuit: Circuit, batch: Batch[Recalled]) -> None:
        """Let the cells of both populations compete."""
        circuit.place.compete(batch.seen.odour, window=batch.window)
        circuit.heading.compete(batch.seen.heading, window=batch.window)


@dataclass(frozen=True)
class HeadingStage(RecallStage):
    """Head-direction cells share out the headings, beside place cells that have learnt before."""

    name = "heading_cells"
    epochs: int = CellStage.epochs

    def learn(self, circuit: Circuit, batch: Batch[Recalled]) -> None:
        """Let the head-direction cells compete."""
        circuit.heading.compete(batch.seen.heading, window=batch.window)


@dataclass(frozen=True)
class MetricMapStage(RecallStage):
    """Where places are, and by how much the compass is off there, from the order of views."""

    name = "metric_map"
    in_order = True
    sums = tuple(f"metric_map.{name}" for name in SUMS)
    recent = ("metric_map.recent",)

    def learn(self, circuit: Circuit, batch: Batch[Recalled]) -> None:
        """Add displacements."""
        circuit.metric_map.partial_fit(circuit.place, circuit.heading, batch.seen.odour, batch.seen.heading)

    def finish(self, circuit: Circuit) -> None:
        """Solve for positions and the compass's errors, and forget the sums they were made of."""
        circuit.metric_map.solve(circuit.place)
        circuit.metric_map.begin_again()


@dataclass(frozen=True)
class CorrectedMetricMapStage(MetricMapStage):
    """The metric map once more, on corrected headings: more ways are straight, and all agree better."""

    name = "corrected_metric_map"

    def finish(self, circuit: Circuit) -> None:
        """Solve for positions and what is left of the errors; let each place cell keep to one place."""
        circuit.metric_map.solve(circuit.place)
        edges = Atlas.of(circuit.charts.points).edges
        smells, phases = circuit.readout.intercepts, circuit.readout.phases
        circuit.place.disambiguate(smells, phases, edges)
        headings = circuit.metric_map(circuit.place, circuit.heading, smells, phases).heading
        told = (poses_told(smells, headings, edges), circuit.charts.centres)
        circuit.ambiguity = circuit.ambiguity.new_tensor([far_share(each, edges) for each in told])


@dataclass(frozen=True)
class AfferentStage(RecallStage):
    """The cells' afferents from sight, instructed by recalled smell and corrected heading."""

    name = "afferents"
    sums = tuple(
        f"{cells}.afferents.{name}" for cells in ("place", "heading") for name in ("association", "activity")
    )

    def learn(self, circuit: Circuit, batch: Batch[Recalled]) -> None:
        """Associate active charts with the rates that smell and heading demand."""
        excited, heading, odour = batch.seen.excited, batch.seen.heading, batch.seen.odour
        corrected = circuit.metric_map(circuit.place, circuit.heading, odour, heading).heading
        circuit.place.afferents.partial_fit(excited, circuit.place.instruct(excited, odour))
        circuit.heading.afferents.partial_fit(excited, circuit.heading.tuning(corrected))


STAGES: tuple[Stage[Any], ...] = (
    CodeStage(),
    ChartStage(),
    OlfactionStage(),
    CellStage(),
    MetricMapStage(),
    CorrectedMetricMapStage(),
    AfferentStage(),
)
"""Stages in order; each stands on what those before it have fixed."""

SMELL_FIRST: tuple[Stage[Any], ...] = (
    SmellStage(),
    *(HeadingStage() if isinstance(stage, CellStage) else stage for stage in STAGES),
)
"""The same, but place cells learn before there is anything to see."""

SIGHT_ALONE: tuple[Stage[Any], ...] = (CodeStage(), ChartStage(), RestStage())
"""Without a second sense: an atlas of what is seen, on which no compass and no cell can be taught."""
