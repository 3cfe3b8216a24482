"""A first course in topology, told by maps of rooms.

Betti numbers count what cannot be squeezed away: b₀ pieces, b₁ loops, b₂ voids. Where a body can be in a
room is a piece of the plane with a hole at each pillar: [1, holes]. Where it can look is a circle: [1, 1].
A view has both at once, and for products the polynomials b₀ + b₁ t + b₂ t² multiply (Künneth):
(1 + h t)(1 + t) = 1 + (1 + h) t + h t². So views of an empty room form [1, 1, 0], a solid torus, and views of
a room with a pillar [1, 2, 1]: one loop is a turn on the spot, the other a walk around the pillar, and the
void is what both together enclose.

None of the maps below was told of places, headings, holes or circles. It was shown pictures, with a smell.
"""

from typing import NamedTuple

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, explore
from cogmap import Activity, Betti, CognitiveMap
from cogmap.evaluation.homology_of_map import homologies
from cogmap.shape import population_nerve
from cogmap.testing import assert_betti

VIEWS = 10_000
"""Fewer leave gaps as wide as a pillar."""
LANDMARKS = (250, 120)


def plane_with_holes(holes: int, rng: np.random.Generator, points: int = 6000) -> np.ndarray:
    """Places between pillars."""
    width = 2.0 if holes == 2 else 1.1
    xy = rng.uniform((-width, -1.1), (width, 1.1), (3 * points, 2))
    for x in {0: (), 1: (0.0,), 2: (-0.95, 0.95)}[holes]:
        xy = xy[np.linalg.norm(xy - (x, 0), axis=1) > 0.65]
    return xy[:points]


@pytest.mark.parametrize("holes", [0, 1, 2])
def test_loops_and_voids_of_a_product_are_those_of_its_factors(holes: int) -> None:
    rng = np.random.default_rng(holes)
    place = plane_with_holes(holes, rng)
    heading = rng.uniform(-np.pi, np.pi, len(place))
    circle = 0.55 * np.column_stack([np.cos(heading), np.sin(heading)])
    assert_betti(place, (1, holes), landmarks=LANDMARKS, draws=1)
    assert_betti(circle, (1, 1), landmarks=LANDMARKS, draws=1)
    assert_betti(np.hstack([place, circle]), (1, 1 + holes, holes), landmarks=LANDMARKS, draws=1)


class Known(NamedTuple):
    """All that is known of the room with a pillar."""

    activity: Activity
    betti: dict[str, Betti]


@pytest.fixture(scope="module")
def pillar() -> Known:
    walk = explore(Arena.load("pillar"), Brownian(), Camera.panoramic(90, 15), views=VIEWS, seed=0)
    cmap = CognitiveMap(charts=2000, seed=0).fit(walk.views, walk.odours)
    activity = cmap.perceive(walk.views)
    return Known(activity, homologies(cmap.encode(walk.views), activity, landmarks=LANDMARKS, draws=1))


def test_views_around_a_pillar_have_two_loops_and_a_void(pillar: Known) -> None:
    assert pillar.betti["view_manifold"].numbers == (1, 2, 1), str(pillar.betti["view_manifold"])


def test_so_has_what_is_recalled_of_smell_and_heading(pillar: Known) -> None:
    assert pillar.betti["fused"].numbers == (1, 2, 1), str(pillar.betti["fused"])


def test_place_cells_keep_the_walk_around_the_pillar_and_forget_the_turn(pillar: Known) -> None:
    assert pillar.betti["place"].numbers == (1, 1, 0), str(pillar.betti["place"])


def test_head_direction_cells_keep_the_turn_and_forget_the_walk(pillar: Known) -> None:
    assert pillar.betti["heading"].numbers == (1, 1, 0), str(pillar.betti["heading"])


def test_together_the_populations_are_what_the_views_were(pillar: Known) -> None:
    """Künneth again, now backwards: two factors found apart give back the whole."""
    place, heading, views = (pillar.betti[name].numbers for name in ("place", "heading", "view_manifold"))
    assert tuple(np.convolve(place[:2], heading[:2])) == views


def test_no_call_was_close(pillar: Known) -> None:
    """The last bar that counts and the first that does not are well apart from the threshold."""
    for found in pillar.betti.values():
        last, first = found.margins[1]
        assert last is not None
        assert last > 1.2
        assert first is None or first < 0.95


def test_who_fires_with_whom_tells_the_same(pillar: Known) -> None:
    """Nothing is measured here: cells are joined that are active in the same views."""
    assert population_nerve(pillar.activity.place).numbers == (1, 1)
    assert population_nerve(pillar.activity.heading).numbers == (1, 1)


def test_a_population_that_is_silenced_around_the_pillar_tells_another_story(pillar: Known) -> None:
    """A loop is of all cells: without those on one side of the pillar it is open."""
    place, position = pillar.activity.place, pillar.activity.position
    towards = position[place.argmax(axis=0)] - position.mean(axis=0)
    kept = np.abs(np.arctan2(towards[:, 1], towards[:, 0])) < 2.2
    assert 60 < kept.sum() < 140
    assert population_nerve(place[:, kept]).numbers == (1, 0)
