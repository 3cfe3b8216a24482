"""Optical flow between panoramas, which have no border on the left or on the right."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

MARGIN = 16
"""Columns that are wrapped around on both sides; flow between near places is shorter."""


def panoramic_flow(
    first: UInt8[np.ndarray, "height width 3"], second: UInt8[np.ndarray, "height width 3"]
) -> Float32[np.ndarray, "height width 2"]:
    """Give where each pixel of the first panorama is found in the second: (columns, rows) farther.

    References
    ----------
    Kroeger, Timofte, Dai & Van Gool (2016), Fast optical flow using dense inverse search.
    """
    search = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_ULTRAFAST)
    # at half the resolution: a quarter, the preset's own, doubles the error of a dream's place
    search.setFinestScale(1)
    grey = [wrapped(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY)) for view in (first, second)]
    flow = search.calc(grey[0], grey[1], np.zeros((*grey[0].shape, 2), np.float32))
    return np.asarray(flow[:, MARGIN:-MARGIN], np.float32)


def wrapped(image: np.ndarray) -> np.ndarray:
    """Continue a panorama on both sides by `MARGIN` columns."""
    return np.asarray(cv2.copyMakeBorder(image, 0, 0, MARGIN, MARGIN, cv2.BORDER_WRAP))
