"""Optical flow between panoramas, which have no border on the left or on the right."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

MARGIN = 16
"""Columns that are wrapped around on both sides; flow between near places is shorter."""

ROWS = 32
"""To which a panorama of fewer is enlarged."""


def panoramic_flow(
    first: UInt8[np.ndarray, "height width 3"], second: UInt8[np.ndarray, "height width 3"]
) -> Float32[np.ndarray, "height width 2"]:
    """Give where each pixel of the first panorama is found in the second: (columns, rows) farther.

    References
    ----------
    Kroeger, Timofte, Dai & Van Gool (2016), Fast optical flow using dense inverse search.
    """
    # Faster presets end at a quarter of the resolution, which doubles the error of a dream's place, or find
    # less of what moves far, beside a box.
    search = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    search.setPatchStride(2)
    # of fewer rows than two patches at that resolution the search reads beyond the image
    times = -(-ROWS // len(first))
    grey = [_enlarged(wrapped(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY)), times) for view in (first, second)]
    flow = search.calc(grey[0], grey[1], np.zeros((*grey[0].shape, 2), np.float32))
    middle = slice(times // 2, None, times)
    return np.asarray(flow[middle, middle][:, MARGIN:-MARGIN] / times, np.float32)


def _enlarged(image: np.ndarray, times: int) -> np.ndarray:
    if times == 1:
        return image
    return np.asarray(cv2.resize(image, None, fx=times, fy=times, interpolation=cv2.INTER_CUBIC))


def wrapped(image: np.ndarray) -> np.ndarray:
    """Continue a panorama on both sides by `MARGIN` columns."""
    return np.asarray(cv2.copyMakeBorder(image, 0, 0, MARGIN, MARGIN, cv2.BORDER_WRAP))
