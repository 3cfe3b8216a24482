"""The contract of an eye: whatever paints what is seen from poses."""

from typing import Any, Protocol, runtime_checkable

import numpy as np

from arena.eye.camera import Images, Poses
from arena.rooms.arena import Arena


@runtime_checkable
class Eye(Protocol):
    """What sees: an `arena.eye.camera.Camera`, or anything that renders like it."""

    @property
    def height(self) -> int:
        """Rows of an image."""

    @property
    def width(self) -> int:
        """Columns of an image."""

    def render(self, arena: Arena, poses: Poses, *, rng: np.random.Generator) -> Images:
        """Paint the views from poses, with what sensor noise there is from the generator."""

    def model_dump(self) -> dict[str, Any]:
        """Give the parameters that, with the arena, determine every pixel."""
