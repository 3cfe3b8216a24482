"""The contracts of an eye: it paints what is seen from poses, or watches a body from where it stands."""

from functools import partial
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np

from arena.bodies.base import Body, Configurations
from arena.eye.camera import Camera, Images, Poses
from arena.eye.noise import Generators
from arena.rooms.arena import Arena


@runtime_checkable
class Eye(Protocol):
    """What sees on a body: an `arena.eye.camera.Camera`, or anything that renders like it."""

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


@runtime_checkable
class Watcher(Protocol):
    """What sees a body from outside: an `arena.eye.overhead.Overhead`, or anything that looks like it."""

    @property
    def height(self) -> int:
        """Rows of an image."""

    @property
    def width(self) -> int:
        """Columns of an image."""

    def look(self, arena: Arena, body: Body, configurations: Configurations, *, rng: Generators) -> Images:
        """Paint the body in each configuration, with what sensor noise there is from the generators."""

    def model_dump(self) -> dict[str, Any]:
        """Give the parameters that, with the arena and the body, determine every pixel."""


class SeesItself(Protocol):
    """A body that a camera on it sees a part of."""

    def paint_itself(self, camera: Camera, configurations: Configurations, views: Images) -> None:
        """Paint it onto the views, which have no noise yet."""


AnyEye = Eye | Watcher


def see(
    eye: AnyEye, arena: Arena, body: Body, configurations: Configurations, *, out: Images, rng: Generators
) -> None:
    """Paint what an eye sees of a room and of a body in each configuration."""
    if isinstance(eye, Camera):
        # Asked by name: whether a body keeps a protocol takes half as long as to paint a strip.
        own = None
        if hasattr(type(body), "paint_itself"):
            own = partial(cast("SeesItself", body).paint_itself, eye, configurations)
        eye.render(arena, body.camera_poses(configurations), out=out, rng=rng, own=own)
    elif isinstance(eye, Watcher):
        out[:] = eye.look(arena, body, configurations, rng=rng)
    elif isinstance(rng, np.random.Generator):
        out[:] = eye.render(arena, body.camera_poses(configurations), rng=rng)
    else:
        for view, pose, its in zip(out, body.camera_poses(configurations)[:, None], rng, strict=True):
            view[:] = eye.render(arena, pose, rng=its)[0]
