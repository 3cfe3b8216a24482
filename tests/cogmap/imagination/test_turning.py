import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.imagination.turning import blended, columns_turned

ONE = np.ones(1, np.float32)


@pytest.mark.parametrize("shift", [-7.0, 0.0, 3.0, 89.0])
def test_whole_columns_are_rolled(shift: float) -> None:
    views = np.random.default_rng(0).integers(0, 256, (1, 4, 30, 3), np.uint8)
    found = blended(views, np.array([shift], np.float32), ONE, ONE)
    np.testing.assert_array_equal(found.view, np.roll(views[0], int(shift), axis=1))
    assert not found.spread.any()


@pytest.mark.parametrize("shift", [0.25, -1.5, 12.75])
def test_parts_of_columns_are_between(shift: float) -> None:
    angle = 2 * np.pi * np.arange(60) / 60
    wave = 128 + 100 * np.sin(2 * angle)
    views = np.tile(np.rint(wave)[None, None, :, None], (1, 3, 1, 3)).astype(np.uint8)
    found = blended(views, np.array([shift], np.float32), ONE, ONE)
    wanted = 128 + 100 * np.sin(2 * (angle - 2 * np.pi * shift / 60))
    np.testing.assert_allclose(found.view[1, :, 2], wanted, atol=1.0)


def test_a_turned_body_sees_the_shifted_panorama(room: Arena, camera: Camera) -> None:
    before, after = camera.render(room, np.array([[0.3, -0.2, 0.5], [0.3, -0.2, 1.2]]))
    shift = columns_turned(np.array([0.7]), 90)
    error = np.abs(blended(before[None], shift, ONE, ONE).view - after)
    assert error.mean() < 0.2 * np.abs(before.astype(float) - after).mean()


def test_the_blend_is_affine_and_its_spread_that_of_the_sources() -> None:
    views = np.stack([np.full((2, 8, 3), grey, np.uint8) for grey in (100, 140)])
    affine, near = np.array([1.5, -0.5], np.float32), np.array([0.5, 0.5], np.float32)
    found = blended(views, np.array([0.3, 2.6], np.float32), affine, near)
    np.testing.assert_allclose(found.view, 80, rtol=1e-4)
    np.testing.assert_allclose(found.spread, 20, rtol=1e-2)
