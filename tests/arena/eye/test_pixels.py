import numpy as np

from arena.eye.background import backdrop
from arena.eye.camera import Camera
from arena.eye.pixels import emit, emit_words, fill


def test_words_and_bytes_make_the_same_image() -> None:
    rng = np.random.default_rng(0)
    quad = rng.integers(0, 256, (4, 4 * 10)).astype(np.uint8)
    quad[:, 3::4] = 0
    plain, fast = np.zeros((2, 10, 8, 3), np.uint8)
    for c in (0, 4):
        emit(quad, c, 4, (2, 9), plain)
        emit_words(quad.view(np.uint32), c, (2, 9), fast.reshape(10, 24).view(np.uint32))
    np.testing.assert_array_equal(plain, fast)
    np.testing.assert_array_equal(plain[2:9, 4:], quad.reshape(4, 10, 4)[:, 2:9, :3].swapaxes(0, 1))
    assert not plain[[0, 1, 9]].any()


def test_rows_of_nothing_but_backdrop() -> None:
    for zenith in (None, (1, 2, 3)):
        camera = Camera.perspective(8, 6)
        sky = backdrop(camera._optics[0], (10, 20, 30), (100, 110, 120), zenith)
        plain, fast = np.zeros((2, 6, 8, 3), np.uint8)
        fill(1, 6, sky, plain, np.empty((0, 0), np.uint32))
        fill(1, 6, sky, fast, fast.reshape(6, 24).view(np.uint32))
        np.testing.assert_array_equal(plain, fast)
        wanted = np.broadcast_to(sky[:, :24].reshape(-1, 6, 4)[..., :3], (8, 6, 3)).swapaxes(0, 1)
        np.testing.assert_array_equal(plain[1:], wanted[1:])
        assert not plain[0].any()
