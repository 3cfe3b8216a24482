import cv2
import numpy as np
import pytest
from sklearn.feature_extraction.image import extract_patches_2d

from cogmap.features.descriptors import keypoints, patches


def test_keypoints_are_the_roots_of_opencvs_sift(views: np.ndarray) -> None:
    found = keypoints(views[:5])
    assert found.values.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(found.values, axis=1), 1, atol=1e-5)
    first = 0
    for view, count in zip(views[:5], found.counts, strict=True):
        sift = cv2.SIFT_create().detectAndCompute(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY), None)[1]
        assert len(sift) == count > 0
        share = sift / np.abs(sift).sum(axis=1, keepdims=True)
        np.testing.assert_allclose(found.values[first : first + count] ** 2, share, atol=1e-6)
        first += count
    assert first == len(found.values)


def test_an_even_view_has_no_keypoints(views: np.ndarray) -> None:
    found = keypoints(np.stack([np.full_like(views[0], 90), views[0], np.zeros_like(views[0])]))
    assert found.counts[0] == found.counts[2] == 0
    assert found.counts[1] == len(found.values) > 0
    assert keypoints(np.zeros((2, 20, 20, 3), np.uint8)).values.shape == (0, 128)


def test_patches_are_quarters_of_windows() -> None:
    image = np.random.default_rng(0).integers(0, 256, size=(1, 80, 112, 3), dtype=np.uint8)
    found = patches(image)
    cells = np.round(image[0].reshape(5, 16, 7, 16, 3).mean(axis=(1, 3))) / 255
    lab = cv2.cvtColor(cells.astype(np.float32), cv2.COLOR_RGB2LAB)
    windows = extract_patches_2d(lab, (2, 2)).reshape(-1, 12)
    np.testing.assert_allclose(found.values, windows, atol=1e-3)
    np.testing.assert_array_equal(found.counts, [24])


@pytest.mark.parametrize("size", [(1, 1), (5, 40), (33, 31), (240, 320)])
def test_patches_of_any_size_of_one_colour(size: tuple[int, int]) -> None:
    image = np.broadcast_to(np.array([200, 30, 60], np.uint8), (3, *size, 3))
    found = patches(image)
    expected = cv2.cvtColor(image[:1, 0, :1].astype(np.float32) / 255, cv2.COLOR_RGB2LAB).ravel()
    np.testing.assert_allclose(found.values, np.tile(expected, (len(found.values), 4)), atol=1e-2)
    assert found.counts.tolist() == [len(found.values) // 3] * 3
