import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError
from cogmap.features.seam import seam_is_open, wraps_around

ROOM = Arena.load("furnished")


def poses(count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    return np.column_stack([rng.uniform(-1, 1, size=(count, 2)), rng.uniform(-np.pi, np.pi, size=count)])


def test_panorama_goes_on_behind_its_last_column() -> None:
    noise = np.random.default_rng(1)
    views = Camera.panoramic(90, 15, noise=0.02).render(ROOM, poses(200), rng=noise)
    assert wraps_around(views)
    assert not wraps_around(views[:, :, :60])


def test_picture_has_borders() -> None:
    assert not wraps_around(Camera.perspective(64, 48).render(ROOM, poses(200)))


def test_still_background_is_no_seam() -> None:
    views = np.full((100, 20, 40, 3), 90, np.uint8)
    for view, column in zip(views, np.random.default_rng(2).integers(5, 30, size=100), strict=True):
        view[5:15, column : column + 5] = 200
    assert not wraps_around(views)
    assert not wraps_around(np.full((10, 20, 40, 3), 90, np.uint8))


def test_what_are_no_images() -> None:
    with pytest.raises(CogmapError, match="give uint8 images"):
        wraps_around(np.zeros((3, 4, 5)))


def test_what_has_a_seam_that_is_clearly_open() -> None:
    views = Camera.panoramic(90, 15).render(ROOM, poses(200))
    assert not seam_is_open(views)
    assert seam_is_open(views[:, :, :60])
    assert seam_is_open(Camera.perspective(64, 48).render(ROOM, poses(200)))


def test_of_noise_and_of_still_views_neither_is_so() -> None:
    noise = np.random.default_rng(3).integers(0, 256, size=(50, 15, 90, 3)).astype(np.uint8)
    still = np.repeat(Camera.perspective(64, 48).render(ROOM, poses(1)), 20, axis=0)
    for views in (noise, still):
        assert not seam_is_open(views)


def test_lazy_views_need_know_slices_alone() -> None:
    class Painted:
        dtype = np.dtype(np.uint8)

        def __init__(self, views: np.ndarray) -> None:
            self._views, self.shape = views, views.shape

        def __getitem__(self, rows: slice) -> np.ndarray:
            assert isinstance(rows, slice)
            return self._views[rows]

    views = Camera.panoramic(90, 15).render(ROOM, poses(60))
    assert wraps_around(Painted(views)) == wraps_around(views)
    assert not seam_is_open(Painted(views))
