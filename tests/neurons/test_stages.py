from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import pytest
import torch
from torch import Tensor, nn

from neurons.circuit import Circuit
from neurons.errors import NeuronsError
from neurons.merging import forked, merge
from neurons.network import Network
from neurons.stages import (
    SMELL_FIRST,
    STAGES,
    AfferentStage,
    Batch,
    ChartStage,
    CodedStage,
    CodeStage,
    OlfactionStage,
    RecallStage,
    Stage,
    StripStage,
    chosen,
    joined,
)

EPOCH = 200


class Odometer(nn.Module):
    """Mean smell, and how much it changes from view to view."""

    total: Tensor
    change: Tensor
    last: Tensor
    mean: Tensor

    def __init__(self, odorants: int) -> None:
        super().__init__()
        self.register_buffer("total", torch.zeros(odorants, dtype=torch.double))
        self.register_buffer("change", torch.zeros((), dtype=torch.double))
        self.register_buffer("last", torch.full((1, odorants), torch.nan))
        self.register_buffer("mean", torch.full((odorants,), torch.nan))


@dataclass(frozen=True)
class ToyStage(StripStage):
    """Sums of smells, and of their changes along the walk."""

    name = "toy"
    in_order = True
    sums = ("odometer.total", "odometer.change")
    recent = ("odometer.last",)
    epochs: int = 2

    def layers(self, circuit: Circuit) -> dict[str, nn.Module]:
        return {"odometer": Odometer(circuit.place.centres.shape[1])}

    def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:
        odometer = odometer_of(circuit)
        walk = torch.cat([odometer.last, batch.log_odours])
        odometer.total += batch.log_odours.sum(dim=0)
        odometer.change += walk.diff(dim=0).abs().nansum()
        odometer.last = walk[-1:].clone()

    def finish(self, circuit: Circuit) -> None:
        odometer = odometer_of(circuit)
        odometer.mean = (odometer.total / (self.epochs * EPOCH)).float()


def odometer_of(circuit: Circuit) -> Odometer:
    found = circuit.get_submodule("odometer")
    assert isinstance(found, Odometer)
    return found


def with_toy(at: int) -> tuple[Stage[Any], ...]:
    return (*STAGES[:at], ToyStage(), *STAGES[at:])


def network(stages: tuple[Stage[Any], ...] = STAGES, *, most_charts: int = 40) -> Network:
    return Network(
        30,
        3,
        charts=40,
        most_charts=most_charts,
        components=8,
        place_cells=10,
        heading_cells=6,
        epoch=EPOCH,
        stages=stages,
        generator=torch.Generator().manual_seed(0),
    )


def stream(count: int, seed: int) -> tuple[Tensor, Tensor]:
    rng = torch.Generator().manual_seed(seed)
    pose = (0.1 * torch.randn(count, 3, generator=rng)).cumsum(dim=0)
    core = torch.column_stack([pose[:, :2].sin(), pose[:, 2].cos(), pose[:, 2].sin()])
    mixing = torch.linalg.qr(torch.randn(30, 4, generator=torch.Generator().manual_seed(9))).Q
    return core @ mixing.T, torch.column_stack([core[:, :2], core[:, 0] + core[:, 1]])


def learn_until(network: Network, name: str) -> None:
    """Learn until the next view falls into a stage."""
    while network.views_seen < network.begins(name):
        network.learn(*stream(50, int(network.views_seen)))


@pytest.fixture(scope="module")
def toy() -> Network:
    """A network at the beginning of the toy's stage."""
    found = network(with_toy(3))
    learn_until(found, "toy")
    return found


def test_a_stage_more_is_a_class_and_a_line(toy: Network) -> None:
    grown, plain = deepcopy(toy), network()
    seen = [stream(50, 1000 + number) for number in range(2 * EPOCH // 50)]
    for views in seen:
        assert grown.stage.name == "toy"
        grown.learn(*views)
    assert grown.stage.name == "cells"
    learn_until(plain, "cells")
    for seed in range(2 * EPOCH // 50):
        for each in (grown, plain):
            each.learn(*stream(50, seed))
    smells = torch.cat([views[1] for views in seen]).double()
    odometer = odometer_of(grown)
    torch.testing.assert_close(odometer.mean.double(), smells.mean(dim=0), atol=1e-6, rtol=1e-5)
    torch.testing.assert_close(odometer.change, smells.diff(dim=0).abs().sum(), atol=1e-3, rtol=1e-5)
    left = {name for name in grown.state_dict() if name.startswith("odometer.")}
    assert grown.epochs == plain.epochs + 2
    for name, value in plain.state_dict().items():
        if name not in {"views_seen", "stage_index"}:
            assert torch.equal(grown.get_buffer(name).nan_to_num(), value.nan_to_num()), name
    assert grown.state_dict().keys() - plain.state_dict().keys() == left
    blank = network(with_toy(3))
    blank.load_state_dict(grown.state_dict())
    assert torch.equal(odometer_of(blank).mean, odometer.mean)


def test_its_sums_are_shared_and_a_jump_is_told_to_it(toy: Network) -> None:
    whole, here, there = deepcopy(toy), forked(toy), forked(toy)
    for each, seed in ((here, 1), (there, 2)):
        whole.break_sequence()
        for learner in (whole, each):
            learner.learn(*stream(100, seed))
    merge(here, there)
    assert here.views_seen == whole.views_seen
    for name in ToyStage.sums:
        torch.testing.assert_close(here.get_buffer(name), whole.get_buffer(name))
    there.break_sequence()
    assert odometer_of(there).last.isnan().all()
    fresh = forked(there)
    assert not odometer_of(fresh).total.any()
    other = network(with_toy(4))
    with pytest.raises(NeuronsError, match="epoch or stages"):
        merge(here, other)


def test_its_layers_are_made_again_when_charts_are_added() -> None:
    grown = network(with_toy(2), most_charts=80)
    while grown.entered.name != "cells" and len(grown.charts) == 40:
        grown.learn(*stream(50, int(grown.views_seen)))
    assert len(grown.charts) == 80  # a random walk this short closes no loop
    assert grown.stage.name == "charts"
    assert not odometer_of(grown).total.any()
    learn_until(grown, "afferents")
    assert len(grown.charts) == 80


def test_names_and_buffers_are_those_of_the_network() -> None:
    names = [stage.name for stage in STAGES]
    assert names == [
        "code",
        "charts",
        "olfaction",
        "cells",
        "metric_map",
        "corrected_metric_map",
        "afferents",
    ]
    first = [stage.name for stage in SMELL_FIRST]
    assert first == ["smell", *("heading_cells" if name == "cells" else name for name in names)]
    buffers = network().state_dict()
    for stage in {*STAGES, *SMELL_FIRST}:
        assert {*stage.sums, *stage.recent} <= buffers.keys()


def test_place_cells_that_smell_first_are_left_alone_by_what_is_seen() -> None:
    learner = network(SMELL_FIRST)
    learn_until(learner, "code")
    learner.advance_stage()
    assert int(learner.place.initialised) == len(learner.place.centres)
    taught, blank = deepcopy(learner.place), deepcopy(learner.heading.preferred)
    learn_until(learner, "metric_map")
    assert torch.equal(taught.centres, learner.place.centres)
    assert torch.equal(taught.covariances, learner.place.covariances)
    assert not torch.equal(blank, learner.heading.preferred)


@pytest.mark.parametrize("winners", [(12, 4), (20, 2)])
def test_fewer_and_fewer_charts_learn_from_a_view(
    monkeypatch: pytest.MonkeyPatch, winners: tuple[int, int]
) -> None:
    learner, asked = network(), []
    fit = learner.charts.partial_fit

    def spy(codes: Tensor, log_odours: Tensor, *, winners: int, window: float) -> None:
        asked.append(winners)
        fit(codes, log_odours, winners=winners, window=window)

    monkeypatch.setattr(learner.charts, "partial_fit", spy)
    for progress in (0.0, 0.25, 0.5, 0.75, 1.0):
        strips, smells = stream(50, 0)
        batch = Batch(learner.code(strips), smells, progress=progress, window=200.0)
        ChartStage(winners=winners).learn(learner, batch)
    assert (asked[0], asked[-1]) == winners
    assert asked == sorted(asked, reverse=True)
    assert asked[2] == round((winners[0] * winners[1]) ** 0.5)


def test_the_nearest_charts_learn_the_smell_of_a_view(toy: Network) -> None:
    for stage, winners in ((OlfactionStage(), 16), (OlfactionStage(winners=3), 3)):
        learner = deepcopy(toy)
        learner.olfaction.gram.zero_()
        learner.readout.spacing.fill_(1e3)
        strips, smells = stream(1, 0)
        stage.learn(learner, Batch(stage.see(learner, strips), smells, progress=0.5, window=200.0))
        view = torch.cat([learner.code(strips), learner.charts.smell_weight * smells], dim=1)
        nearest = torch.cdist(view, learner.charts.points).argsort()[0, :winners]
        assert learner.olfaction.gram[:, 0, 0].nonzero().flatten().tolist() == sorted(nearest.tolist())


def test_progress_runs_from_the_first_view_of_a_stage_to_its_last() -> None:
    told: list[float] = []

    @dataclass(frozen=True)
    class Listening(CodeStage):
        name = "listening"

        def learn(self, circuit: Circuit, batch: Batch[Tensor]) -> None:  # noqa: ARG002
            told.append(batch.progress)
            assert batch.window == EPOCH

    learner = network((CodeStage(epochs=1), Listening(epochs=2)))
    for seed in range(8):
        learner.learn(*stream(100, seed))
    assert told == [0.25, 0.5, 0.75, 1, 1, 1]  # the last stage goes on for ever


def test_a_stage_says_what_it_is() -> None:
    assert AfferentStage() == AfferentStage(epochs=1) != AfferentStage(epochs=2)
    with pytest.raises(TypeError, match="abstract"):
        Stage()  # type: ignore[abstract]


def test_batches_put_together_are_chosen_from_by_view(toy: Network) -> None:
    strips, _ = stream(60, 3)
    views = torch.tensor([7, 50, 7])
    for look in (StripStage.see, CodedStage.see, RecallStage.see):
        whole = joined([look(toy, batch) for batch in strips.split(20)])
        torch.testing.assert_close(chosen(whole, views), look(toy, strips[views]), equal_nan=True)
