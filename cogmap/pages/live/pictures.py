"""Pictures as a browser takes them: data URLs of what is seen, and of what surprises in it."""

from __future__ import annotations

import base64

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from matplotlib import colormaps

QUALITY = 88
"""Of JPEG, in which 360×60 pixels take some 10 KB and half a millisecond."""
MOST = 6.0
"""Surprise that is painted brightest, in units of what is usual."""
_HEAT = (255 * colormaps["inferno"](np.arange(256))[:, :3]).round().astype(np.uint8)


def data_url(view: UInt8[np.ndarray, "height width 3"], quality: int = QUALITY) -> str:
    """Write an RGB image as a data URL."""
    _, jpeg = cv2.imencode(".jpg", view[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
    return "data:image/jpeg;base64," + base64.b64encode(jpeg.tobytes()).decode()


def heat(unusual: Float[np.ndarray, "height width"]) -> UInt8[np.ndarray, "height width 3"]:
    """Paint surprise, from dark (as usual) to bright."""
    painted: np.ndarray = _HEAT[np.clip(unusual * (255 / MOST), 0, 255).astype(np.uint8)]
    return painted


def packed(values: np.ndarray) -> str:
    """Write the bytes of an array in base64, as JavaScript unpacks them."""
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode()
