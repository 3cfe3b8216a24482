from collections.abc import Callable
from copy import deepcopy

import pytest
import torch
from torch import Tensor

from neurons.errors import NeuronsError
from neurons.layers.sanger import Sanger
from neurons.network import Network
from neurons.rooms import NOWHERE, Rooms

EPOCH, BATCH, FEATURES, ODORANTS = 600, 20, 60, 3
Views = tuple[Tensor, Tensor]


def begin(code: Sanger | None, **sizes: int) -> Network:
    usual = {"charts": 120, "most_charts": 120, "components": 6, "place_cells": 10, "heading_cells": 6}
    sizes = {**usual, "epoch": EPOCH, **sizes}
    generator = torch.Generator().manual_seed(0)
    grown = None if code is None else code.grown(sizes["components"], generator=generator)
    return Network(FEATURES, ODORANTS, **sizes, code=grown, generator=generator)


def walk(room: int, count: int, seed: int) -> Views:
    """Views from anywhere on a cylinder that lies elsewhere in the strips of each room, and their smells."""
    rng = torch.Generator().manual_seed(seed)
    pose = torch.pi * (torch.rand(count, 3, generator=rng) - 0.5) * torch.tensor([1.0, 1.0, 2.0])
    core = torch.column_stack([pose[:, :2].sin(), pose[:, 2].cos(), pose[:, 2].sin()])
    drawn = torch.Generator().manual_seed(100 + room)
    mixing = torch.linalg.qr(torch.randn(FEATURES, 5, generator=drawn)).Q
    noise = 0.02 * torch.randn(count, FEATURES, generator=rng)
    smells = torch.column_stack([core[:, :2], core[:, 0] + core[:, 1]])
    strips = core @ mixing[:, :4].T + 2 * mixing[:, 4] + noise
    return strips, smells + 0.05 * torch.randn(count, 3, generator=rng)


def live(rooms: Rooms, room: int, epochs: int, *, seed: int = 0) -> None:
    """Walk through a room once and again, as if it were another day each time."""
    for day in range(epochs):
        strips, smells = walk(room, EPOCH, 1000 * seed + day)
        for start in range(0, EPOCH, BATCH):
            part = slice(start, start + BATCH)
            rooms.learn(strips[part], smells[part], jump=start == 0)


@pytest.fixture(scope="module")
def two() -> tuple[Rooms, Rooms]:
    """A map of one room, and of that and another which was learnt after it."""
    rooms = Rooms(begin)
    epochs = rooms[0].epochs
    live(rooms, 0, epochs)
    one = deepcopy(rooms)
    live(rooms, 1, epochs, seed=1)
    return one, rooms


@pytest.mark.near_guard  # rooms are told whether their maps are trusted or not
def test_a_new_room_begins_beside_the_first_which_stays_as_it_was(two: tuple[Rooms, Rooms]) -> None:
    one, both = two
    assert (len(one), len(both), both.known) == (1, 2, [0, 1])
    before, after = one[0].state_dict(), both[0].state_dict()
    for name, learnt in before.items():
        torch.testing.assert_close(after[name], learnt, rtol=0, atol=0, equal_nan=True)


def test_views_are_of_the_room_that_they_are_like(two: tuple[Rooms, Rooms]) -> None:
    _, both = two
    for room in (0, 1):
        found = both.recognise(walk(room, 400, 77)[0])
        assert (found.room == room).float().mean() > 0.97
        assert found.confidence.median() > 0.95
        assert (found.nearest == room).all()


def test_views_of_no_known_room_are_of_none(two: tuple[Rooms, Rooms]) -> None:
    _, both = two
    strips, smells = walk(2, 400, 78)
    assert (both.recognise(strips).room == NOWHERE).float().mean() > 0.95
    assert both.are_new(strips, smells)
    assert not both.are_new(*walk(1, 400, 79))


def test_a_known_look_that_smells_of_elsewhere_is_another_room(two: tuple[Rooms, Rooms]) -> None:
    _, both = two
    strips, smells = walk(1, 400, 80)
    assert both.are_new(strips, smells + 3.0)


def test_the_code_grows_by_what_it_lacks(two: tuple[Rooms, Rooms]) -> None:
    one, both = two
    first, second = both[0].code, both[1].code
    assert len(first) < len(second) <= len(first) + 6
    torch.testing.assert_close(second.weight[: len(first)], first.weight, rtol=0, atol=0)
    assert both.code is second
    assert one.code is one[0].code


def test_a_heading_cell_prefers_about_the_same_in_every_room(two: tuple[Rooms, Rooms]) -> None:
    _, both = two
    apart = both[1].heading.preferred - both[0].heading.preferred
    assert both[0].heading.preferred.isfinite().all()
    assert torch.atan2(apart.sin(), apart.cos()).abs().median() < torch.pi / 6


def test_what_is_recalled_is_what_the_room_alone_recalls(two: tuple[Rooms, Rooms]) -> None:
    _, both = two
    strips = torch.cat([walk(room, 60, 81 + room)[0] for room in (0, 1)])
    _, parts = both.recall(strips)
    for room, views, recalled in parts:
        alone = both[room].recall(strips[views])
        torch.testing.assert_close(recalled.odour, alone.odour, rtol=1e-4, atol=1e-5)
    assert [room for room, *_ in parts] == [0, 1]


def test_on_return_the_room_goes_on_learning(two: tuple[Rooms, Rooms]) -> None:
    both = deepcopy(two[1])
    seen = int(both[0].views_seen)
    live(both, 0, 1, seed=5)
    assert len(both) == 2
    assert int(both[0].views_seen) == seen + EPOCH
    assert int(both.present) == 0


def test_a_few_strange_views_begin_no_room(two: tuple[Rooms, Rooms]) -> None:
    one = deepcopy(two[0])
    strips, smells = walk(0, EPOCH, 82)
    for start in range(0, EPOCH, 10):
        part = slice(start, start + 10)
        one.learn(strips[part], smells[part], jump=start == 0)
    one.learn(*walk(1, 10, 83))
    assert len(one) == 1
    one.learn(*walk(1, 10, 84), jump=True)
    assert len(one) == 2


def test_smells_alone_tell_the_room_in_the_dark(two: tuple[Rooms, Rooms]) -> None:
    both = deepcopy(two[1])
    both[1].charts.smells += 3.0
    smells = walk(1, 200, 85)[1]
    assert (both.sniff(smells).nearest == 0).float().mean() > 0.9
    assert (both.sniff(smells + 3.0).nearest == 1).float().mean() > 0.9
    assert (both.sniff(smells + 30.0).room == NOWHERE).all()


def test_one_of_them_is_as_if_there_were_no_other(two: tuple[Rooms, Rooms]) -> None:
    both = two[1]
    alone = both.only(1)
    assert len(alone) == 1
    assert alone[0] is both[1]
    assert (alone.recognise(walk(1, 100, 86)[0]).nearest == 0).all()


def test_forks_are_merged_room_by_room(two: tuple[Rooms, Rooms]) -> None:
    both = deepcopy(two[1])
    away = both.forked()
    for room, (here, there) in enumerate(zip(both, away, strict=True)):
        here.learn(*walk(room, BATCH, 87))
        there.learn(*walk(room, BATCH, 88))
    before = [network.place.afferents.activity.clone() for network in both]
    both.merge(away)
    for network, sums, other in zip(both, before, away, strict=True):
        torch.testing.assert_close(network.place.afferents.activity, sums + other.place.afferents.activity)
    with pytest.raises(NeuronsError, match="know 2 and 1 rooms"):
        both.merge(two[0])


def test_rooms_of_given_sizes_are_made_again(two: tuple[Rooms, Rooms]) -> None:
    both = two[1]
    sizes = [
        {"components": len(each.code), "charts": len(each.charts), "tangents": each.charts.dimensions}
        for each in both
    ]
    again = Rooms(begin)
    again.restore(sizes)
    again.load_state_dict(both.state_dict())
    strips = walk(1, 50, 89)[0]
    torch.testing.assert_close(again.recognise(strips).confidence, both.recognise(strips).confidence)


@pytest.fixture
def mixed() -> Rooms:
    """Two rooms that take turns from the first view on, up to when their charts have tiled both."""
    rooms = Rooms(lambda code, **sizes: begin(code, **{"components": 10, "charts": 240, **sizes}))
    charted: Callable[[], bool] = lambda: bool(rooms.known)  # noqa: E731
    day = 0
    while not charted():
        for room in (0, 1):
            strips, smells = walk(room, EPOCH // 2, 500 + day)
            for start in range(0, EPOCH // 2, BATCH):
                part = slice(start, start + BATCH)
                rooms.learn(strips[part], smells[part], jump=start == 0)
        day += 1
    return rooms


def test_rooms_learnt_mixed_part_when_their_charts_have_tiled_the_views(mixed: Rooms) -> None:
    assert len(mixed) == 2
    homes = [mixed.recognise(walk(room, 200, 90)[0]).nearest for room in (0, 1)]
    assert all((home == home.mode().values).float().mean() > 0.97 for home in homes)
    assert homes[0].mode().values != homes[1].mode().values
    assert sum(network.epoch for network in mixed) == pytest.approx(EPOCH, abs=2)
