from copy import deepcopy

import pytest
import torch
from torch import Tensor

from neurons.atlas.metric_map import MetricMap
from neurons.layers.charts import Charts
from neurons.network import Network
from neurons.renewal import RenewalStage
from neurons.rooms import Rooms
from neurons.stages import STAGES, OlfactionStage
from tests.neurons.test_rooms import BATCH, EPOCH, FEATURES, ODORANTS, begin, walk

SIZES = {"charts": 120, "most_charts": 120, "components": 6, "place_cells": 10, "heading_cells": 6}


def grown(time_constant: float) -> Network:
    stages = (*STAGES, RenewalStage(time_constant=time_constant))
    network = Network(
        FEATURES, ODORANTS, **SIZES, epoch=EPOCH, stages=stages, generator=torch.Generator().manual_seed(0)
    )
    for day in range(network.epochs):
        strips, smells = walk(0, EPOCH, day)
        for start in range(0, EPOCH, BATCH):
            network.learn(strips[start : start + BATCH], smells[start : start + BATCH])
    return network


@pytest.fixture(scope="module")
def network() -> Network:
    return grown(float(EPOCH))


def live(network: Network, days: int, shift: float) -> None:
    for day in range(days):
        strips, smells = walk(0, EPOCH, 50 + day)
        for start in range(0, EPOCH, BATCH):
            network.learn(strips[start : start + BATCH], smells[start : start + BATCH] + shift)


@pytest.mark.near_guard  # what is forgotten does not depend on what is trusted
def test_it_takes_no_epoch_and_never_ends(network: Network) -> None:
    assert network.stage.name == "renewal"
    assert not network.unfinished
    assert network.epochs == sum(stage.epochs for stage in STAGES)


def test_what_a_room_smells_of_now_replaces_what_it_smelt_of(network: Network) -> None:
    living = deepcopy(network)
    strips = walk(0, 200, 99)[0]
    live(living, 4, 2.0)
    moved = (living.recall(strips).odour - network.recall(strips).odour).mean()
    assert moved == pytest.approx(2.0, abs=0.3)


def test_sums_fade_to_those_of_the_last_views(network: Network) -> None:
    living = deepcopy(network)
    live(living, 6, 0.0)
    # Σ e^(−n/τ) over batches: what a time constant of an epoch leaves in the end
    left = BATCH / (1 - torch.tensor(-BATCH / EPOCH).exp())
    assert float(living.place.afferents.activity.sum()) == pytest.approx(float(left), rel=0.02)


def test_the_compass_stays_where_it_was(network: Network) -> None:
    living = deepcopy(network)
    strips = walk(0, 200, 98)[0]
    live(living, 3, 0.0)
    turned = living.recall(strips).heading - network.recall(strips).heading
    assert torch.atan2(turned.sin(), turned.cos()).abs().median() < 0.2


@pytest.mark.near_guard  # it is asked of frames, and nothing is trusted
def test_what_charts_know_of_smell_stays_while_their_axes_turn(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    living = deepcopy(network)
    charts = torch.arange(len(living.charts))[:, None]
    seen = living.charts.centres + 0.1 * living.charts.tangents.sum(dim=1)

    def told() -> Tensor:
        intercepts, jacobians = living.olfaction.solve()
        coordinates = living.charts.coordinates(seen, charts)[:, 0]
        return intercepts + torch.einsum("kd,kdo->ko", coordinates, jacobians)

    before = told()
    monkeypatch.setattr(OlfactionStage, "learn", lambda *_: None)
    for name in ("partial_fit", "freeze"):  # either turns axes round
        monkeypatch.setattr(Charts, name, lambda self, *_, **__: self.tangents.neg_())
    for _ in range(2):  # the second batch comes with an agreement
        living.learn(*walk(0, BATCH, 94))
        torch.testing.assert_close(told(), before, rtol=1e-3, atol=1e-3)
        living.get_buffer("renewed.views").fill_(EPOCH // RenewalStage.agreements - 1)


def test_charts_agree_anew_four_times_as_often_as_places_are_laid_out(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    living, told = deepcopy(network), list[str]()
    monkeypatch.setattr(MetricMap, "check", lambda _: told.append("checked"))
    monkeypatch.setattr(MetricMap, "solve", lambda *_: told.append("laid out"))
    strips, smells = walk(0, EPOCH, 97)
    agreed = 0
    for start in range(0, EPOCH, BATCH):
        phases = living.readout.phases.clone()
        living.learn(strips[start : start + BATCH], smells[start : start + BATCH])
        agreed += not torch.equal(living.readout.phases, phases)
    assert agreed == 4
    assert told == ["checked", "checked", "checked", "laid out"]
    assert int(living.get_buffer("renewed.views")) == 0
    assert int(living.metric_map.seen) == 0


def test_what_is_new_on_a_walk_is_of_the_room_and_after_a_jump_of_another(network: Network) -> None:
    for jump, known in ((False, 1), (True, 2)):
        rooms = Rooms(begin, first=deepcopy(network))
        rooms.learn(*walk(0, BATCH, 95))
        for day in range(8):  # until nearly all that it has just seen is strange
            rooms.learn(*walk(1, BATCH, day), jump=jump and not day)
        assert bool(rooms[0].stage.diagnosis(rooms[0])) is not jump
        assert len(rooms) == known
        assert int(rooms.present) == known - 1
        assert float(rooms.strangeness) > rooms.majority


@pytest.mark.near_guard  # what the guard says of it is not asked
def test_a_room_that_has_changed_is_doubted_until_walking_confirms_what_is_known(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    living = deepcopy(network)
    live(living, 1, 0.0)
    living.metric_map.cross_validated_r2.fill_(0.9)
    living.stage.doubt(living)
    assert int(living.metric_map.seen) == 0  # what was walked before confirms nothing
    for told in (living.heading_diagnosis, living.place_diagnosis, living.metric_diagnosis):
        assert "the room has changed" in told()
    for told_by_walking in (torch.nan, 0.9):
        confirmed = torch.full((2,), told_by_walking)
        monkeypatch.setattr(MetricMap, "check", lambda self, r2=confirmed: self.cross_validated_r2.copy_(r2))
        monkeypatch.setattr(MetricMap, "solve", lambda *_: None)
        live(living, 1, 0.0)
        assert (not living.stage.diagnosis(living)) is bool(confirmed.isfinite().all())
