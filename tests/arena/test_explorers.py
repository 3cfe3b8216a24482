import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.explorers import Explorers
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.smell.nose import Nose

ROOM = Arena.load("pillar")
ALL = np.arange(3)


def at_large(camera: Camera = Camera.panoramic(16, 4, noise=0.05)) -> Explorers:
    explorers = Explorers(ROOM, camera, nose=Nose(fluctuation=0.3), body=Disc(), count=3)
    starts = [(1.2, -0.5, 0.0), (-1.2, 0.3, 1.0), (1.0, 0.8, 4.0)]
    explorers.begin(ALL, starts, [np.random.default_rng(k) for k in range(3)])
    return explorers


def test_those_who_do_not_sense_keep_what_they_sensed_and_nothing_given_changes() -> None:
    explorers = at_large()
    first = explorers.sense(ALL)
    kept = {name: values.copy() for name, values in first.items()}
    explorers.act(ALL, np.full((3, 2), 0.3), 0.2)
    second = explorers.sense(ALL[1:2])
    for name in ("view", "odour"):
        np.testing.assert_array_equal(first[name], kept[name])
        np.testing.assert_array_equal(second[name][[0, 2]], first[name][[0, 2]])
        assert not np.array_equal(second[name][1], first[name][1])


def test_those_who_do_not_act_stay() -> None:
    explorers = at_large()
    before = explorers.poses(ALL)
    explorers.act(ALL[[0, 2]], np.full((2, 2), 0.3), 0.2)
    after = explorers.poses(ALL)
    np.testing.assert_array_equal(after[1], before[1])
    assert (after[[0, 2]] != before[[0, 2]]).all()
    assert (np.abs(after[:, 2]) <= np.pi).all()


def test_another_eye_is_asked_for_each_with_its_own_generator() -> None:
    class Other:
        height, width = 4, 16

        def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
            return Camera.panoramic(16, 4, noise=0.05).render(arena, poses, rng=rng)

        def model_dump(self) -> dict[str, object]:
            return {}

    views = [at_large(camera).sense(ALL)["view"] for camera in (Camera.panoramic(16, 4, noise=0.05), Other())]
    np.testing.assert_array_equal(*views)


def test_a_start_that_is_not_free_is_refused() -> None:
    with pytest.raises(ArenaError, match="free space"):
        at_large().begin(ALL[:1], [(0.0, 0.0, 0.0)], [np.random.default_rng(0)])
