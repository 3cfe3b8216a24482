import numpy as np
import pytest
from scipy.stats import spearmanr

from arena import Arena, Brownian, Camera, explore
from cogmap.errors import CogmapError
from cogmap.features.compass import turns
from cogmap.features.panorama import PanoramaCode
from cogmap.features.strips import strips

ROOM, CAMERA = Arena.load("obstacles"), Camera.panoramic(120, 20)


def off(angles: np.ndarray) -> np.ndarray:
    return np.rad2deg(np.abs(np.angle(np.exp(1j * angles))))


def test_a_turn_changes_no_magnitude_and_is_told() -> None:
    headings = np.random.default_rng(0).uniform(-np.pi, np.pi, 50)
    poses = np.column_stack([np.full((50, 2), 0.1), headings])
    poses[:, 1] = 1.0
    found = strips(CAMERA.render(ROOM, poses))
    spread = np.linalg.norm(found.turn_invariant - found.turn_invariant.mean(axis=0), axis=1)
    assert spread.max() < 0.1 * np.linalg.norm(found.turn_invariant.mean(axis=0))
    pairs = np.stack([np.arange(50), np.roll(np.arange(50), 1)], axis=1)
    assert off(turns(found.grey, pairs) - headings + np.roll(headings, 1)).max() < 1


def test_a_step_beside_an_obstacle_is_not_taken_for_a_turn() -> None:
    rng = np.random.default_rng(1)
    poses = np.column_stack([np.full(60, -1.3), rng.uniform(0, 0.6, 60), rng.uniform(-np.pi, np.pi, 60)])
    moved = poses + np.column_stack([np.zeros(60), np.full(60, 0.06), rng.uniform(-1, 1, 60)])
    pairs = np.stack([np.arange(60), np.arange(60)], axis=1)
    found = turns(strips(CAMERA.render(ROOM, poses)).grey, pairs, strips(CAMERA.render(ROOM, moved)).grey)
    assert np.median(off(found - poses[:, 2] + moved[:, 2])) < 2


def test_features_are_near_where_poses_are_also_of_fresh_views() -> None:
    walk = explore(ROOM, Brownian(), CAMERA, views=1500, seed=0)
    fresh = explore(ROOM, Brownian(), CAMERA, views=50, seed=1)
    code = PanoramaCode(turning=1.0)
    known = code.fit_transform(walk.views)
    asked = code.transform(fresh.views)
    assert known.shape == (1500, 42)
    nearest = np.argmin(np.linalg.norm(asked[:, None] - known, axis=2), axis=1)
    away = np.linalg.norm(walk.poses[nearest, :2] - fresh.poses[:, :2], axis=1)
    assert np.median(away) < 0.2
    assert np.median(off(walk.poses[nearest, 2] - fresh.poses[:, 2])) < 20
    turn_invariant = np.linalg.norm(known[:1, :40] - known[:, :40], axis=1)
    steps = np.linalg.norm(walk.poses[:1, :2] - walk.poses[:, :2], axis=1)
    assert spearmanr(turn_invariant[steps < 1], steps[steps < 1]).statistic > 0.8
    np.testing.assert_array_equal(code.fit_transform(walk.views), known)
    np.testing.assert_allclose(code.transform(walk.views[:5]), known[:5], atol=0.1)


def test_a_coarse_grid_of_views_agrees_on_north() -> None:
    room, rng = Arena.load("furnished"), np.random.default_rng(0)
    grid = np.stack(np.meshgrid(np.arange(-1.75, 1.8, 0.25), np.arange(-1.25, 1.3, 0.25)), axis=-1)
    poses = np.column_stack([grid.reshape(-1, 2), rng.uniform(-np.pi, np.pi, grid[..., 0].size)])
    code = PanoramaCode(turning=0.5, neighbours=8)
    known = code.fit_transform(CAMERA.render(room, poses))
    north = np.angle(np.exp(1j * (code.headings_ - poses[:, 2])).mean())
    wrong = off(code.headings_ - poses[:, 2] - north)
    assert np.median(wrong) < 2
    assert wrong.max() < 8
    ahead = np.column_stack([np.cos(code.headings_), np.sin(code.headings_)])
    np.testing.assert_allclose(known[:, -2:], 0.5 * ahead)
    np.testing.assert_allclose(known[:, :-2].var(axis=0).sum(), 1)
    moved = poses[::4] + rng.uniform([-0.1, -0.1, -3], [0.1, 0.1, 3], (len(poses[::4]), 3))
    x, y = code.transform(CAMERA.render(room, moved))[:, -2:].T
    np.testing.assert_allclose(np.hypot(x, y), 0.5)
    fresh = off(np.arctan2(y, x) - moved[:, 2] - north)
    assert np.median(fresh) < 2.5
    assert np.percentile(fresh, 90) < 8


def test_known_views_tell_turns_and_whether_they_fit_and_are_stored() -> None:
    rng = np.random.default_rng(0)
    places = np.repeat(rng.uniform([-1.7, -1.2], [-1.0, -0.6], (40, 2)), 2, axis=0)
    poses = np.column_stack([places, rng.uniform(-np.pi, np.pi, 80)])
    code = PanoramaCode(10, neighbours=8).fit(CAMERA.render(ROOM, poses))
    pairs = np.arange(80).reshape(-1, 2)
    found = code.compare_known(pairs)
    assert off(found.headings - poses[::2, 2] + poses[1::2, 2]).max() < 1
    assert found.misfit.max() < 0.02
    fresh = poses[::2] + np.array([0, 0, 1.0])
    seen = strips(CAMERA.render(ROOM, fresh))
    # the second of these is far off: the best fit counts
    near = np.column_stack([np.arange(0, 80, 2), np.roll(np.arange(0, 80, 2), 20)])
    compared = code.compare(seen, near)
    np.testing.assert_array_equal(compared.headings, code.heading(seen, near))
    assert (compared.misfit < 0.02).all()
    assert (code.compare(seen, near[:, 1:]).misfit > compared.misfit).all()
    state = code.state()
    assert {array.dtype.kind for array in state.values()} == {"f"}
    other = PanoramaCode.from_state({name: array.copy() for name, array in state.items()})
    np.testing.assert_array_equal(other.place(seen), code.place(seen))
    for mine, theirs in zip(other.compare(seen, near), compared, strict=True):
        np.testing.assert_array_equal(mine, theirs)


def test_affine_weights_tell_the_heading_where_all_that_is_known_lies_on_one_side() -> None:
    """Beside a box the turns of views to the left are wrong, and those of views farther left more so."""
    box = ROOM.boxes[0]
    x = np.array(box.center)[0] + np.linspace(-0.3, 0.3, 30)
    y = np.full(30, max(corner[1] for corner in box.outline) + 0.2)
    poses = np.column_stack([x, y, np.zeros(30)])
    code = PanoramaCode(10, neighbours=4).fit(CAMERA.render(ROOM, poses))
    code.headings_ = poses[:, 2]
    ones = slice(4, 26, 3)
    near = np.arange(30)[ones][:, None] + np.array([1, 2, 3])
    seen = strips(CAMERA.render(ROOM, poses[ones]))
    # 2 y(1) − y(2) leads back to y(0)
    told = code.compare(seen, near, np.tile([2.0, -1.0, 0.0], (len(near), 1))).headings
    alike = code.compare(seen, near).headings
    assert off(told).max() < 0.5 * off(alike).max()


@pytest.mark.parametrize("count", [1, 3])
def test_one_view_alone_is_no_map(count: int) -> None:
    view = CAMERA.render(ROOM, np.array([[0.0, 1.0, 0.3]]))
    with pytest.raises(CogmapError, match=f"{count} panoramas are all alike"):
        PanoramaCode().fit(np.repeat(view, count, axis=0))


def test_views_that_are_no_panoramas_are_refused() -> None:
    with pytest.raises(CogmapError, match="61 columns wide"):
        PanoramaCode().fit(np.zeros((4, 20, 61, 3), np.uint8))
    with pytest.raises(CogmapError, match="uint8 images"):
        PanoramaCode().fit(np.zeros((4, 20)))
