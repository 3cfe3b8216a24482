from copy import deepcopy

import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import Tensor

from neurons.errors import NeuronsError
from neurons.merging import forked, merge
from neurons.network import Network
from neurons.stages import STAGES, Stage

EPOCH = 400
SHARED = [stage for stage in STAGES if stage.sums]
Views = tuple[Tensor, Tensor]


def stream(count: int, seed: int) -> Views:
    """A walk over a cylinder in 30 dimensions, and smells that depend on where along and across it is."""
    rng = torch.Generator().manual_seed(seed)
    pose = (0.1 * torch.randn(count, 3, generator=rng)).cumsum(dim=0)
    core = torch.column_stack([pose[:, :2].sin(), pose[:, 2].cos(), pose[:, 2].sin()])
    mixing = torch.linalg.qr(torch.randn(30, 4, generator=torch.Generator().manual_seed(9))).Q
    return core @ mixing.T, torch.column_stack([core[:, :2], core[:, 0] + core[:, 1]])


def learn(network: Network, views: Views) -> None:
    strips, smells = views
    for some in range(0, len(strips), 50):
        network.learn(strips[some : some + 50], smells[some : some + 50])


def young(**sizes: int) -> Network:
    usual = {
        "charts": 60,
        "most_charts": 60,
        "components": 8,
        "place_cells": 10,
        "heading_cells": 6,
        "epoch": EPOCH,
    }
    return Network(30, 3, **{**usual, **sizes}, generator=torch.Generator().manual_seed(0))


@pytest.fixture(scope="module")
def begun() -> dict[str, Network]:
    """Layers with two batches behind them in each stage."""
    found, network = {}, young()
    for number, stage in enumerate(STAGES):
        learn(
            network,
            stream(network.begins(stage.name) - int(network.views_seen), number) if number else stream(0, 0),
        )
        learn(network, stream(100, 100 + number))
        found[stage.name] = deepcopy(network)
    return found


def differing(one: Network, other: Network, tolerance: float = 0.0) -> set[str]:
    """Names of what differs by more than a fraction of its largest value."""
    names, its = set(), other.state_dict()
    for name, value in one.state_dict().items():
        mine, theirs = (each.double().nan_to_num(nan=7e7) for each in (value, its[name]))
        if (mine - theirs).abs().max() > tolerance * mine.abs().max():
            names.add(name)
    return names


@pytest.mark.parametrize("stage", SHARED, ids=lambda stage: stage.name)
@settings(deadline=None, max_examples=10)
@given(split=st.integers(0, 150), seed=st.integers(0, 99))
def test_halves_are_the_whole(begun: dict[str, Network], stage: Stage, split: int, seed: int) -> None:
    strips, smells = stream(150, seed)
    whole = deepcopy(begun[stage.name])
    merged, *halves = (forked(whole), forked(whole), forked(whole))
    merge(merged, whole)
    for part, half in zip((slice(split), slice(split, None)), halves, strict=True):
        whole.break_sequence()
        learn(whole, (strips[part], smells[part]))
        learn(half, (strips[part], smells[part]))
        merge(merged, half)
    # which half of the evidence of the metric map a view falls to depends on how many came before
    apart = {"metric_map.spread", "metric_map.ahead", "metric_map.shared", "metric_map.counted"}
    assert differing(whole, merged, 1e-5) <= {"metric_map.recent", *apart}
    for name in apart:
        one, other = (each.get_buffer(name).sum(dim=0) for each in (whole, merged))
        torch.testing.assert_close(one, other, atol=1e-9, rtol=1e-5)


@pytest.mark.parametrize("stage", SHARED, ids=lambda stage: stage.name)
@settings(deadline=None, max_examples=10)
@given(views=st.tuples(st.integers(0, 500), st.integers(0, 500)))
def test_commutative_and_nothing_adds_nothing(
    begun: dict[str, Network], stage: Stage, views: tuple[int, int]
) -> None:
    one, other = forked(begun[stage.name]), forked(begun[stage.name])
    ages = [each.views_seen.clone() for each in (one, other)]
    for each, count, seed in zip((one, other), views, (1, 2), strict=True):
        learn(each, stream(min(count, stage.epochs * EPOCH), seed))
    left, right = deepcopy(one), deepcopy(other)
    merge(left, other)
    merge(right, one)
    assert differing(left, right) <= {"metric_map.recent"}
    assert one.metric_map.recent.equal(left.metric_map.recent) or one.metric_map.recent.isnan().any()
    unchanged = deepcopy(left)
    merge(unchanged, forked(begun[stage.name]))
    assert not differing(unchanged, left)
    assert ages == [begun[stage.name].begins(stage.name)] * 2
    assert (
        left.metric_map.seen
        == one.metric_map.seen + other.metric_map.seen - (stage.name == "afferents") * one.metric_map.seen
    )


@pytest.mark.parametrize("stage", SHARED, ids=lambda stage: stage.name)
def test_a_fork_has_learnt_nothing_of_its_stage_and_the_rest_as_well(
    begun: dict[str, Network], stage: Stage
) -> None:
    network = deepcopy(begun[stage.name])
    fork = forked(network)
    assert not differing(network, begun[stage.name])
    assert differing(fork, network) <= {*stage.sums, "views_seen", "metric_map.recent"}
    assert all(not fork.get_buffer(name).any() for name in stage.sums)
    assert fork.metric_map.recent.isnan().all()
    assert fork.views_seen == network.begins(stage.name)
    assert fork.stage == stage


def test_many_views_end_a_stage_but_no_other(begun: dict[str, Network]) -> None:
    crowd = [forked(begun["olfaction"]) for _ in range(4)]
    for seed, each in enumerate(crowd):
        learn(each, stream(EPOCH, seed))
        assert each.stage.name == "cells"
    first, *others = crowd
    for each in others:
        merge(first, each)
    assert first.views_seen == first.begins("cells")
    endless = [forked(begun["afferents"]) for _ in range(4)]
    for each in endless:
        learn(each, stream(EPOCH, 0))
        merge(endless[0], each) if each is not endless[0] else None
    assert endless[0].views_seen == first.begins("afferents") + 4 * EPOCH


def test_what_cannot_be_added_up_is_refused(begun: dict[str, Network]) -> None:
    for stage in set(STAGES) - set(SHARED):
        with pytest.raises(NeuronsError, match=f"'{stage.name}' stage, in which units compete"):
            forked(begun[stage.name])
        with pytest.raises(NeuronsError, match="units compete"):
            merge(deepcopy(begun[stage.name]), begun[stage.name])
    smelling = deepcopy(begun["olfaction"])
    with pytest.raises(NeuronsError, match="'olfaction' stage and the other in its 'metric_map'"):
        merge(smelling, begun["metric_map"])
    for sizes in ({"charts": 61}, {"place_cells": 11}, {"epoch": 401}):
        with pytest.raises(NeuronsError, match="differ in views, odorants"):
            merge(deepcopy(smelling), young(**sizes))
    for name in ("charts.centres", "code.weight", "readout.spacing"):
        other = deepcopy(smelling)
        other.get_buffer(name)[-1].mul_(1.001)
        with pytest.raises(NeuronsError, match=f"same charts: {name} differs"):
            merge(smelling, other)
    assert not differing(smelling, begun["olfaction"])


def test_copies_made_where_a_stage_begins_merge_with_or_without_views(begun: dict[str, Network]) -> None:
    fresh = deepcopy(begun["charts"])
    learn(fresh, stream(fresh.begins("olfaction") - int(fresh.views_seen), 5))
    other = deepcopy(fresh)
    learn(other, stream(100, 6))
    idle = deepcopy(fresh)
    merge(idle, other)
    assert differing(idle, other) <= {"metric_map.recent"}
