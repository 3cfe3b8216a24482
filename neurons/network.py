"""The network: a circuit that learns in stages."""

from bisect import bisect_right
from collections.abc import Sequence
from itertools import accumulate
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.circuit import Circuit
from neurons.guard import Agreement
from neurons.stages import STAGES, Batch, ChartStage, Stage


class Network(Circuit):
    """A circuit whose layers learn one after the other.

    Each layer learns during its own critical period, and those before it are then fixed: first the code, then
    the charts; then each chart learns how smell changes across it; then the charts agree on a compass, the
    cells share out what is recalled; from the order of views the metric map learns where places are and by
    how much the compass is off there, and once more with the compass corrected; and at last the cells'
    afferents from sight are learnt. From the third stage on, all but what the cells compete for are sums.
    While the guard says that the atlas is too coarse, the number of charts is doubled, and all that follows
    the code is learnt again.

    Parameters
    ----------
    features, odorants, **circuit
        As for `neurons.circuit.Circuit`; without odorants, `stages` must be `SIGHT_ALONE`.
    epoch
        Views in an epoch, the unit of the critical periods.
    stages
        In order; one more is one more in the list.
    """

    def __init__(
        self,
        features: int,
        odorants: int,
        *,
        epoch: int,
        stages: Sequence[Stage[Any]] = STAGES,
        **circuit: Any,
    ) -> None:
        super().__init__(features, odorants, **circuit)
        self.epoch, self.odorants = epoch, odorants
        self.stages = tuple(stages)
        self._index = {stage.name: index for index, stage in enumerate(self.stages)}
        self._epochs_before = [0, *accumulate(stage.epochs for stage in self.stages)]
        self.views_seen: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.stage_index: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self._make_layers(0)

    @property
    def stage(self) -> Stage[Any]:
        """The stage that the next view falls into; the last one never ends."""
        epochs = int(self.views_seen) // self.epoch
        return self.stages[bisect_right(self._epochs_before, epochs, hi=len(self.stages)) - 1]

    @property
    def entered(self) -> Stage[Any]:
        """The stage before which everything is fixed: `stage`, or the one that ends with the next view."""
        return self.stages[int(self.stage_index)]

    @property
    def charted(self) -> bool:
        """Whether its charts have tiled the views."""
        return int(self.stage_index) > self._index[ChartStage.name]

    @property
    def epochs(self) -> int:
        """Epochs of all stages together."""
        return self._epochs_before[-1]

    def begins(self, name: str) -> int:
        """How many views come before a stage."""
        return self.epoch * self._epochs_before[self._index[name]]

    def see(self, strips: Float[Tensor, "views features"]) -> Any:
        """Show strips to the layers that are fixed by now: what the present stage learns from."""
        self.advance_stage()
        return self.stage.see(self, strips)

    def learn(
        self, strips: Float[Tensor, "views features"], log_odours: Float[Tensor, "views odorants"]
    ) -> None:
        """Let the layer whose period it is learn from a batch."""
        self.learn_seen(self.see(strips), log_odours)

    def learn_seen(self, seen: Any, log_odours: Float[Tensor, "views odorants"]) -> None:
        """Let the layer whose period it is learn from a batch that `see` has made of strips."""
        stage = self.stage
        self.views_seen += len(log_odours)
        progress = (int(self.views_seen) - self.begins(stage.name)) / max(1, stage.epochs * self.epoch)
        stage.learn(self, Batch(seen, log_odours, min(1.0, progress), window=float(self.epoch)))

    def advance_stage(self) -> None:
        """Finish the stages before the present one, each once."""
        while int(self.stage_index) < self._index[self.stage.name]:
            finished = self.entered
            self.stage_index += 1
            again = finished.finish(self)
            if again is not None:
                self.stage_index.fill_(self._index[again])
                self.views_seen.fill_(self.begins(again))
                self._make_layers(self._index[again] + 1)

    def break_sequence(self) -> None:
        """Forget the last views: the next one does not follow them."""
        for stage in self.stages:
            for name in stage.recent:
                self.get_buffer(name).fill_(torch.nan)

    @property
    def told(self) -> Agreement:
        """What the guard judges by."""
        signs, phases = self.agreement.tolist()
        foretold = float(self.metric_map.cross_validated_r2.min())
        ambiguous, aliased = self.ambiguity.tolist()
        views_per_chart = self.epoch / len(self.charts)
        connected = bool(self.connected)
        return Agreement(
            signs,
            phases,
            connected,
            foretold,
            ambiguous,
            aliased,
            views_per_chart,
            *self.dimension,
            float(self.felt),
        )

    def heading_diagnosis(self) -> str:
        """Say why headings cannot be trusted, or nothing when they can."""
        return self.unready or self.guard.heading(self.told)

    def place_diagnosis(self) -> str:
        """Say why places cannot be trusted, or nothing when they can."""
        return self.unready or self.guard.place(self.told)

    def metric_diagnosis(self) -> str:
        """Say why there is no metric map, or nothing when there is one."""
        return self.unready or self.metric_map.diagnosis()

    def position_diagnosis(self) -> str:
        """Say why positions on the metric map cannot be trusted, or nothing when they can."""
        return self.metric_diagnosis() or self.guard.poses(self.told)

    @property
    def unready(self) -> str:
        """Why nothing that stands on its charts is to be trusted; empty when it may be."""
        return self.unfinished or self.noseless or self.stage.diagnosis(self)

    @property
    def unfinished(self) -> str:
        """In which stage it still learns; empty in the last."""
        if self.stage == self.stages[-1]:
            return ""
        return f"it is still in its {self.stage.name!r} stage; show it more views"

    @property
    def noseless(self) -> str:
        """What sight alone cannot tell; empty where there is a second sense."""
        if self.odorants:
            return ""
        return (
            "it was given sight alone, which does not tell place from heading: both populations need a "
            "second sense that knows place but not heading; give odours, or another signal of that kind"
        )

    def _make_layers(self, first: int) -> None:
        for stage in self.stages[first:]:
            for name, layer in stage.layers(self).items():
                self.add_module(name, layer.to(self.views_seen.device))
