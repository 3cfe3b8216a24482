import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError
from cogmap.navigation import Localiser, image_codes

ROOM, CAMERA = Arena.load("furnished"), Camera.perspective(80, 60)


def test_plain_views_are_their_colour() -> None:
    views = np.full((2, 60, 80, 3), [10, 200, 60], np.uint8)
    codes = image_codes(views)
    assert codes.shape == (2, 900)
    np.testing.assert_allclose(codes, np.tile([10, 200, 60], (2, 300)), atol=1e-3)


def test_codes_are_blurred_means_of_patches() -> None:
    views = np.random.default_rng(0).integers(0, 256, (2, 120, 160, 3), dtype=np.uint8)
    fine = views.reshape(2, 30, 4, 40, 4, 3).mean(axis=(2, 4))
    reach = np.arange(-4, 5)
    kernel = np.exp(-0.5 * reach**2) / np.exp(-0.5 * reach**2).sum()
    for axis in (1, 2):
        width = [(4, 4) if at == axis else (0, 0) for at in range(4)]
        padded = np.pad(fine, width, mode="reflect")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 9, axis=axis)
        fine = windows @ kernel
    plain = fine.reshape(2, 15, 2, 20, 2, 3).mean(axis=(2, 4))
    np.testing.assert_allclose(image_codes(views), plain.reshape(2, -1), atol=0.1)


def test_blocks_change_nothing() -> None:
    views = np.random.default_rng(1).integers(0, 256, (300, 15, 20, 3), dtype=np.uint8)
    codes = image_codes(views)
    np.testing.assert_array_equal(codes[[0, 255, 256, 299]], image_codes(views[[0, 255, 256, 299]]))


def test_weights_in_codes_place_views_better_than_the_nearest() -> None:
    rng = np.random.default_rng(2)
    poses = rng.uniform([-0.2, -0.2, 0.2], [0.2, 0.2, 0.5], (600, 3))
    codes = image_codes(CAMERA.render(ROOM, poses))
    noisy = Camera.perspective(80, 60, noise=0.01).render(ROOM, poses[500:], rng=np.random.default_rng(3))
    found = Localiser(codes[:500], neighbours=40, metric="euclidean").locate(image_codes(noisy))
    near = poses[:500][found.indices]
    read = (found.weights[:, :, None] * near).sum(axis=1)
    nearest, mine = (np.median(np.abs(given - poses[500:]), axis=0) for given in (near[:, 0], read))
    assert (mine < 0.5 * nearest).all()


def test_what_is_no_view_is_refused() -> None:
    with pytest.raises(CogmapError, match="uint8 images"):
        image_codes(np.zeros((3, 60, 80)))


def test_larger_codes() -> None:
    views = np.random.default_rng(4).integers(0, 256, (2, 30, 40, 3), dtype=np.uint8)
    np.testing.assert_array_equal(image_codes(views, width=20, height=15), image_codes(views))
    fine = image_codes(views, width=40, height=10).reshape(2, 10, 40, 3)
    np.testing.assert_allclose(fine.mean(axis=(1, 2)), views.mean(axis=(1, 2)), atol=2)
