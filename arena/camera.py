"""The eye: an upright camera on the body, perspective or panoramic."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from jaxtyping import Float, UInt8
from pydantic import Field

from arena import raycast
from arena.arena import Arena
from arena.errors import ArenaError
from arena.materials import texture, weave
from arena.settings import Settings

Images = UInt8[np.ndarray, "views height width 3"]
Poses = Float[np.ndarray, "views 3"]


class Camera(Settings):
    """An upright camera looking along the body's heading, horizon in the middle row.

    A perspective camera projects onto a plane; its focal length is width / (2 tan(field_of_view / 2)) pixels.
    A panoramic one projects onto a cylinder with square pixels, focal length width / 2π: its centre column
    looks straight ahead, column 0 straight back over the left shoulder. Pixel centres lie at half integers.

    Parameters
    ----------
    projection
        "perspective" or "panoramic".
    width, height
        Pixels.
    field_of_view
        Horizontal, rad; 2π for a panoramic camera.
    eye_height
        Above the floor, m.

    Raises
    ------
    ArenaError
        For sizes that are not positive, or a field of view that the projection cannot have.
    """

    projection: Literal["perspective", "panoramic"]
    width: Annotated[int, Field(gt=0, le=8192)]
    height: Annotated[int, Field(gt=0, le=8192)]
    field_of_view: Annotated[float, Field(gt=0)]
    eye_height: Annotated[float, Field(gt=0, le=1e3)] = 0.3

    def __init__(self, **fields: object) -> None:
        super().__init__(**fields)
        angle = self.field_of_view
        if self.projection == "perspective" and angle >= np.pi:
            raise ArenaError(
                f"field_of_view is {angle:g} rad; a perspective camera needs one below π: "
                "use Camera.panoramic to look all around"
            )
        if self.projection == "panoramic" and angle != 2 * np.pi:
            raise ArenaError(f"field_of_view is {angle:g} rad; a panoramic camera looks all around, 2π")

    @classmethod
    def perspective(
        cls,
        width: int = 320,
        height: int = 240,
        *,
        field_of_view: float = np.pi / 2,
        eye_height: float = 0.3,
    ) -> Camera:
        """Make a pinhole camera; `field_of_view` (rad) below π."""
        return cls(
            projection="perspective",
            width=width,
            height=height,
            field_of_view=field_of_view,
            eye_height=eye_height,
        )

    @classmethod
    def panoramic(cls, width: int = 360, height: int = 60, *, eye_height: float = 0.3) -> Camera:
        """Make a camera that sees all around."""
        return cls(
            projection="panoramic",
            width=width,
            height=height,
            field_of_view=2 * np.pi,
            eye_height=eye_height,
        )

    @property
    def focal_length(self) -> float:
        """Pixels per unit of tangent (perspective) or per radian (panoramic)."""
        if self.projection == "panoramic":
            return self.width / (2 * np.pi)
        return self.width / (2 * math.tan(self.field_of_view / 2))

    def render(self, arena: Arena, poses: Poses) -> Images:
        """Paint what the camera sees from each pose (m, m, rad).

        Each pixel is the mean of the texture over the area it covers; the same poses give the same bits
        whatever the number of threads.

        Raises
        ------
        ArenaError
            For poses that are not finite.
        """
        floor = texture(arena.floor).mean((0, 1)) if isinstance(arena.floor, str) else arena.floor
        plain = np.array([floor, arena.ceiling], np.float32)
        paints = raycast.Paints(*weave(arena.surfaces.materials), *plain)
        out = np.empty((len(poses), self.height, self.width, 3), np.uint8)
        raycast.render(_checked(poses), _faces(arena), paints, self._lens, out)
        return out

    def depth(self, arena: Arena, poses: Poses) -> Float[np.ndarray, "views width"]:
        """Distance (m) along the middle ray of each column to the nearest face of any height, else infinity.

        Raises
        ------
        ArenaError
            For poses that are not finite.
        """
        out = np.empty((len(poses), self.width))
        raycast.depths(_checked(poses), _faces(arena), self._lens, out)
        return out

    @property
    def _lens(self) -> raycast.Lens:
        return raycast.Lens(self.width, self.focal_length, self.eye_height, self.projection == "panoramic")


def _faces(arena: Arena) -> raycast.Faces:
    return raycast.Faces(*arena.surfaces[:6])


def _checked(poses: Poses) -> Float[np.ndarray, "views 3"]:
    if not np.isfinite(poses).all():
        bad = int(np.flatnonzero(~np.isfinite(poses).all(axis=1))[0])
        raise ArenaError(f"pose {bad} is {poses[bad]}; give finite x, y (m) and heading (rad)")
    return np.ascontiguousarray(poses, dtype=np.float64)
