"""Image quality (PSNR, SSIM): how like an imagined view is to the one that is seen."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from cogmap.errors import CogmapError

Views = UInt8[np.ndarray, "views height width 3"]
Others = UInt8[np.ndarray, "others rows columns 3"]


def psnr(first: Views, second: Others) -> Float[np.ndarray, "views"]:
    """Peak signal-to-noise ratio of each pair of views, dB; 100 where they are equal."""
    _check(first, second)
    pairs = zip(first, second, strict=True)
    errors = np.array([np.square(a.astype(np.float64) - b).mean() for a, b in pairs])
    return np.asarray(10 * np.log10(255**2 / np.maximum(errors, 255**2 / 1e10)))


def ssim(first: Views, second: Others) -> Float[np.ndarray, "views"]:
    """Structural similarity of each pair of views: mean over pixels and colours, 1 where they are equal.

    References
    ----------
    Wang, Bovik, Sheikh & Simoncelli (2004), Image quality assessment: windows of 11 pixels, σ = 1.5.
    """
    _check(first, second)
    return np.array([_similarity(a, b) for a, b in zip(first, second, strict=True)])


def _similarity(
    first: UInt8[np.ndarray, "height width 3"], second: UInt8[np.ndarray, "height width 3"]
) -> float:
    a, b = first.astype(np.float64), second.astype(np.float64)
    mean_a, mean_b, square_a, square_b, product = (
        np.asarray(cv2.GaussianBlur(image, (11, 11), 1.5)) for image in (a, b, a * a, b * b, a * b)
    )
    products, squares = mean_a * mean_b, mean_a**2 + mean_b**2
    luminance = (2 * products + (0.01 * 255) ** 2) / (squares + (0.01 * 255) ** 2)
    structure = (2 * (product - products) + (0.03 * 255) ** 2) / (
        square_a + square_b - squares + (0.03 * 255) ** 2
    )
    return float((luminance * structure).mean())


def _check(first: Views, second: Others) -> None:
    if first.shape != second.shape or not first.size:
        raise CogmapError(f"views of shape {first.shape} cannot be compared with {second.shape}; give pairs")
