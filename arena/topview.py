"""The top view of a room, drawn fast enough to watch an animal walk."""

from functools import cached_property

import cv2
import numpy as np
import shapely
from jaxtyping import Float, UInt8

from arena.bodies.disc import Pose
from arena.rooms.arena import Arena
from arena.rooms.materials import texture

_SHIFT = 4
"""OpenCV draws at this many binary digits of a pixel."""
_MARGIN = 0.1
"""Of floor around everything, m."""


class TopView:
    """A map of a room, on which a body and the way it came can be drawn.

    Walls and solids are lines in the mean colour of their material, the platform is light, odour sources are
    green rings, the body is red with a line where its eye looks.

    Parameters
    ----------
    arena
        The room.
    height
        Of the picture, pixels; its width follows from the shape of the room.
    """

    def __init__(self, arena: Arena, height: int = 240) -> None:
        self._arena = arena
        self._height = height

    def draw(
        self,
        pose: Pose,
        radius: float,
        trail: Float[np.ndarray, "points 2"],
        links: Float[np.ndarray, "links 2 2"] | None = None,
    ) -> UInt8[np.ndarray, "height width 3"]:
        """Draw a body of this radius (m) at a pose (m, m, rad), its links, and the points (m) it passed."""
        picture = self._room.copy()
        blue, red, white = (70, 90, 160), (214, 69, 65), (255, 255, 255)
        cv2.polylines(picture, [self._pixels(trail)], False, blue, 1, cv2.LINE_AA, _SHIFT)  # noqa: FBT003
        x, y, heading = pose
        nose = (x + radius * np.cos(heading), y + radius * np.sin(heading))
        here, ahead = self._pixels(np.array([(x, y), nose])).tolist()
        thick = self._length(radius)
        for link in [] if links is None else links:
            start, end = self._pixels(link).tolist()
            cv2.line(picture, start, end, red, max(1, 2 * thick >> _SHIFT), cv2.LINE_AA, _SHIFT)
            for joint in (start, end):
                cv2.circle(picture, joint, thick, red, -1, cv2.LINE_AA, _SHIFT)
        cv2.circle(picture, here, thick, red, -1, cv2.LINE_AA, _SHIFT)
        cv2.line(picture, here, ahead, white, 2, cv2.LINE_AA, _SHIFT)
        return picture

    @cached_property
    def _room(self) -> UInt8[np.ndarray, "height width 3"]:
        """Everything that does not move."""
        x0, _, x1, _ = self._arena.bounds
        width = round((x1 - x0 + 2 * _MARGIN) * self._scale)
        picture = np.full((self._height, width, 3), (96, 92, 88), np.uint8)
        for part in shapely.get_parts(self._arena.free_space(0.0)):
            rings = [self._pixels(np.array(ring.coords)) for ring in (part.exterior, *part.interiors)]
            cv2.fillPoly(picture, rings, (226, 222, 214), cv2.LINE_AA, _SHIFT)
        faces = self._arena.surfaces
        colours = [texture(name).mean(axis=(0, 1)).tolist() for name in faces.materials]
        ends = self._pixels(np.concatenate([faces.start, faces.end])).reshape(2, -1, 2)
        for start, end, material in zip(*ends.tolist(), faces.material, strict=True):
            cv2.line(picture, start, end, colours[material], 3, cv2.LINE_AA, _SHIFT)
        for source in self._arena.sources:
            (here,) = self._pixels(np.array([source.position])).tolist()
            cv2.circle(picture, here, self._length(0.08), (44, 140, 82), 2, cv2.LINE_AA, _SHIFT)
        return picture

    @cached_property
    def _scale(self) -> float:
        """Pixels per m."""
        _, y0, _, y1 = self._arena.bounds
        return self._height / (y1 - y0 + 2 * _MARGIN)

    def _length(self, metres: float) -> int:
        return int(np.rint(metres * self._scale * 2**_SHIFT))

    def _pixels(self, xy: Float[np.ndarray, "points 2"]) -> np.ndarray:
        x0, _, _, y1 = self._arena.bounds
        pixels = (xy - (x0 - _MARGIN, y1 + _MARGIN)) * (self._scale, -self._scale)
        # A pixel's centre is at whole numbers for OpenCV, at halves here.
        out: np.ndarray = np.rint((pixels - 0.5) * 2**_SHIFT).astype(np.int32)
        return out
