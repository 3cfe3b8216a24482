import cv2
import numpy as np
import pytest
import torch
from scipy.ndimage import gaussian_filter1d
from torch import Tensor

from neurons.errors import NeuronsError
from neurons.layers.retina import Retina


def scenes(count: int, height: int, width: int, seed: int = 0) -> Tensor:
    """Panoramas of smooth, even-valued patches."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(count, height, width, 3))
    smooth = gaussian_filter1d(gaussian_filter1d(noise, 2, axis=1), width / 60, axis=2, mode="wrap")
    return torch.from_numpy(
        (2 * np.clip(60 + 25 * smooth / smooth.std(), 0, 127).astype(int)).astype(np.uint8)
    )


def ring_blur(strip: np.ndarray, sigma: float) -> np.ndarray:
    return gaussian_filter1d(strip, sigma, axis=-1, mode="wrap", radius=45)


def by_opencv_and_scipy(view: np.ndarray, faintest: float = 0.0) -> np.ndarray:
    small = cv2.resize(view.astype(np.float64), (90, 15), interpolation=cv2.INTER_AREA)
    colours = small.transpose(0, 2, 1).reshape(45, 90)
    strip = ring_blur(colours, 3.0) - ring_blur(colours, 10.0)
    contrast = np.sqrt(ring_blur((strip**2).mean(axis=0), 2.0))
    return ring_blur(strip / (contrast + 0.1 * contrast.mean() + faintest), 3.0).ravel()


@pytest.mark.parametrize(("height", "width"), [(15, 90), (30, 360), (37, 200), (240, 1440), (30, 200)])
def test_same_as_opencv_and_scipy(height: int, width: int) -> None:
    views = scenes(3, height, width)
    strips = Retina(height, width)(views).numpy()
    trusted = np.array([by_opencv_and_scipy(view) for view in views.numpy()])
    np.testing.assert_allclose(strips, trusted, atol=2e-3)
    assert trusted.std() > 0.1


@pytest.mark.parametrize(("height", "width"), [(15, 90), (60, 360), (240, 1440), (64, 200)])
def test_no_weight_is_subnormal(height: int, width: int) -> None:
    # a product takes fifty times as long where one is
    for weights in Retina(height, width).buffers():
        assert not ((weights != 0) & (weights.abs() < torch.finfo(torch.float32).tiny)).any()


def test_the_brightest_views_overflow_no_sum() -> None:
    views = scenes(2, 240, 1440) // 2 + 128
    strips = Retina(240, 1440)(views).numpy()
    trusted = np.array([by_opencv_and_scipy(view) for view in views.numpy()])
    np.testing.assert_allclose(strips, trusted, atol=2e-3)


def test_contrasts_too_faint_are_amplified_no_further() -> None:
    views = scenes(3, 15, 90)
    strips = Retina(15, 90, faintest=20.0)(views).numpy()
    trusted = np.array([by_opencv_and_scipy(view, faintest=20.0) for view in views.numpy()])
    np.testing.assert_allclose(strips, trusted, atol=2e-3)


def test_turning_rolls_the_columns() -> None:
    retina, views = Retina(20, 360), scenes(2, 20, 360)
    strips = retina(views).unflatten(1, (15, 3, 90))
    turned = retina(views.roll(4, dims=2)).unflatten(1, (15, 3, 90))
    torch.testing.assert_close(turned, strips.roll(1, dims=3), atol=1e-4, rtol=0)
    assert (turned - strips).abs().max() > 0.05


def test_brightness_and_contrast_do_not_matter() -> None:
    retina, views = Retina(20, 180), scenes(2, 20, 180)
    torch.testing.assert_close(retina(views // 2), retina(views), atol=1e-3, rtol=0)
    torch.testing.assert_close(retina(views // 2 + 100), retina(views), atol=1e-3, rtol=0)


def test_half_the_contrast_on_one_side_is_evened_out() -> None:
    retina = Retina(20, 360)
    views = scenes(1, 20, 360)
    dimmed = views.clone()
    dimmed[:, :, 180:] = dimmed[:, :, 180:] // 2 + 60
    amplitude = retina(dimmed).unflatten(1, (45, 90)).square().mean(dim=1).sqrt()[0]
    bright, dim = amplitude[10:35].mean(), amplitude[55:80].mean()
    assert 0.8 < dim / bright < 1.1


def test_black_view_is_silent() -> None:
    assert not Retina(33, 350)(torch.zeros(2, 33, 350, 3, dtype=torch.uint8)).any()


@pytest.mark.parametrize("grey", [77, 128, 255])
def test_uniform_view_is_silent(grey: int) -> None:
    view = torch.full((2, 33, 350, 3), grey, dtype=torch.uint8)
    assert Retina(33, 350)(view).abs().max() < 0.05


def test_batches_do_not_matter() -> None:
    retina, views = Retina(18, 120), scenes(37, 18, 120)
    whole = retina(views)
    assert whole.shape == (37, retina.features) == (37, 15 * 3 * 90)
    pieces = torch.cat([retina(views[:5]), retina(views[5:30]), retina(views[30:])])
    torch.testing.assert_close(pieces, whole, atol=1e-5, rtol=0)


@pytest.mark.parametrize(("height", "width"), [(14, 90), (15, 89)])
def test_too_few_pixels(height: int, width: int) -> None:
    with pytest.raises(NeuronsError, match=f"{height}×{width}.*at least 15×90"):
        Retina(height, width)


def up_to_the_borders(strip: np.ndarray, sigma: float) -> np.ndarray:
    """Blur, and divide by the blur of ones: what lies beyond weighs nothing."""
    blur = lambda line: gaussian_filter1d(line, sigma, axis=-1, mode="constant", radius=90)  # noqa: E731
    return blur(strip) / blur(np.ones_like(strip))


def test_without_wrap_nothing_is_seen_beyond_the_borders() -> None:
    retina = Retina(30, 200, columns=50, acuity=2.0, surround=8.0, pool=3.0, wrap=False)
    views = scenes(3, 30, 200)
    strips = retina(views).numpy()
    small = np.stack(
        [
            cv2.resize(view.astype(np.float64), (50, 15), interpolation=cv2.INTER_AREA)
            for view in views.numpy()
        ]
    )
    for strip, view in zip(strips, small, strict=True):
        colours = view.transpose(0, 2, 1).reshape(45, 50)
        centre = up_to_the_borders(colours, 2.0) - up_to_the_borders(colours, 8.0)
        contrast = np.sqrt(up_to_the_borders((centre**2).mean(axis=0), 3.0))
        trusted = up_to_the_borders(centre / (contrast + 0.1 * contrast.mean() + 0.002), 2.0)
        np.testing.assert_allclose(strip, trusted.ravel(), atol=2e-3)
    moved = views.clone()
    moved[:, :, 160:] = 0
    left = retina(moved).unflatten(1, (15, 3, 50))[..., :4]
    around = Retina(30, 200, columns=50, acuity=2.0, surround=8.0, pool=3.0)
    assert (left - retina(views).unflatten(1, (15, 3, 50))[..., :4]).abs().max() < 0.2
    there = (
        around(moved).unflatten(1, (15, 3, 50))[..., :4] - around(views).unflatten(1, (15, 3, 50))[..., :4]
    )
    assert there.abs().max() > 0.5
