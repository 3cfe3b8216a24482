import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.evaluation.image_quality import psnr, ssim

GREY = np.full((2, 20, 30, 3), 100, np.uint8)


def test_known_values() -> None:
    np.testing.assert_allclose(psnr(GREY, GREY + 5), 20 * np.log10(255 / 5))
    np.testing.assert_allclose(psnr(GREY, GREY), 100)
    # of even images only the luminance differs
    luminance = (2 * 100 * 150 + 2.55**2) / (100**2 + 150**2 + 2.55**2)
    np.testing.assert_allclose(ssim(GREY, GREY + 50), luminance, rtol=1e-6)


def test_noise_is_less_like_than_a_shade() -> None:
    view = np.random.default_rng(0).integers(60, 200, (1, 40, 60, 3), np.uint8)
    noise = np.where(np.random.default_rng(1).random(view.shape) < 0.5, 10, -10)
    assert ssim(view, view)[0] == pytest.approx(1)
    assert ssim(view, (view + noise).astype(np.uint8))[0] < ssim(view, view + 10)[0] < 1


def test_unequal_numbers_are_refused() -> None:
    for measure in (psnr, ssim):
        with pytest.raises(CogmapError, match="give pairs"):
            measure(GREY, GREY[:1])
