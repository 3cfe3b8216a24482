"""Renewal: what a room has taught is forgotten slowly, and learnt from it as it is by now."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import exp

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.circuit import Circuit
from neurons.stages import (
    AfferentStage,
    Batch,
    ChartStage,
    CorrectedMetricMapStage,
    OlfactionStage,
    StripStage,
)


class Clock(nn.Module):
    """Counts views since places were last laid out, and remembers whether the room has ever changed."""

    def __init__(self) -> None:
        super().__init__()
        self.views: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.changed: Tensor = nn.Buffer(torch.zeros((), dtype=torch.bool))


@dataclass(frozen=True)
class RenewalStage(StripStage):
    """The last stage of a map that is to follow a room that changes; it never ends.

    Sums of olfaction and afferents decay to 1/e in `time_constant` views, while charts move to what they
    win. Some times in as many views the charts agree anew, on a compass that is turned to the one before, and
    the walk since tells whether places still lie where they were; once in as many they are laid out anew from
    it. In between all is told as it was. While most of what is seen is new, and until walking has confirmed
    what is known by then, nothing is trusted.

    Parameters
    ----------
    time_constant
        Views. With fewer than the map learnt from, it is learnt from fewer, and as much worse.
    agreements
        How often charts agree in as many views.
    """

    name = "renewal"
    recent = CorrectedMetricMapStage.recent
    follows = True
    epochs: int = 0
    time_constant: float = 17_000.0
    agreements: int = 4

    def layers(self, circuit: Circuit) -> dict[str, nn.Module]:  # noqa: ARG002
        """Make the clock."""
        return {"renewed": Clock()}

    def learn(self, circuit: Circuit, batch: Batch[Float[Tensor, "views features"]]) -> None:
        """Forget a little, add views to what is summed, and let the charts that they win move."""
        count = len(batch.seen)
        for name in (*OlfactionStage.sums, *AfferentStage.sums):
            circuit.get_buffer(name).mul_(exp(-count / self.time_constant))
        codes, recalled = circuit.code(batch.seen), circuit.recall(batch.seen)
        OlfactionStage().learn(circuit, replace(batch, seen=codes))
        told = Batch(recalled, batch.log_odours, batch.progress, batch.window)
        CorrectedMetricMapStage().learn(circuit, told)
        AfferentStage().learn(circuit, told)
        few = ChartStage().winners[1]
        with _taking_sums_along(circuit):
            circuit.charts.partial_fit(codes, batch.log_odours, winners=few, window=self.time_constant)
        clock = circuit.get_buffer("renewed.views")
        before = self._agreements(int(clock))
        clock += count
        if self._agreements(int(clock)) > before:
            self._agree(circuit, anew=int(clock) >= self.time_constant)

    def doubt(self, circuit: Circuit) -> None:
        """Trust nothing until walking has confirmed it anew: what it has confirmed was of another look."""
        circuit.get_buffer("renewed.changed").fill_(value=True)
        circuit.metric_map.begin_again()
        circuit.metric_map.cross_validated_r2.fill_(torch.nan)

    def diagnosis(self, circuit: Circuit) -> str:
        """Say that the room has changed, until walking has confirmed what is known of it."""
        confirmed = bool(circuit.metric_map.cross_validated_r2.isfinite().all())
        if confirmed or not circuit.get_buffer("renewed.changed"):
            return ""
        return (
            "most of what it saw was new: the room has changed, and walking has not confirmed yet what it "
            "knows by now; show it more of the walk, in order"
        )

    def _agreements(self, views: int) -> int:
        return int(views * self.agreements / self.time_constant)

    @staticmethod
    def _agree(circuit: Circuit, *, anew: bool) -> None:
        with _taking_sums_along(circuit):
            circuit.charts.freeze()
        OlfactionStage().orient(circuit, known=circuit.readout.phases)
        if anew:
            CorrectedMetricMapStage().finish(circuit)
            circuit.metric_map.begin_again()
            circuit.get_buffer("renewed.views").zero_()
        else:
            circuit.metric_map.check()


@contextmanager
def _taking_sums_along(circuit: Circuit) -> Iterator[None]:
    """Keep what charts know of smell while their frames change."""
    before = circuit.charts.frames
    yield
    circuit.olfaction.carry(circuit.charts.since(before))
