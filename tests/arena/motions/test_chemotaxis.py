from itertools import pairwise

import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.base import Walk
from arena.motions.chemotaxis import Chemotaxis
from arena.rooms.arena import Arena

SLOW = Disc(max_acceleration=1.0, max_turn_acceleration=2.0)


def climb(motion: Chemotaxis, views: int, arena: Arena, body: Disc | None = None, seed: int = 0) -> Walk:
    return motion.walk(arena, body or Disc(), views, np.random.default_rng(seed))


def peak(arena: Arena, odorant: int) -> np.ndarray:
    """Where the odour is strongest, by looking everywhere near its source where the body can be."""
    source = np.array(arena.sources[odorant].position)
    grid = source + np.stack(np.meshgrid(*2 * [np.linspace(-0.2, 0.2, 201)]), axis=-1).reshape(-1, 2)
    grid = grid[arena.is_free(grid, Disc().radius)]
    return grid[arena.odours.concentration(grid)[:, odorant].argmax()]


@pytest.fixture
def blocked() -> Arena:
    """Two boxes, one behind the other, between the odour at the right and the left half."""
    box = {"center": (0.0, 0.0), "size": (0.4, 1.8), "material": "timber"}
    fields = Arena.load("open_field").model_dump()
    boxes = [box, {**box, "center": (-0.8, 0.1), "size": (0.3, 0.9)}]
    return Arena.create(**{**fields, "boxes": boxes, "sources": [{"position": (1.2, -0.2)}]})


@pytest.mark.parametrize("body", [Disc(), SLOW], ids=["at once", "slow"])
@pytest.mark.parametrize("odorant", [0, 1, 2])
def test_every_stay_is_at_the_maximum_and_sees_all_around(odorant: int, body: Disc) -> None:
    arena = Arena.load("furnished")
    walk = climb(Chemotaxis(odorant=odorant), 1500, arena, body)
    stays = walk.notes["at_maximum"]
    assert len(stays) > 12
    for first, last in stays:
        places, headings = walk.poses[first:last, :2], walk.poses[first:last, 2]
        assert np.hypot(*(places - peak(arena, odorant)).T).max() < 0.03
        assert np.diff(np.sort(headings), append=headings.min() + 2 * np.pi).max() < 0.45
    apart = [walk.poses[end:begin] for (_, end), (begin, _) in pairwise(stays)]
    away = [np.hypot(*(leg[:, :2] - peak(arena, odorant)).T).max() for leg in apart]
    assert np.median(away) > 0.5


@pytest.mark.parametrize("start", [(-1.5, -1.2), (-1.5, 1.2), (-1.3, 0.1), (-0.4, 1.0), (1.7, 1.2)])
def test_it_finds_its_way_around_what_is_in_the_way(blocked: Arena, start: tuple[float, float]) -> None:
    walk = climb(Chemotaxis(start=(*start, 0.0)), 200, blocked)
    first = walk.notes["at_maximum"][0][0]
    assert np.hypot(*(walk.poses[first, :2] - peak(blocked, 0))) < 0.03
    # It goes uphill all the way there.
    smelt = blocked.odours.concentration(walk.poses[:first, :2])[:, 0]
    assert (np.diff(smelt) > -0.05 * smelt[1:]).mean() > 0.9


@pytest.mark.parametrize("name", ["l_shape", "obstacles", "pillar", "two_rooms"])
def test_from_everywhere(name: str) -> None:
    arena = Arena.load(name)
    for odorant in range(len(arena.sources)):
        goal = peak(arena, odorant)
        for x, y in arena.sample_free(8, 0.18, np.random.default_rng(odorant)).tolist():
            walk = climb(Chemotaxis(odorant=odorant, start=(x, y, 0.0)), 150, arena)
            first = walk.notes["at_maximum"][0][0]
            assert np.hypot(*(walk.poses[first, :2] - goal)) < 0.03


def test_it_is_pushed_in_all_directions() -> None:
    arena = Arena.load("open_field")
    walk = climb(
        Chemotaxis(push=0.4),
        5000,
        Arena.create(**{**arena.model_dump(), "sources": [{"position": (0.0, 0.0)}]}),
    )
    stays = walk.notes["at_maximum"]
    legs = [walk.poses[end : begin + 1, :2] for (_, end), (begin, _) in pairwise(stays)]
    far = np.array([leg[np.hypot(*leg.T).argmax()] for leg in legs])
    assert np.histogram(np.arctan2(far[:, 1], far[:, 0]), bins=6, range=(-np.pi, np.pi))[0].min() > 3
    # From where it came does not matter.
    arrival = np.array([walk.poses[begin, 2] for begin, _ in stays[:-1]])
    turned = np.arctan2(far[:, 1], far[:, 0]) - arrival
    assert np.abs(np.exp(1j * turned).mean()) < 0.35
    reach = np.hypot(*far.T)
    assert 0.1 < reach.min() < 0.3
    assert 0.5 < reach.max() < 0.65


def test_dead_ends_do_not_count_as_maxima() -> None:
    # The odour of a source at the end of one arm is strongest, in the other arm, just across the notch.
    fields = Arena.load("open_field").model_dump()
    horseshoe = [
        (-1.5, -1.0),
        (1.5, -1.0),
        (1.5, 1.0),
        (-1.5, 1.0),
        (-1.5, 0.5),
        (1.0, 0.5),
        (1.0, -0.5),
        (-1.5, -0.5),
    ]
    arena = Arena.create(**{**fields, "platform": [horseshoe], "sources": [{"position": (-1.3, -0.75)}]})
    walk = climb(Chemotaxis(start=(-1.3, 0.7, 0.0), push=5.0), 3000, arena)
    at = np.concatenate([walk.poses[first:last] for first, last in walk.notes["at_maximum"]])
    assert np.hypot(*(at[:, :2] - (-1.3, -0.75)).T).max() < 0.03


def test_the_source_itself_may_be_out_of_reach() -> None:
    fields = {**Arena.load("open_field").model_dump(), "sources": [{"position": (2.6, 0.3)}]}
    walk = climb(Chemotaxis(), 600, Arena.create(**fields))
    at = np.concatenate([walk.poses[first:last] for first, last in walk.notes["at_maximum"]])
    np.testing.assert_allclose(at[:, :2], [(1.82, 0.3)] * len(at), atol=0.05)


def test_an_odour_that_is_not_there_is_refused() -> None:
    with pytest.raises(ArenaError, match="has 3 odour sources, so no odour 3"):
        climb(Chemotaxis(odorant=3), 10, Arena.load("open_field"))


def test_start_that_is_not_free_is_refused() -> None:
    with pytest.raises(ArenaError, match="start"):
        climb(Chemotaxis(start=(0.0, 0.0, 0.0)), 10, Arena.load("pillar"))


@pytest.mark.parametrize(
    "wrong", [{"odorant": -1}, {"push": 0.0}, {"precision": 0.0}, {"stride": np.inf}, {"odorant": 0.5}]
)
def test_bad_parameters_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ArenaError, match=next(iter(wrong))):
        Chemotaxis(**wrong)
