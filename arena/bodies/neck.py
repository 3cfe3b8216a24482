"""The neck: a base on two wheels with a head that turns on it and bears the eye."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Annotated, ClassVar, Literal

import numpy as np
from jaxtyping import Bool, Float, Int
from pydantic import Field

from arena.angles import wrap_angle
from arena.bodies.base import POSE, Alone, Axis, Configurations, Segments, Unit, check_generator
from arena.bodies.disc import Disc
from arena.bodies.motors import Rollers
from arena.errors import ArenaError
from arena.eye.camera import Camera, Images
from arena.rooms.arena import Arena
from arena.rooms.materials import TEXEL, texture
from arena.settings import Settings

ABOVE = 0.06
"""How far the eye is above the deck, m."""
DECK = "books"
"""The material of the deck, laid along its rim."""


class Neck(Settings):
    """A disc whose head turns: the eye looks where base and neck together point it.

    A mechanism with one axis too many for its eye: heading and pan cannot be told apart from what is seen of
    the room, only their sum. Where the deck is seen, a disc around the neck that turns with the base, in the
    lowest rows of a panorama, they can.

    Parameters
    ----------
    base
        The disc; its head slips as its wheels do.
    max_pan
        How fast the head turns, rad/s.
    deck
        "seen" or "unseen".

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    axes: ClassVar[tuple[Axis, ...]] = (*POSE, Axis("pan", "circle", "rad"))
    motors: ClassVar[tuple[Unit, ...]] = ("m", "rad", "rad")

    base: Disc = Disc()
    max_pan: Annotated[float, Field(gt=0, le=1e3)] = np.pi
    deck: Literal["seen", "unseen"] = "unseen"

    @property
    def radius(self) -> float:
        """Of the base, m."""
        return self.base.radius

    def velocities(self, commands: Float[np.ndarray, "... motors"]) -> Float[np.ndarray, "... motors"]:
        """Turn commands in [−1, 1] into speed (m/s), turn rate and pan rate (rad/s)."""
        pan = self.max_pan * np.clip(commands[..., 2:], -1, 1)
        return np.concatenate([self.base.velocities(commands[..., :2]), pan], axis=-1)

    def is_free(self, arena: Arena, configurations: Configurations) -> Bool[np.ndarray, " bodies"]:
        """Whether the base touches nothing there and is on the platform."""
        return self.base.is_free(arena, configurations)

    def sample_free(self, arena: Arena, count: int, rng: np.random.Generator) -> Configurations:
        """Draw poses of the base evenly from free space, and any pan.

        Raises
        ------
        ArenaError
            When it fits nowhere.
        """
        return np.column_stack([self.base.sample_free(arena, count, rng), rng.uniform(-np.pi, np.pi, count)])

    def camera_poses(self, configurations: Configurations) -> Float[np.ndarray, "bodies 3"]:
        """Where the base is, and where the head looks."""
        x, y, heading, pan = configurations.T
        return np.column_stack([x, y, wrap_angle(heading + pan)])

    def segments(self, configurations: Configurations) -> Segments:
        """Place the middle of the base."""
        return self.base.segments(configurations)

    def place(
        self, arena: Arena, configuration: tuple[float, ...], rng: np.random.Generator | None = None
    ) -> Alone:
        """Put it into a room; its slip is drawn from the generator.

        Raises
        ------
        ArenaError
            Where it cannot start, and for slip without a generator.
        """
        check_generator(self.base.slip, rng)
        return Alone(self, arena, configuration, rng)

    def at_large(self, arena: Arena, count: int) -> "Necks":
        """Give the physics of this many of its kind."""
        return Necks(self, arena, count)

    def paint_itself(self, camera: Camera, configurations: Configurations, views: Images) -> None:
        """Paint the deck onto views, if it is seen.

        Raises
        ------
        ArenaError
            For a deck before a camera whose lowest row looks over it, or that is no panoramic one.
        """
        if self.deck == "unseen":
            return
        below = np.arange(camera.height) + 0.5 - camera.height / 2
        # How far from the neck the row's rays meet the deck, as a share of its radius.
        out = camera.focal_length * ABOVE / np.maximum(below, 1e-9) / self.radius
        rows = np.flatnonzero(out < 1)
        if camera.projection != "panoramic" or not len(rows):
            raise ArenaError(
                f"no deck is seen by a {camera.projection} camera of {camera.width}×{camera.height} pixels; "
                "take a panoramic one at least a fifth as high as wide, or leave the deck unseen"
            )
        sums = _around(self.radius, tuple(out[rows].tolist()))
        # Columns are means over what lies between their ends, from the left of the picture to the right.
        turns = (configurations[:, 3:] + np.pi) / (2 * np.pi) - np.arange(camera.width + 1) / camera.width
        at = turns * (len(sums) - 1) % (len(sums) - 1)
        whole = np.floor(turns)
        first = at.astype(int)
        part = (at - first)[..., None, None]
        total = (1 - part) * sums[first] + part * sums[first + 1] + whole[..., None, None] * sums[-1]
        mean = (total[:, :-1] - total[:, 1:]) * camera.width / (len(sums) - 1)
        views[:, rows] = np.rint(mean).transpose(0, 2, 1, 3)


@lru_cache(maxsize=8)
def _around(radius: float, out: tuple[float, ...]) -> Float[np.ndarray, "ends rows 3"]:
    """Sum a deck's texture around the neck, from straight ahead to the left, at shares of its radius (m)."""
    tile = texture(DECK).astype(float)
    length = min(max(3, round(2 * np.pi * radius / TEXEL)), len(tile))
    ring = tile[:length, (np.array(out) * radius / TEXEL).astype(int) % tile.shape[1]]
    return np.concatenate([np.zeros((1, *ring.shape[1:])), ring.cumsum(axis=0)])


class Necks:
    """Necks of one kind at large in a room; see `arena.bodies.base.AtLarge`."""

    def __init__(self, body: Neck, arena: Arena, count: int) -> None:
        self._slip, self._bases = body.base.slip, Rollers(body.base, arena, count)
        self._pans = np.zeros(count)

    @property
    def configurations(self) -> Configurations:
        """Where each is: x, y (m), heading of the base and pan (rad)."""
        return np.column_stack([self._bases.configurations, wrap_angle(self._pans)])

    @property
    def touched(self) -> Bool[np.ndarray, " bodies"]:
        """Whether a wall or the platform's border stopped it in its last step."""
        return self._bases.touched

    def begin(self, which: Int[np.ndarray, " some"], configurations: Configurations) -> None:
        """Put these there, at rest."""
        self._bases.begin(which, configurations[:, :3])
        self._pans[which] = configurations[:, 3]

    def step(
        self,
        which: Int[np.ndarray, " some"],
        velocities: Float[np.ndarray, "some motors"],
        dt: float,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Let these go and turn for dt (s), each slipping by its own generator."""
        self._bases.step(which, velocities[:, :2], dt, rngs)
        turned = velocities[:, 2] * dt
        if self._slip:
            turned *= 1 + self._slip * np.array([rng.standard_normal() for rng in rngs])
        self._pans[which] += turned
