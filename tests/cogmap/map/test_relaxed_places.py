"""What relaxing adds to positions and headings as coarse as a map recalls them, in a small room."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from arena import Arena, Brownian, Camera, Recording, explore
from arena.angles import wrap_angle
from cogmap import CogmapError
from cogmap.features.panorama import Compared, PanoramaCode
from cogmap.features.strips import Strips
from cogmap.map.relaxed_places import Located, RelaxedPlaces, _alike
from cogmap.threads import one_thread

CORNERS = ((-0.8, -0.6), (0.8, -0.6), (0.8, 0.6), (-0.8, 0.6))
ROOM = Arena.load("furnished").model_copy(update={"platform": (CORNERS,)})


def recalled(poses: np.ndarray, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Positions that jump by 4 cm, and headings by 2° that drift over the room."""
    rng = np.random.default_rng(seed)
    jumps = rng.standard_normal((len(poses), 2)) @ [1, 1j]
    place = 3 * np.exp(1j) * (poses[:, 0] + 1j * poses[:, 1]) + 0.12 * jumps
    phase = poses[:, 2] + 1 + 0.05 * poses[:, 0] + 0.03 * rng.standard_normal(len(poses))
    return np.column_stack([place.real, place.imag]), wrap_angle(phase)


def errors(poses: np.ndarray, position: np.ndarray, phase: np.ndarray) -> tuple[float, float]:
    """Medians of position (m) and heading (rad) after the best similarity."""
    place, truth = (array[:, 0] + 1j * array[:, 1] for array in (position, poses))
    basis = np.column_stack([place, np.ones(len(place))])
    fit = np.linalg.lstsq(basis, truth, rcond=None)[0]
    turned = wrap_angle(phase - poses[:, 2])
    north = np.angle(np.exp(1j * turned).mean())
    return float(np.median(np.abs(basis @ fit - truth))), float(np.median(np.abs(wrap_angle(turned - north))))


def walked(camera: Camera, views: int, seed: int) -> Recording:
    return explore(ROOM, Brownian(), camera, views=views, seed=seed)


@pytest.fixture(scope="module")
def walk(camera: Camera) -> Recording:
    return walked(camera, 700, 0)


@pytest.fixture(scope="module")
def fresh(camera: Camera) -> Recording:
    return walked(camera, 150, 1)


@pytest.fixture(scope="module")
def relaxed(walk: Recording) -> RelaxedPlaces:
    return RelaxedPlaces.learn(walk.views, *recalled(walk.poses))


def located(relaxed: RelaxedPlaces, recording: Recording) -> Located:
    return relaxed.locate(recording.views, recalled(recording.poses, 9)[0])


def test_places_and_headings_are_finer_than_those_recalled(
    relaxed, walk: Recording, fresh: Recording
) -> None:
    for poses, coarse, fine, place, heading in (
        (walk.poses, recalled(walk.poses), (relaxed.places_, relaxed.headings_), 0.25, 0.75),
        (fresh.poses, recalled(fresh.poses, 9), located(relaxed, fresh)[:2], 0.6, 0.6),
    ):
        before, after = errors(poses, *coarse), errors(poses, *fine)
        assert after[0] < place * before[0]
        assert after[1] < heading * before[1]


def test_a_heading_is_told_by_neighbours_that_make_up_the_view(
    relaxed, fresh: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def compare(self: PanoramaCode, seen: Strips, near: np.ndarray, weights: np.ndarray) -> Compared:
        asked.append((self.place(seen), self.places_[near], weights))
        return plain(self, seen, near, weights)

    plain = PanoramaCode.compare
    monkeypatch.setattr(PanoramaCode, "compare", compare)
    located(relaxed, fresh)
    ((codes, near, weights),) = asked
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    made = np.einsum("vk,vkc->vc", weights, near)
    off, mean_off = (np.linalg.norm(each - codes, axis=1) for each in (made, near.mean(axis=1)))
    assert np.median(off / mean_off) < 0.8


def test_a_walk_straightens_what_neighbours_cannot(relaxed, walk: Recording) -> None:
    order = np.random.default_rng(2).permutation(len(walk))
    position, phase = recalled(walk.poses)
    shuffled = RelaxedPlaces.learn(walk.views[order], position[order], phase[order])
    walking, lost = (
        errors(walk.poses[rows], each.places_, each.headings_)
        for rows, each in ((slice(None), relaxed), (order, shuffled))
    )
    assert lost[0] < 0.8 * errors(walk.poses, position, phase)[0]
    assert walking[0] < 0.8 * lost[0]


def test_a_mirrored_map_stays_mirrored(walk: Recording, fresh: Recording) -> None:
    views, (position, phase), asked = walk.views[:300], recalled(walk.poses[:300]), fresh.views[:20]
    one, other = (RelaxedPlaces.learn(views, position * [1, sign], sign * phase) for sign in (1, -1))
    np.testing.assert_allclose(other.places_, one.places_ * [1, -1], atol=2e-3)
    np.testing.assert_allclose(wrap_angle(other.headings_ + one.headings_), 0, atol=1e-3)
    where = recalled(fresh.poses[:20], 9)[0]
    there, mirrored = one.locate(asked, where), other.locate(asked, where * [1, -1])
    np.testing.assert_allclose(mirrored.position, there.position * [1, -1], atol=2e-3)
    np.testing.assert_allclose(wrap_angle(mirrored.phase + there.phase), 0, atol=1e-3)
    turned = one.turns(asked, asked[::-1])
    np.testing.assert_array_equal(other.turns(asked, asked[::-1]), -turned)


def test_turns_and_the_nearest_view_are_read_off_the_images(relaxed, walk: Recording, camera: Camera) -> None:
    poses = walk.poses[::50] + np.array([0, 0, 0.8])
    views = camera.render(ROOM, poses)
    np.testing.assert_allclose(relaxed.turns(views, walk.views[::50]), -0.8, atol=0.01)
    away = np.linalg.norm((walk.poses[relaxed.nearest(views)] - poses)[:, :2], axis=1)
    assert np.median(away) < 0.03


def test_novelty_tells_what_is_remembered(relaxed, walk: Recording, fresh: Recording, camera: Camera) -> None:
    assert 0.7 < np.median(located(relaxed, fresh).novelty) < 1.6
    assert (located(relaxed, fresh).novelty < 4).mean() > 0.93
    shape = walk.views[:4].shape
    other = camera.render(Arena.load("two_rooms"), np.column_stack([np.full((4, 2), -0.5), np.arange(4.0)]))
    noise = np.random.default_rng(0).integers(0, 256, shape).astype(np.uint8)
    for views in (other, noise, np.zeros(shape, np.uint8), walk.views[:4][:, ::-1]):
        assert relaxed.locate(views, np.zeros((4, 2))).novelty.min() > 4


def test_saved_and_loaded_places_tell_the_same_bits(relaxed, fresh: Recording) -> None:
    other = RelaxedPlaces.from_state({name: array.copy() for name, array in relaxed.state().items()})
    for mine, theirs in zip(located(other, fresh), located(relaxed, fresh), strict=True):
        np.testing.assert_array_equal(mine, theirs)
    np.testing.assert_array_equal(other.headings_, relaxed.headings_)


def test_views_that_look_alike_and_were_taken_elsewhere_are_left_out() -> None:
    positions = np.array([[0.0, 0], [1, 0], [5, 0], [0, 1], [9, 9]])
    near = np.array([[2, 0, 1, 3], [2, 4, 2, 4], [0, 1, 3, 2]])
    here = np.array([[0.0, 0], [0.0, 0], [5.0, 0]])
    found = _alike(near, here, positions, 2.0)
    np.testing.assert_array_equal(found, [[0, 1, 3, -1], [2, 4, 2, 4], [2, -1, -1, -1]])


@pytest.mark.parametrize("kind", ["perspective", "shuffled columns"])
def test_views_that_a_turn_does_not_shift_are_refused(kind: str, walk: Recording) -> None:
    poses = walk.poses[:200]
    if kind == "perspective":
        views = Camera.perspective(96, 24).render(ROOM, poses)
    else:
        views = walk.views[:200][:, :, np.random.default_rng(0).permutation(90)]
    with pytest.raises(CogmapError, match=r"turning does not shift these views: .* R = 0\.\d+, below 0.99"):
        RelaxedPlaces.learn(views, *recalled(poses))


def test_few_views_are_refused(walk: Recording) -> None:
    with pytest.raises(CogmapError, match="there are 60 views to relax places of; give more than 60"):
        RelaxedPlaces.learn(walk.views[:60], *recalled(walk.poses[:60]))


def test_one_thread_or_two_relax_to_the_same_bits(walk: Recording) -> None:
    learnt = []
    for threads in (1, 2):
        with threadpool_limits(threads), one_thread():
            learnt.append(RelaxedPlaces.learn(walk.views[:200], *recalled(walk.poses[:200])).state())
    for name, array in learnt[0].items():
        np.testing.assert_array_equal(array, learnt[1][name])
