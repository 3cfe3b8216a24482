"""Image codes: views as small blurred pictures, which change smoothly from pose to pose."""

from typing import Any

import cv2
import numpy as np
from jaxtyping import Float32
from sklearn.utils import gen_batches

from cogmap.inputs import checked_views
from cogmap.threads import one_thread

WIDTH, HEIGHT = 20, 15
"""Pixels of a code."""


def image_codes(
    views: Any, *, width: int = WIDTH, height: int = HEIGHT
) -> Float32[np.ndarray, "views features"]:
    """Reduce each view to a few pixels of three colours: means over twice as many, blurred by one of these.

    Noise of single pixels averages out, and a step of the camera that moves edges by a fraction of a pixel of
    the code changes it in proportion. Views are read block by block and may lie on disk.

    Parameters
    ----------
    views
        (views, height, width, 3) uint8.
    width, height
        Pixels of a code, 20×15 unless told. More tell small steps between views that are near anyhow; codes
        of views farther apart are then all equally unlike.

    Raises
    ------
    CogmapError
        For views that are not uint8 images (views, height, width, 3).
    """
    views = checked_views(views)
    codes = np.empty((views.shape[0], 3 * width * height), np.float32)
    with one_thread():
        for block in gen_batches(len(codes), 256):
            for code, view in zip(codes[block], np.asarray(views[block]), strict=True):
                # Averaged to twice the size first: a blur of one pixel of the code costs little there.
                fine = cv2.resize(
                    view.astype(np.float32), (2 * width, 2 * height), interpolation=cv2.INTER_AREA
                )
                blurred = cv2.GaussianBlur(fine, (0, 0), 1.0)
                code[:] = cv2.resize(blurred, (width, height), interpolation=cv2.INTER_AREA).ravel()
    return codes


def sharp_codes(views: Any) -> Float32[np.ndarray, "views features"]:
    """Code views so finely that they tell small steps between views which are known to be near."""
    height, width = views.shape[1:3]
    return image_codes(views, width=width // 2, height=min(height, width // 2))
