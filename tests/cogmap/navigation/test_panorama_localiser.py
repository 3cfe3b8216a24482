import numpy as np
import pytest

from arena import Arena, Camera
from cogmap import Localiser
from cogmap.errors import CogmapError
from cogmap.evaluation.located import turned_poses
from cogmap.experiments.own_data.real_camera import RealCamera
from cogmap.navigation.panorama_localiser import PanoramaLocaliser

ROOM, CAMERA = Arena.load("furnished"), Camera.panoramic(180, 30)
REAL = RealCamera(tilt=np.deg2rad(1), exposure=0.2, blur=0.6, noise=0.02)


def poses(count: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack(
        [rng.uniform([-1.9, -1.4], [1.9, 1.4], (count, 2)), rng.uniform(-np.pi, np.pi, count)]
    )


def photographs(at: np.ndarray, seed: int, room: Arena = ROOM) -> np.ndarray:
    return REAL.photograph(CAMERA.render(room, at), np.random.default_rng(seed))


KNOWN, ASKED = poses(400, 0), poses(60, 1)


@pytest.fixture(scope="module")
def localiser() -> PanoramaLocaliser:
    return Localiser.for_panoramas(photographs(KNOWN, 0))


def off(angles: np.ndarray) -> np.ndarray:
    return np.rad2deg(np.abs(np.angle(np.exp(1j * angles))))


def test_panoramas_are_placed_and_turned_better_than_by_the_nearest(localiser: PanoramaLocaliser) -> None:
    found = localiser.locate(photographs(ASKED, 1))
    np.testing.assert_allclose(found.weights.sum(axis=1), 1)
    np.testing.assert_allclose(found.turn_weights.sum(axis=1), 1)
    read, nearest = turned_poses(found, KNOWN), KNOWN[found.indices[:, 0]]
    missed, beside = (np.median(np.linalg.norm((p - ASKED)[:, :2], axis=1)) for p in (read, nearest))
    assert missed < 0.4 * beside
    turned = np.median(off(read[:, 2] - ASKED[:, 2]))
    assert turned < 1
    assert turned < np.median(off(nearest[:, 2] + found.turns[:, 0] - ASKED[:, 2])) + 0.1


def test_turns_are_headings_of_the_query_minus_those_of_what_is_remembered(
    localiser: PanoramaLocaliser,
) -> None:
    found = localiser.locate(photographs(ASKED, 1))
    true = ASKED[:, 2] - KNOWN[found.indices[:, 0], 2]
    assert np.median(off(found.turns[:, 0] - true)) < 1
    assert np.abs(found.turns).max() <= np.pi


def test_a_turned_query_has_the_same_place_and_is_turned_by_as_much(localiser: PanoramaLocaliser) -> None:
    views = photographs(ASKED, 1)
    one, other = (localiser.locate(np.roll(views, by, axis=2)) for by in (0, 45))
    np.testing.assert_array_equal(one.indices, other.indices)
    np.testing.assert_allclose(one.weights, other.weights, atol=1e-2)
    # columns move to the right when the body turns left
    assert np.median(off(other.turns - one.turns - np.pi / 2)) < 0.5


def test_what_is_like_nothing_remembered_is_novel(localiser: PanoramaLocaliser) -> None:
    known = localiser.locate(photographs(ASKED, 1)).novelty
    assert 0.5 < np.median(known) < 1.7
    elsewhere = localiser.locate(photographs(0.5 * ASKED, 2, Arena.load("cue_square"))).novelty
    assert elsewhere.min() > 1.5 * np.median(known)
    assert np.median(elsewhere) > 3 * np.median(known)


def test_views_that_turning_does_not_shift_are_refused() -> None:
    views = Camera.perspective(80, 30).render(ROOM, KNOWN[:100])
    with pytest.raises(CogmapError, match="turning does not shift them; give panoramas that look all around"):
        Localiser.for_panoramas(views)
    with pytest.raises(CogmapError, match="uint8 images"):
        Localiser.for_panoramas(views / 255)


def test_views_of_another_camera_are_refused(localiser: PanoramaLocaliser) -> None:
    with pytest.raises(CogmapError, match=r"\(20, 180, 3\) but remembered ones of \(30, 180, 3\)"):
        localiser.locate(np.zeros((1, 20, 180, 3), np.uint8))


def test_equal_views_of_a_robot_that_stood_still_do_no_harm() -> None:
    at = poses(40, 5)
    views = photographs(at, 5)
    still = Localiser.for_panoramas(np.concatenate([views, np.repeat(views[:1], 60, axis=0)]))
    found = still.locate(photographs(at, 6))
    assert np.isfinite(found.novelty).all()
    np.testing.assert_allclose(found.weights.sum(axis=1), 1)
