import numpy as np
import pytest
import shapely

from arena import Arena, Disc, gallery
from cogmap.errors import CogmapError
from cogmap.evaluation.free_space import expected_betti, free_space_betti

HOLES = {"pillar": 1, "two_pillars": 2, "obstacles": 2}


@pytest.mark.parametrize("name", gallery())
def test_the_gallery_has_a_hole_for_every_thing_on_the_platform(name: str) -> None:
    holes = HOLES.get(name, 0)
    room = Arena.load(name)
    assert free_space_betti(room) == (1, holes)
    # Euler's characteristic of the plane that is left, by a count on a fine grid: vertices - edges + faces.
    low, high = np.reshape(room.free_space(Disc().radius).bounds, (2, 2))
    x, y = (np.arange(a - 0.02, b + 0.03, 0.01) for a, b in zip(low, high, strict=True))
    free = room.is_free(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2), Disc().radius)
    free = free.reshape(len(y), len(x))
    along, across = free[:, 1:] & free[:, :-1], free[1:] & free[:-1]
    assert free.sum() - along.sum() - across.sum() + (across[:, 1:] & across[:, :-1]).sum() == 1 - holes


def test_what_a_map_should_know_is_the_plane_times_the_circle_of_headings() -> None:
    found = expected_betti(Arena.load("two_pillars"), np.array([0.0, 0.0]))
    assert found == {
        **dict.fromkeys(("view_manifold", "seen_and_smelt", "fused"), (1, 3, 2)),
        "place": (1, 2, 0),
        "heading": (1, 1, 0),
    }


def test_a_passage_too_narrow_for_the_body_is_none() -> None:
    room = Arena.load("two_pillars")
    (left, right), gap = room.pillars, 0.3
    near = room.model_copy(
        update={
            "pillars": [
                left.model_copy(update={"center": (-0.4 - gap / 2, 0.0)}).model_dump(),
                right.model_copy(update={"center": (0.4 + gap / 2, 0.0)}).model_dump(),
            ]
        }
    )
    assert free_space_betti(near) == (1, 1)
    assert free_space_betti(near, body=Disc(radius=0.1)) == (1, 2)
    assert shapely.get_num_interior_rings(near.free_space(0.1)) == 2
    door = Arena.load("two_rooms")
    assert free_space_betti(door, body=Disc(radius=0.6)) == (2, 0)


def test_only_the_piece_that_is_walked_counts() -> None:
    room = Arena.load("pillar")
    apart = room.model_copy(
        update={"platform": (*room.platform, ((2.2, -0.4), (2.9, -0.4), (2.9, 0.4), (2.2, 0.4)))}
    )
    assert free_space_betti(apart) == (2, 1)
    assert expected_betti(apart, np.array([2.5, 0.0]))["place"] == (1, 0, 0)
    assert expected_betti(apart, np.array([1.5, 0.5]))["place"] == (1, 1, 0)


def test_a_room_without_room_is_refused() -> None:
    with pytest.raises(CogmapError, match="no free space"):
        free_space_betti(Arena.load("linear_track"), body=Disc(radius=0.5))
