"""The eye: an upright camera on the body, perspective or panoramic."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import Annotated, Literal

import numba
import numpy as np
from jaxtyping import Float, Int32, UInt8
from pydantic import Field

from arena.errors import ArenaError
from arena.eye import raycast, render
from arena.eye.background import backdrop
from arena.eye.noise import Generators, add_noise
from arena.eye.projection import Lens, direction, unsound
from arena.rooms.arena import Arena
from arena.settings import AnyArray, Settings

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
    noise
        Standard deviation of the sensor's independent Gaussian noise, as a share of the brightest grey level.

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
    noise: Annotated[float, Field(ge=0, le=1)] = 0.0

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
        noise: float = 0.0,
    ) -> Camera:
        """Make a pinhole camera; `field_of_view` (rad) below π."""
        return cls(
            projection="perspective",
            width=width,
            height=height,
            field_of_view=field_of_view,
            eye_height=eye_height,
            noise=noise,
        )

    @classmethod
    def panoramic(
        cls, width: int = 360, height: int = 60, *, eye_height: float = 0.3, noise: float = 0.0
    ) -> Camera:
        """Make a camera that sees all around."""
        return cls(
            projection="panoramic",
            width=width,
            height=height,
            field_of_view=2 * np.pi,
            eye_height=eye_height,
            noise=noise,
        )

    @property
    def focal_length(self) -> float:
        """Pixels per unit of tangent (perspective) or per radian (panoramic)."""
        if self.projection == "panoramic":
            return self.width / (2 * np.pi)
        return self.width / (2 * math.tan(self.field_of_view / 2))

    def render(
        self,
        arena: Arena,
        poses: AnyArray,
        *,
        out: Images | None = None,
        rng: Generators | None = None,
        own: Callable[[Images], None] | None = None,
    ) -> Images:
        """Paint what the camera sees from each pose (m, m, rad).

        Each pixel is the mean of the texture over the area it covers; the same poses give the same bits
        whatever the number of threads and however they are batched, but for the noise.

        Parameters
        ----------
        out
            Buffer to paint into, C-contiguous and writeable; it is also returned.
        rng
            Where the sensor noise comes from, or one generator for each view; needed only if the camera has
            `noise`.
        own
            Paints what the camera sees of its own body onto the views, before their noise.

        Raises
        ------
        ArenaError
            For poses that are not finite triples, a buffer that does not fit, or noise without a generator.
        """
        poses = _checked(poses)
        shape = (len(poses), self.height, self.width, 3)
        if out is None:
            out = np.empty(shape, np.uint8)
        elif out.dtype != np.uint8 or out.shape != shape or not out.flags.carray:
            layout = "" if out.flags.carray else ", strided or read-only"
            raise ArenaError(
                f"the buffer is {out.dtype} of shape {out.shape}{layout}; "
                f"these views need C-contiguous, writeable uint8 of {shape}"
            )
        (lens, ray), (faces, floor, *textures) = self._optics, arena.scene
        sky = backdrop(lens, floor[:3], arena.ceiling, arena.zenith)
        scene = (faces, tuple(floor), *textures), tuple(lens), tuple(sky), ray
        rows = out.reshape(*shape[:2], 3 * self.width)
        _in_threads(lambda at: render.render(poses[at], *scene, rows[at]), len(poses))
        if own is not None:
            own(out)
        add_noise(out, self.noise, rng)
        return out

    def depth(self, arena: Arena, poses: AnyArray) -> Float[np.ndarray, "views width"]:
        """Distance (m) along the middle ray of each column to the nearest face of any height, else infinity.

        Raises
        ------
        ArenaError
            For poses that are not finite triples.
        """
        poses = _checked(poses)
        out = np.empty((len(poses), self.width))
        faces, (lens, _) = arena.scene.faces, self._optics
        _in_threads(lambda at: raycast.measure(poses[at], faces, lens, out[at]), len(poses))
        return out

    def identify(self, arena: Arena, poses: AnyArray) -> Int32[np.ndarray, "views height width"]:
        """Tell which surface is seen at the middle of each pixel.

        Returns
        -------
        index
            The row of `arena.surfaces`; for the top of a solid lower than the eye the number of rows plus the
            solid's index; −1 for the floor and −2 for the ceiling (`arena.eye.raycast.FLOOR`, `CEILING`).

        Raises
        ------
        ArenaError
            For poses that are not finite triples.
        """
        poses = _checked(poses)
        out = np.empty((len(poses), self.height, self.width), np.int32)
        faces, (lens, _) = arena.scene.faces, self._optics
        _in_threads(lambda at: raycast.identify(poses[at], faces, lens, out[at]), len(poses))
        return out

    @cached_property
    def _optics(self) -> tuple[Lens, Float[np.ndarray, "width_and_one 2"]]:
        """The lens, and the direction (ahead, left) between columns."""
        panoramic = self.projection == "panoramic"
        lens = Lens(self.width, self.height, self.focal_length, self.eye_height, panoramic)
        return lens, np.array([direction(x, lens) for x in np.arange(self.width + 1.0)])


def _in_threads(work: Callable[[slice], None], views: int) -> None:
    """Do consecutive views each in a thread of its own, as many as numba has."""
    # A thread takes as long to start as a few views.
    threads = numba.get_num_threads() if views > 16 else 1
    if threads == 1:
        work(slice(views))
        return
    share = max(-(-views // threads), 16)
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, [slice(first, first + share) for first in range(0, views, share)]))


def _checked(given: AnyArray) -> Float[np.ndarray, "views 3"]:
    try:
        poses = given if isinstance(given, np.ndarray) else np.array(given, np.float64)
    except (TypeError, ValueError, RuntimeError) as error:
        raise ArenaError(
            f"the poses are no numbers: {error}; give x, y (m) and heading (rad) a row"
        ) from None
    if poses.ndim != 2 or poses.shape[1] != 3:
        raise ArenaError(f"the poses are of shape {poses.shape}; give x, y (m) and heading (rad) a row")
    # Of this layout only: the kernels would be compiled again for read-only poses.
    if poses.dtype != np.float64 or not poses.flags.carray:
        poses = np.require(poses, np.float64, ["C", "A", "W"])
    bad = unsound(poses)
    if bad >= 0:
        raise ArenaError(f"pose {bad} is {poses[bad]}; give finite x, y (m) and heading (rad)")
    return poses
