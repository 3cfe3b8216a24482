from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap import CogmapError, CognitiveMap
from cogmap.evaluation.populations import perceive
from cogmap.experiments.rooms.morph import repainted

VIEWS, CHARTS = 900, 180
CORNERS = [[-0.8, -0.6], [0.8, -0.6], [0.8, 0.6], [-0.8, 0.6]]
ROOMS = "furnished", "repainted"


def walk(name: str, views: int = VIEWS, seed: int = 0) -> Recording:
    """Walk about on a platform that is small enough for so few views."""
    room = Arena.load("furnished" if name in ROOMS else name)
    room = repainted(room) if name == "repainted" else room
    room = room.model_copy(update={"platform": [CORNERS]}) if name in ROOMS else room
    return explore(room, Brownian(), Camera.panoramic(90, 15), views=views, seed=seed)


@pytest.fixture(scope="module")
def walks() -> list[Recording]:
    return [walk(room, seed=number) for number, room in enumerate(ROOMS)]


@pytest.fixture(scope="module")
def one(walks: list[Recording]) -> CognitiveMap:
    return CognitiveMap(charts=CHARTS, components=30, place_cells=40).fit(walks[0].views, walks[0].odours)


@pytest.fixture(scope="module")
def both(one: CognitiveMap, walks: list[Recording]) -> CognitiveMap:
    return deepcopy(one).fit(walks[1].views, walks[1].odours, further=True)


def test_the_first_room_stays_as_it_was(
    one: CognitiveMap, both: CognitiveMap, walks: list[Recording]
) -> None:
    assert (one.rooms_, both.rooms_) == (1, 2)
    before, after = (perceive(cmap, walks[0].views[:200]) for cmap in (one, both))
    assert np.mean(after.room == 0) > 0.98
    for name in ("place", "odour", "position"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), rtol=1e-3, atol=1e-3)


def test_each_view_is_told_by_its_own_room(both: CognitiveMap, walks: list[Recording]) -> None:
    mixed = np.concatenate([walks[1].views[:50], walks[0].views[:50], walks[1].views[50:80]])
    told = perceive(both, mixed)
    np.testing.assert_array_equal(told.room, np.repeat([1, 0, 1], [50, 50, 30]))
    assert told.room_confidence is not None
    assert told.room_confidence.min() > 0.5
    for room, rows in ((1, slice(0, 50)), (0, slice(50, 100)), (1, slice(100, 130))):
        alone = perceive(both.room(room), mixed[rows])
        np.testing.assert_allclose(told.odour[rows], alone.odour, rtol=1e-3, atol=1e-3)
        np.testing.assert_allclose(told.place[rows], alone.place, rtol=1e-3, atol=1e-3)


def test_views_of_nowhere_are_of_no_room(both: CognitiveMap) -> None:
    elsewhere = walk("l_shape", 100, seed=9)
    told = perceive(both, elsewhere.views)
    assert (told.room == -1).mean() > 0.5
    assert np.isfinite(told.odour).all()


def test_a_fresh_walk_through_known_rooms_begins_no_other(both: CognitiveMap) -> None:
    grown = deepcopy(both)
    for number, room in enumerate(ROOMS):
        again = walk(room, 300, seed=20 + number)
        grown.partial_fit(again.views, again.odours, jump=True)
        assert grown.rooms_ == 2
        assert int(grown.state_dict()["present"]) == number
    known = deepcopy(both)
    again = walk(ROOMS[0], 300, seed=22)
    assert known.fit(again.views, again.odours, further=True).rooms_ == 2


def test_smells_in_the_dark_are_of_a_room(both: CognitiveMap, walks: list[Recording]) -> None:
    told = both.perceive(odours=walks[1].require("odours")[:100])
    assert np.isfinite(told.place).all()
    assert np.isnan(told.phase).all()
    assert set(np.unique(told.room)) <= {-1, 0, 1}


def test_every_room_is_saved(both: CognitiveMap, walks: list[Recording], tmp_path: Path) -> None:
    both.save(tmp_path / "map")
    again = CognitiveMap.load(tmp_path / "map")
    assert again.rooms_ == 2
    mixed = np.concatenate([each.views[:40] for each in walks])
    for name, told in vars(perceive(both, mixed)).items():
        if told is not None:
            np.testing.assert_array_equal(getattr(perceive(again, mixed), name), told)
    assert any(name.startswith("room_1.") for name in both.state_dict())


def test_what_is_not_trusted_is_said_room_by_room(both: CognitiveMap) -> None:
    misled = deepcopy(both)
    misled.room(1)._rooms[0].agreement.fill_(np.nan)
    assert misled.room(0).trusted_ == both.room(0).trusted_
    assert not misled.trusted_
    assert f"room 1: {misled.room(1).reason_}" in misled.reason_
    assert misled.diagnosis().place.reason == f"room 1: {misled.room(1).diagnosis().place.reason}"


def test_a_room_that_there_is_not_is_refused(both: CognitiveMap) -> None:
    with pytest.raises(CogmapError, match="room is 2; this map knows 2, give 0 to 1"):
        both.room(2)


def test_too_few_views_of_a_further_room_are_refused(both: CognitiveMap) -> None:
    few = walk("l_shape", CHARTS - 1, seed=9)
    with pytest.raises(CogmapError, match=f"there are {CHARTS - 1} views for {CHARTS} charts"):
        deepcopy(both).fit(few.views, few.odours, further=True)


def test_codes_of_all_rooms_are_of_one_space(
    one: CognitiveMap, both: CognitiveMap, walks: list[Recording]
) -> None:
    codes = both.encode(walks[0].views[:20])
    assert codes.shape[1] > 30
    np.testing.assert_allclose(codes[:, :30], one.encode(walks[0].views[:20]), rtol=1e-4, atol=1e-3)


def test_rooms_learnt_together_part(walks: list[Recording]) -> None:
    views, odours = (np.concatenate([getattr(each, name) for each in walks]) for name in ("views", "odours"))
    mixed = CognitiveMap(charts=2 * CHARTS, components=60, place_cells=40).fit(views, odours)
    assert mixed.rooms_ == 2
    homes = [perceive(mixed, each.views).room for each in walks]
    assert [np.mean(home == np.median(home)) > 0.95 for home in homes] == [True, True]
    assert np.median(homes[0]) != np.median(homes[1])


def test_renewal_is_off_unless_asked_for(walks: list[Recording]) -> None:
    views, odours = walks[0].views[:300], walks[0].require("odours")[:300]
    maps = [
        CognitiveMap(charts=60, components=10, place_cells=20, time_constant=constant).fit(views, odours)
        for constant in (None, 1000)
    ]
    for name, learnt in maps[0].state_dict().items():
        np.testing.assert_array_equal(maps[1].state_dict()[name], learnt)
    for cmap in maps:
        cmap.partial_fit(views, odours, jump=True)
    activities = [float(cmap.state_dict()["place.afferents.activity"].sum()) for cmap in maps]
    assert activities[0] == pytest.approx(600, rel=1e-3)
    assert activities[1] < 550
    with pytest.raises(CogmapError, match="time_constant is 0; give a number of at least 1"):
        CognitiveMap(charts=60, time_constant=0).fit(views, odours)
