"""A real camera: what lens, mount, sensor and file format do to the pictures of an ideal one.

All pictures are (views, height, width, 3) uint8. Panoramas are cylinders with square pixels, horizon in the
middle row, as those of `arena.Camera.panoramic`: the centre column looks straight ahead.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from cogmap.errors import CogmapError
from cogmap.inputs import checked_views
from cogmap.threads import one_thread

FINER = 8
"""Most rays along each side of a pixel, whose mean it is."""


@dataclass(frozen=True)
class RealCamera:
    """What happens to a picture between the lens and the file, in this order.

    Parameters
    ----------
    tilt
        Of a panoramic camera on an uneven floor, rad: pitch and roll are uniform within ± it.
    exposure
        Brightness is multiplied by a number uniform in 1 ± it, anew for each view.
    blur
        Of the lens: standard deviation, pixels.
    noise
        Of the sensor: standard deviation of each value, as a share of the brightest grey level.
    quality
        Of JPEG, 0–100; not compressed when None.
    wraps
        Whether the last column continues in the first.

    Raises
    ------
    CogmapError
        From `photograph`, for a tilt of views that do not wrap, and for views that are not uint8 images.
    """

    tilt: float = 0.0
    exposure: float = 0.0
    blur: float = 0.0
    noise: float = 0.0
    quality: int | None = None
    wraps: bool = True

    def photograph(self, views: Any, rng: np.random.Generator) -> UInt8[np.ndarray, "views height width 3"]:
        """Give what the camera makes of what an ideal one sees, (views, height, width, 3) uint8."""
        views = checked_views(views)
        if self.tilt and not self.wraps:
            raise CogmapError(
                f"tilt is {self.tilt:g} rad but these views do not wrap; tilt panoramas, and crop them"
            )
        taken = np.empty(views.shape, np.uint8)
        with one_thread():
            for number, out in enumerate(taken):
                out[:] = self._take(np.asarray(views[number]), rng)
        return taken

    def _take(
        self, view: UInt8[np.ndarray, "height width 3"], rng: np.random.Generator
    ) -> UInt8[np.ndarray, "height width 3"]:
        # all is drawn for each view, so that one that is varied leaves the others as they were
        pitch, roll, brighter = rng.uniform(-1, 1, 3)
        grain = rng.standard_normal(view.shape, np.float32)
        if self.tilt:
            view = tilted(view, self.tilt * pitch, self.tilt * roll)
        light = view * np.float32(1 + self.exposure * brighter)
        light = self._blurred(light) + 255 * np.float32(self.noise) * grain
        picture = np.asarray(np.rint(np.clip(light, 0, 255)), np.uint8)
        if self.quality is None:
            return picture
        file = cv2.imencode(".jpg", picture[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, self.quality])[1]
        return np.asarray(cv2.imdecode(file, cv2.IMREAD_COLOR), np.uint8)[:, :, ::-1]

    def _blurred(self, light: Float[np.ndarray, "height width 3"]) -> Float[np.ndarray, "height width 3"]:
        if not self.blur:
            return light
        border = int(np.ceil(4 * self.blur)) if self.wraps else 0
        padded = np.pad(light, ((0, 0), (border, border), (0, 0)), mode="wrap")
        blurred = cv2.GaussianBlur(padded, (0, 0), self.blur, borderType=cv2.BORDER_REPLICATE)
        return np.asarray(blurred)[:, border : border + light.shape[1]]


def tilted(
    panorama: UInt8[np.ndarray, "height width 3"], pitch: float, roll: float
) -> UInt8[np.ndarray, "height width 3"]:
    """Tilt a panoramic camera: up in front by `pitch`, and down on the right by `roll`, both in rad.

    What comes into sight beyond the upper and lower edge is taken for what is seen at the edge.
    """
    height, width, _ = panorama.shape
    focal = width / (2 * np.pi)
    azimuth = np.pi - (np.arange(width) + 0.5) / focal
    rise = (height / 2 - np.arange(height) - 0.5) / focal
    rays = np.empty((height, width, 3))
    rays[:, :, 0], rays[:, :, 1], rays[:, :, 2] = np.cos(azimuth), np.sin(azimuth), rise[:, None]
    up, over = np.array([np.cos([pitch, roll]), np.sin([pitch, roll])]).T
    pitched = np.array([[up[0], 0, -up[1]], [0, 1, 0], [up[1], 0, up[0]]])
    rolled = np.array([[1, 0, 0], [0, over[0], -over[1]], [0, over[1], over[0]]])
    columns, rows = _where(panorama.shape, rays @ (pitched @ rolled).T)
    # one column more on either side, for what lies between the last and the first
    around = np.pad(panorama, ((0, 0), (1, 1), (0, 0)), mode="wrap")
    return _sampled(around, columns + 1, rows)


def crops(
    panorama: UInt8[np.ndarray, "height width 3"],
    yaws: Float[np.ndarray, "crops"],
    *,
    width: int = 160,
    height: int = 120,
    field_of_view: float = np.pi / 2,
) -> UInt8[np.ndarray, "crops rows columns 3"]:
    """Cut perspective views from a panorama: what a camera sees that spins on the spot.

    Each pixel is the mean over its area.

    Parameters
    ----------
    panorama
        Wide enough for its pixels to be no larger than those of the views.
    yaws
        Headings of the views, counter-clockwise from straight ahead, rad.
    width, height
        Pixels of the views.
    field_of_view
        Horizontal, rad, below π.

    Raises
    ------
    CogmapError
        For a panorama that does not reach as far up and down as the views.
    """
    focal, cylinder = width / (2 * np.tan(field_of_view / 2)), panorama.shape[1] / (2 * np.pi)
    if height / focal > panorama.shape[0] / cylinder + 1e-9:
        raise CogmapError(
            f"views of {height} rows reach beyond a panorama of {panorama.shape[0]}; "
            f"cut at most {int(panorama.shape[0] / cylinder * focal)} rows, or take a higher panorama"
        )
    finer = int(np.clip(round(cylinder / focal), 1, FINER))
    x = ((np.arange(width * finer) + 0.5) / finer - width / 2) / focal
    y = ((np.arange(height * finer) + 0.5) / finer - height / 2) / focal
    ahead = np.stack(np.broadcast_arrays(1.0, -x, -y[:, None]), axis=2)
    columns, rows = _where(panorama.shape, ahead)
    around = np.concatenate([panorama, panorama[:, : panorama.shape[1] // 2 + 2]], axis=1)
    views = np.empty((len(yaws), height, width, 3), np.uint8)
    with one_thread():
        for yaw, view in zip(yaws, views, strict=True):
            # all lies within half a turn, and begins at the left edge
            shift = np.mod(columns[0, 0] - yaw * cylinder, panorama.shape[1]) - columns[0, 0]
            seen = _sampled(around, columns + shift, rows)
            view[:] = cv2.resize(seen, (width, height), interpolation=cv2.INTER_AREA)
    return views


def _where(
    shape: tuple[int, ...], rays: Float[np.ndarray, "rows columns 3"]
) -> tuple[Float[np.ndarray, "rows columns"], Float[np.ndarray, "rows columns"]]:
    """Tell in which column and row of a panorama rays end that go ahead, left and up."""
    focal = shape[1] / (2 * np.pi)
    columns = (np.pi - np.arctan2(rays[:, :, 1], rays[:, :, 0])) * focal - 0.5
    rows = shape[0] / 2 - focal * rays[:, :, 2] / np.hypot(rays[:, :, 0], rays[:, :, 1]) - 0.5
    return columns, rows


def _sampled(
    image: UInt8[np.ndarray, "height width 3"],
    columns: Float[np.ndarray, "rows columns"],
    rows: Float[np.ndarray, "rows columns"],
) -> UInt8[np.ndarray, "rows columns 3"]:
    where = columns.astype(np.float32), rows.astype(np.float32)
    return np.asarray(cv2.remap(image, *where, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE))
