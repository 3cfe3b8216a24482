"""Lenses of other people's cameras: how their pictures become views as `arena.Camera` takes them."""

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, get_args

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from pydantic import Field

from arena.errors import ArenaError
from arena.recordings.colours import Picture
from arena.settings import Settings

Kind = Literal["equirectangular", "cylindrical", "mirror", "perspective"]
Coordinates = Float[np.ndarray, "height width"]
View = UInt8[np.ndarray, "rows columns 3"]
Look = Callable[[Picture], View]
_Pixels = Annotated[int, Field(gt=0, le=8192)]


class Lens(Settings):
    """What pictures show, and what they are to be turned into.

    Views are smaller than pictures by whole areas: a pixel is the mean of what it covers. Panoramas are
    cylinders, whose centre column looks straight ahead and whose horizon is the middle row.

    Parameters
    ----------
    kind
        `equirectangular`: columns are azimuth and rows elevation, in steps of the same angle, with the
        horizon in the middle, as cameras that look all around give them; the view is a cylinder with square
        pixels, of which a row is where the tangent of its elevation is. `cylindrical`: a cylinder already.
        `mirror`: the ring that a camera sees in a mirror above or below it, unrolled; rows are even steps of
        its radius. `perspective`, and None, which tells nothing of the camera: as they are.
    width, height
        Of the views, pixels. Unless told they are those of the picture, or keep their ratio; the cylinder of
        an equirectangular picture is a sixth as high as it is wide and sees 27.6° up and down, as
        `arena.Camera.panoramic` does; the ring of a mirror is as wide as it is long in its middle.
    ahead
        Where straight ahead is in a panorama, in degrees to the right of its centre column, or in the ring of
        a mirror clockwise from the top. A cylinder is turned by whole columns.
    clockwise
        Whether what lies to the right of straight ahead is on its right in the picture (in the ring of a
        mirror: clockwise from it). A camera that looks up into a mirror sees the world the other way round.
    mirror
        x and y of the ring's centre, from the upper left corner, and the radii of the lowest and the highest
        row, pixels.

    Raises
    ------
    ArenaError
        For values out of range or at odds with each other.
    """

    kind: Kind | None = None
    width: _Pixels | None = None
    height: _Pixels | None = None
    ahead: Annotated[float, Field(ge=-360, le=360)] = 0.0
    clockwise: bool = True
    mirror: tuple[float, float, float, float] | None = None

    def __init__(self, **fields: object) -> None:
        kind = fields.get("kind")
        if isinstance(kind, str) and kind not in get_args(Kind):
            raise ArenaError(
                f"there is no kind of picture {kind!r}; choose one of {', '.join(get_args(Kind))}"
            )
        super().__init__(**fields)
        if (self.kind == "mirror") != (self.mirror is not None):
            raise ArenaError(
                f"the kind is {self.kind} and the mirror {self.mirror}; a mirror needs both: kind mirror, "
                "and x and y of the ring's centre and the radii of its lowest and its highest row"
            )
        if not self._panoramic and (self.ahead or not self.clockwise):
            raise ArenaError(
                "ahead and clockwise are of panoramas; say which kind they are, or leave them out"
            )
        if self.mirror is not None and (min(self.mirror[2:]) < 0 or self.mirror[2] == self.mirror[3]):
            raise ArenaError(
                f"the radii of the mirror's ring are {self.mirror[2:]}; give two that differ, ≥ 0"
            )

    @property
    def _panoramic(self) -> bool:
        return self.kind not in {None, "perspective"}

    def camera(self, height: int, width: int) -> dict[str, Any]:
        """Tell what camera would take such views, by the names that `arena.Camera` has for it."""
        told: dict[str, Any] = {"kind": "pictures", "width": width, "height": height}
        if self._panoramic:
            return told | {"projection": "panoramic", "field_of_view": 2 * math.pi}
        return told if self.kind is None else told | {"projection": "perspective"}

    def fitted(self, height: int, width: int) -> Look:
        """Give what turns pictures of this size into views; it may be called from several threads.

        Raises
        ------
        ArenaError
            When the views would show what the pictures do not.
        """
        if self.kind == "equirectangular":
            rows, columns = self._size(round((self.width or width) / 6), width, keep=False)
            times = math.ceil(max(width / columns, 1))
            at = self._on_sphere(height, width, rows * times, columns * times)
            return _looked_up(at, times, cv2.BORDER_WRAP)  # past the last column comes the first
        if self.mirror is not None:
            x, y, low, high = self.mirror
            if not (0 <= x <= width and 0 <= y <= height):
                raise ArenaError(
                    f"the mirror's centre ({x:g}, {y:g}) is not in pictures of {width}×{height} pixels"
                )
            deep, around = abs(high - low), math.pi * (low + high)
            rows, columns = self._size(max(round(deep), 1), max(round(around), 1))
            # So that no pixel is passed over, even where the ring is longest.
            times = math.ceil(max(2 * math.pi * max(low, high) / columns, deep / rows, 1))
            at = self._on_ring(self.mirror, rows * times, columns * times)
            return _looked_up(
                at, times, cv2.BORDER_CONSTANT
            )  # a ring cut by the picture's edge is black there
        rows, columns = self._size(height, width)
        turned = None
        if self.kind == "cylindrical":
            shift, order = round(self.ahead / 360 * width), np.arange(width)
            turned = ((order if self.clockwise else order[::-1]) + shift) % width

        def look(picture: Picture) -> View:
            return _by_area(picture if turned is None else picture[:, turned], rows, columns)

        return look

    def _size(self, height: int, width: int, *, keep: bool = True) -> tuple[int, int]:
        """Give rows and columns of the views, of which unless told there are so many, or in this ratio."""
        rows, columns = self.height, self.width
        if keep and rows is None and columns is not None:
            rows = max(round(height * columns / width), 1)
        if keep and columns is None and rows is not None:
            columns = max(round(width * rows / height), 1)
        return max(rows or height, 1), columns or width

    def _turns(self, columns: int) -> Float[np.ndarray, " columns"]:
        """Give where the columns look in the picture, rad to the right of its centre column."""
        right = ((np.arange(columns) + 0.5) / columns - 0.5) * 2 * np.pi
        turns: np.ndarray = np.deg2rad(self.ahead) + (right if self.clockwise else -right)
        return turns

    def _on_sphere(self, height: int, width: int, rows: int, columns: int) -> tuple[Coordinates, Coordinates]:
        """Say where in an equirectangular picture each pixel of a cylinder looks."""
        per_radian = width / (2 * np.pi)
        if height > width / 2 + 1:
            raise ArenaError(
                f"the pictures have {width}×{height} pixels; equirectangular ones are at most half as high "
                "as wide, with the same angle from row to row as from column to column"
            )
        edge = math.atan(rows / columns * np.pi)
        if edge * per_radian > height / 2 + 0.5:
            seen = math.degrees(height / 2 / per_radian)
            raise ArenaError(
                f"the views would see {math.degrees(edge):.1f}° up and down and the pictures see "
                f"{seen:.1f}°; make them less high"
            )
        slope = (rows / 2 - (np.arange(rows) + 0.5)) * (2 * np.pi / columns)
        x = width / 2 + self._turns(columns) * per_radian
        y = np.clip(height / 2 - np.arctan(slope) * per_radian, 0.5, height - 0.5)
        across, down = np.meshgrid(x % width, y)
        return across, down

    def _on_ring(
        self, ring: tuple[float, float, float, float], rows: int, columns: int
    ) -> tuple[Coordinates, Coordinates]:
        """Say where in the picture of a mirror each pixel of a cylinder looks."""
        x, y, low, high = ring
        radius = (high + (np.arange(rows) + 0.5) / rows * (low - high))[:, None]
        turn = self._turns(columns)
        return x + radius * np.sin(turn), y - radius * np.cos(turn)


def _looked_up(at: tuple[Coordinates, Coordinates], times: int, border: int) -> Look:
    """Make what looks up pixels at coordinates, so many times finer than the views are, and takes means."""
    x, y = at
    # OpenCV counts from the middle of the first pixel.
    maps = cv2.convertMaps((x - 0.5).astype(np.float32), (y - 0.5).astype(np.float32), cv2.CV_16SC2)
    rows, columns = x.shape[0] // times, x.shape[1] // times

    def look(picture: Picture) -> View:
        fine = cv2.remap(picture, *maps, cv2.INTER_LINEAR, borderMode=border)
        return _by_area(np.asarray(fine), rows, columns)

    return look


def _by_area(picture: Picture, rows: int, columns: int) -> View:
    if picture.shape[:2] == (rows, columns):
        return np.ascontiguousarray(picture)
    return np.asarray(cv2.resize(picture, (columns, rows), interpolation=cv2.INTER_AREA))
