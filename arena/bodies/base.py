"""The contract of a body: axes, what it can be commanded to do, and where it puts the eye."""

import math
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.angles import wrap_angle
from arena.errors import ArenaError
from arena.rooms.arena import Arena

TOLERANCE = 1e-3
"""How far (m) a start may reach beyond free space."""

_ONE = np.zeros(1, int)

Unit = Literal["m", "rad"]
Configurations = Float[np.ndarray, "bodies axes"]
"""A number on each axis a row: m, or rad, those of circles in (−π, π]."""
Segments = Float[np.ndarray, "bodies links 2 2"]
"""Ends of what bodies are made of, m: each link is all that is within a body's `radius` of a segment."""


class Axis(NamedTuple):
    """A degree of freedom."""

    name: str
    kind: Literal["line", "circle"]
    """A joint that turns is a circle if it can turn all round, a line if it has limits."""
    unit: Unit
    limits: tuple[float, float] | None = None
    """None for a circle, and for what only the room limits."""


POSE = (Axis("x", "line", "m"), Axis("y", "line", "m"), Axis("heading", "circle", "rad"))
"""The axes of a body that is where its pose says."""


@runtime_checkable
class AtLarge(Protocol):
    """Bodies of one kind at large in a room, side by side: they pass through each other, each as alone."""

    @property
    def configurations(self) -> Configurations:
        """Where each is."""

    @property
    def touched(self) -> Bool[np.ndarray, " bodies"]:
        """Whether something stopped it in its last step: an obstacle, a border, the end of an axis."""

    def begin(self, which: Int[np.ndarray, " some"], configurations: Configurations) -> None:
        """Put these there, at rest; that they are free is checked by `check_starts`."""

    def step(
        self,
        which: Int[np.ndarray, " some"],
        velocities: Float[np.ndarray, "some motors"],
        dt: float,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Let the motors of these turn for dt (s) by m/s or rad/s; each slips by its own generator."""


@runtime_checkable
class Placed(Protocol):
    """One body in a room."""

    @property
    def configuration(self) -> tuple[float, ...]:
        """Where it is."""

    def go(self, velocities: Sequence[float], dt: float) -> bool:
        """Let its motors turn for dt (s) by m/s or rad/s: give whether something stopped it.

        Raises
        ------
        ArenaError
            For velocities that are not finite, or a dt that is not positive.
        """


@runtime_checkable
class Body(Protocol):
    """A mechanism in a room: a value, whose configuration is a number on each of its axes.

    Motors move it, q' = B(q) u, until something stops it; they may be fewer than the axes. `model_dump`
    gives the parameters that, with the room, the start, the commands and the generator, determine every step.
    """

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its degrees of freedom."""

    @property
    def motors(self) -> tuple[Unit, ...]:
        """Whether each motor goes (m) or turns (rad)."""

    @property
    def radius(self) -> float:
        """Half of how thick it is, m."""

    def velocities(self, commands: Float[np.ndarray, "... motors"]) -> Float[np.ndarray, "... motors"]:
        """Turn commands in [−1, 1] into what the motors should do, m/s or rad/s."""

    def is_free(self, arena: Arena, configurations: Configurations) -> Bool[np.ndarray, " bodies"]:
        """Whether it can be there: within the limits of its axes, and touching nothing."""

    def sample_free(self, arena: Arena, count: int, rng: np.random.Generator) -> Configurations:
        """Draw configurations evenly from the free ones.

        Raises
        ------
        ArenaError
            When it fits nowhere.
        """

    def camera_poses(self, configurations: Configurations) -> Float[np.ndarray, "bodies 3"]:
        """Where its eye and nose are, x, y (m), and where the eye looks, rad in (−π, π]."""

    def segments(self, configurations: Configurations) -> Segments:
        """Place what can be seen of it from outside."""

    def place(
        self, arena: Arena, configuration: tuple[float, ...], rng: np.random.Generator | None = None
    ) -> Placed:
        """Put it into a room; its slip is drawn from the generator.

        Raises
        ------
        ArenaError
            Where it cannot start, and for slip without a generator.
        """

    def at_large(self, arena: Arena, count: int) -> AtLarge:
        """Give the physics of this many of its kind, at no place yet."""

    def model_dump(self) -> dict[str, Any]:
        """Give the parameters."""


class Alone:
    """One body of any kind in a room: a crowd of one."""

    def __init__(
        self, body: Body, arena: Arena, configuration: tuple[float, ...], rng: np.random.Generator | None
    ) -> None:
        start = np.array([configuration], float)
        check_starts(body, arena, start)
        self._bodies, self._rngs = body.at_large(arena, 1), [] if rng is None else [rng]
        self._bodies.begin(_ONE, start)

    @property
    def configuration(self) -> tuple[float, ...]:
        """Where it is."""
        return tuple(self._bodies.configurations[0].tolist())

    def go(self, velocities: Sequence[float], dt: float) -> bool:
        """Let its motors turn for dt (s) by m/s or rad/s: give whether something stopped it.

        Raises
        ------
        ArenaError
            For velocities that are not finite, or a dt that is not positive.
        """
        if not (all(map(math.isfinite, velocities)) and 0 < dt < math.inf):
            raise ArenaError(f"cannot go at {list(velocities)} for {dt} s; give finite numbers and dt > 0")
        self._bodies.step(_ONE, np.array([velocities], float), dt, self._rngs)
        return bool(self._bodies.touched[0])


def wrapped(body: Body, values: np.ndarray) -> np.ndarray:
    """Wrap what is on a body's circles to (−π, π], in its configurations or in differences of these."""
    circles = [axis.kind == "circle" for axis in body.axes]
    return np.where(circles, wrap_angle(values), values)


def joints_of(body: Body, configurations: np.ndarray) -> np.ndarray | None:
    """Give what poses do not tell: the configurations of a body, or None if these are its poses."""
    return None if body.axes == POSE else configurations


def check_generator(slip: float, rng: np.random.Generator | None) -> None:
    """Raise an `ArenaError` for motors that slip (a share) without a generator."""
    if slip and rng is None:
        raise ArenaError(f"the motors slip by {slip:g}; give `rng`, a numpy.random.Generator")


def check_starts(body: Body, arena: Arena, configurations: np.ndarray) -> None:
    """Raise an `ArenaError` unless a body can start at each of these configurations."""
    names, shape = ", ".join(f"{axis.name} ({axis.unit})" for axis in body.axes), configurations.shape
    if len(shape) != 2 or shape[1] != len(body.axes):
        raise ArenaError(f"the starts are of shape {shape}; give {names} of the {type(body).__name__} a row")
    bad = np.flatnonzero(~np.isfinite(configurations).all(axis=1))
    if len(bad):
        raise ArenaError(f"the start {configurations[bad[0]]} is not finite; give {names}")
    bad = np.flatnonzero(~body.is_free(arena, configurations))
    if len(bad):
        told = ", ".join(f"{value:g}" for value in configurations[bad[0]])
        raise ArenaError(
            f"a body ({type(body).__name__} of radius {body.radius:g} m) cannot start at {names} = {told}: "
            "it would touch something, leave the platform or an axis's range; choose a start in free space"
        )
