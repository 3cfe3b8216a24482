import cv2
import numpy as np
import pytest

from cogmap.imagination.flow import panoramic_flow


@pytest.mark.parametrize("shift", [3, -4])
def test_flow_goes_around_the_circle(shift: int) -> None:
    grey = np.random.default_rng(0).integers(0, 256, (60, 360)).astype(np.float32)
    smooth = cv2.GaussianBlur(np.tile(grey, (1, 3)), (0, 0), 2.5)[:, 360:720]
    view = np.repeat(cv2.normalize(smooth, None, 0, 255, cv2.NORM_MINMAX)[:, :, None], 3, 2).astype(np.uint8)
    flow = panoramic_flow(view, np.roll(view, shift, axis=1))
    edge = np.r_[0:8, 352:360]
    for columns in (edge, np.arange(8, 352)):
        np.testing.assert_allclose(np.median(flow[:, columns, 0]), shift, atol=0.05)
        np.testing.assert_allclose(np.median(flow[:, columns, 1]), 0, atol=0.05)
