from dataclasses import replace
from typing import Any

import pytest
import torch

from neurons.atlas.ambiguity import far_share, poses_told
from neurons.atlas.atlas import Atlas
from neurons.atlas.metric_map import SUMS
from neurons.circuit import Circuit
from neurons.network import Network
from neurons.stages import STAGES, OlfactionStage, Stage

EPOCH = 400


def newborn(stages: tuple[Stage[Any], ...] = STAGES) -> Network:
    return Network(
        30,
        3,
        charts=60,
        most_charts=60,
        components=8,
        place_cells=10,
        heading_cells=6,
        epoch=EPOCH,
        stages=stages,
        generator=torch.Generator().manual_seed(0),
    )


@pytest.fixture
def network() -> Network:
    return newborn()


def stream(count: int, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
    """Views of a cylinder in 30 dimensions, and smells that depend on where along and across it they are."""
    rng = torch.Generator().manual_seed(seed)
    place = 2 * torch.rand(count, 2, generator=rng) - 1
    turn = 2 * torch.pi * torch.rand(count, generator=rng)
    core = torch.column_stack([place, turn.cos(), turn.sin()])
    mixing = torch.linalg.qr(torch.randn(30, 4, generator=torch.Generator().manual_seed(9))).Q
    return core @ mixing.T, torch.column_stack([place, place.sum(dim=1)])


def test_each_layer_learns_in_its_own_period_and_is_then_fixed(network: Network) -> None:
    own = {
        "code": "code.",
        # what will stand on the charts is of their size, and blank
        "charts": ("charts.", "olfaction.", "readout."),
        "olfaction": "olfaction.",
        "cells": ("place.", "heading."),
        "metric_map": "metric_map.",
        "corrected_metric_map": "metric_map.",
        "afferents": ("place.afferents.", "heading.afferents."),
    }
    for number, stage in enumerate(STAGES):
        assert network.stage == stage
        network.learn(*stream(50, number))  # what came before is settled with the first views of a stage
        before = {name: value.clone() for name, value in network.state_dict().items()}
        for batch in range(stage.epochs * EPOCH // 50 - 1):
            network.learn(*stream(50, 100 * number + batch))
        changed = {
            name
            for name, value in network.state_dict().items()
            if not torch.equal(value.nan_to_num(), before[name].nan_to_num())
        }
        assert changed - {"views_seen"}
        assert all(name.startswith(own[stage.name]) for name in changed - {"views_seen"})


def test_the_guard_is_told_what_the_network_knows(network: Network) -> None:
    assert [name for name, figure in network.told._asdict().items() if figure == figure] == [  # noqa: PLR0124
        "connected",
        "views_per_chart",
        "dimension",
    ]
    network.agreement = torch.tensor([0.9, 0.8])
    network.connected.logical_not_()
    network.metric_map.cross_validated_r2 = torch.tensor([0.7, 0.6])
    network.ambiguity = torch.tensor([0.5, 0.4])
    network.votes = torch.tensor([0.1, 0.2, 0.7, 0.0, 0.0])
    network.felt.fill_(0.25)
    assert network.told == pytest.approx((0.9, 0.8, True, 0.6, 0.5, 0.4, EPOCH / 60, 3, 0.7, 0.25))


def test_an_unfinished_network_is_not_to_be_trusted(network: Network) -> None:
    network.agreement = torch.tensor([1.0, 0.9999])
    answers = ("heading", "place", "metric", "position")

    def reasons() -> dict[str, str]:
        return {answer: getattr(network, f"{answer}_diagnosis")() for answer in answers}

    for stage in STAGES[:-1]:
        network.views_seen.fill_(network.begins(stage.name))
        assert all(f"{stage.name!r} stage" in reason for reason in reasons().values())
    network.views_seen.fill_(network.begins(STAGES[-1].name))
    untried = network.metric_map.diagnosis()
    assert reasons() == {"heading": "", "place": "", "metric": untried, "position": untried}
    network.metric_map.cross_validated_r2.fill_(0.95)
    assert not any(reasons().values())
    network.ambiguity = torch.tensor([0.5, 0.0])
    told = network.told
    alike = network.guard.poses(told)
    assert alike
    assert reasons() == {
        "heading": alike,
        "place": network.guard.place(told),
        "metric": "",
        "position": alike,
    }


@pytest.mark.parametrize(("most", "charts"), [(100, 100), (500, 120), (60, 60)])
@pytest.mark.parametrize("better", [False, True])
def test_charts_are_added_while_they_do_not_agree(
    network: Network, monkeypatch: pytest.MonkeyPatch, most: int, charts: int, *, better: bool
) -> None:
    found = torch.tensor([1.0, 0.9999 if better else 0.99])
    orient = OlfactionStage.orient

    def disagree(stage: OlfactionStage, circuit: Circuit) -> None:
        orient(stage, circuit)
        circuit.agreement = found.clone()
        circuit.connected.zero_()

    monkeypatch.setattr(OlfactionStage, "orient", disagree)
    network.most_charts = most
    while network.stage.name != "cells":
        network.learn(*stream(50, int(network.views_seen)))
    grown = network.views_seen.clone()
    network.learn(*stream(50, 1))
    if better or charts == 60:
        assert len(network.charts) == 60
        assert (network.stage.name, int(network.views_seen)) == ("cells", int(grown) + 50)
        return
    assert len(network.charts) == charts
    assert (network.stage.name, int(network.views_seen)) == ("charts", network.begins("charts") + 50)
    assert network.entered.name == "charts"
    assert network.agreement.isnan().all()
    found[1] = 0.9999
    while network.views_seen < network.begins("afferents") + 100:
        network.learn(*stream(50, int(network.views_seen)))
    assert len(network.charts) == charts
    assert network.heading_diagnosis() == ""
    assert {len(network.place.afferents.weights), len(network.heading.afferents.weights)} == {charts}


def grown(stages: tuple[Stage[Any], ...], until: str) -> Network:
    found = newborn(stages)
    while found.stage.name != until:
        found.learn(*stream(50, int(found.views_seen)))
    found.advance_stage()
    return found


def test_a_connection_is_learnt_where_charts_do_not_agree() -> None:
    bare = [replace(each, connection=None) if isinstance(each, OlfactionStage) else each for each in STAGES]
    learnt, plain = (grown(stages, "cells") for stages in (STAGES, tuple(bare)))
    assert plain.atlas_diagnosis()
    assert not plain.connected
    assert learnt.connected
    assert learnt.agreement[1] > plain.agreement[1]
    assert learnt.agreement[0] == plain.agreement[0]
    assert not torch.equal(learnt.readout.turning, plain.readout.turning)


def test_charts_lie_apart_as_they_compete_and_the_metric_map_begins_again() -> None:
    told = grown(STAGES, "olfaction")
    assert told.charts.smells.any()
    assert torch.equal(told.readout.spacing, Atlas.of(told.charts.points).spacing)
    again = grown(STAGES, "corrected_metric_map").metric_map
    assert not any(again.get_buffer(name).any() for name in SUMS)


def test_ambiguity_is_told_when_places_are_known() -> None:
    assert grown(STAGES, "corrected_metric_map").ambiguity.isnan().all()
    found = grown(STAGES, "afferents")
    smells, edges = found.readout.intercepts, Atlas.of(found.charts.points).edges
    heading = found.metric_map(found.place, found.heading, smells, found.readout.phases).heading
    told = (poses_told(smells, heading, edges), found.charts.centres)
    assert found.ambiguity.isfinite().all()
    assert found.ambiguity.tolist() == pytest.approx([far_share(each, edges) for each in told])
