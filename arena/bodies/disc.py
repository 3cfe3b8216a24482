"""The body: a disc with differential drive (two wheels), which walls stop."""

import math
from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np
from jaxtyping import Bool, Float
from pydantic import Field

from arena.angles import wrap_angle
from arena.bodies.base import (
    POSE,
    TOLERANCE,
    Axis,
    Configurations,
    Segments,
    Unit,
    check_generator,
    check_starts,
)
from arena.bodies.motors import Motors, Rollers
from arena.bodies.rolling import Limits, look_ahead, roll
from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.settings import Settings, Share

_Gain = Annotated[float, Field(gt=0, le=10)]

Pose = tuple[float, float, float]
"""x and y in m, heading in rad."""


class Drive:
    """A body at large in an arena; `Disc.place` makes one.

    Each step moves a disc at the velocity of the wheels. Where it overlaps a wall it is pushed out along the
    shortest way, so it slides without friction; where that fails, in a wedge or in a gap too narrow for it,
    it stays where it was. Steps are divided so that none is longer than a fifth of the radius: no wall is
    thin enough to be passed, nor any gap that is narrower than the body by 1 %.

    Attributes
    ----------
    body
        Whose body this is.
    speed, turn
        What the wheels do at the end of the last step, m/s and rad/s; at a wall they slip.
    contact
        Direction (rad) from what the last step touched towards the body, else None.
    """

    speed: float = 0.0
    turn: float = 0.0
    contact: float | None = None

    def __init__(self, body: "Disc", arena: Arena, pose: Pose, rng: np.random.Generator | None) -> None:
        self.body = body
        self._motors = Motors(body, arena, 1) if body.disturbed else None
        self._rngs = [] if rng is None else [rng]
        self._state = np.array([*pose, 0.0, 0.0, math.nan])
        self._edges, self._limits = arena.edges, body.limits
        self._x, self._y, self._heading = self._state[:3].tolist()

    @property
    def pose(self) -> Pose:
        """Where the body is, its heading in (−π, π]."""
        return self._x, self._y, wrap_angle(self._heading)

    def step(self, speed: float, turn: float, dt: float) -> bool:
        """Move for dt (s), approaching a speed (m/s) and a turn rate (rad/s) as the body can.

        Both commands are cut to what the body can do at most, and approached within its accelerations.

        Returns
        -------
        touched
            Whether a wall or the platform's border stopped it.

        Raises
        ------
        ArenaError
            For commands that are not finite, or a dt that is not positive.
        """
        if not (math.isfinite(speed) and math.isfinite(turn) and 0 < dt < math.inf):
            raise ArenaError(
                f"cannot step at speed {speed} m/s and turn {turn} rad/s for {dt} s; "
                "give finite numbers and dt > 0"
            )
        if self._motors is None:
            roll(self._state, self._edges, self._limits, (1.0, 1.0), speed, turn, dt)
        else:
            self._motors.move(self._state[None], np.zeros(1, int), np.array([[speed, turn]]), dt, self._rngs)
        self._x, self._y, self._heading, self.speed, self.turn, away = self._state.tolist()
        self.contact = None if math.isnan(away) else away
        return self.contact is not None

    @property
    def configuration(self) -> Pose:
        """Its pose."""
        return self.pose

    def go(self, velocities: Sequence[float], dt: float) -> bool:
        """Step at a speed (m/s) and a turn rate (rad/s) for dt (s): give whether something stopped it."""
        speed, turn = velocities
        return self.step(speed, turn, dt)

    def ahead(self, reach: float) -> float | None:
        """Look straight ahead from the centre: give the normal (rad) of what is within reach (m), or None."""
        normal = look_ahead(self._state, self._edges, reach)
        return None if math.isnan(normal) else normal


class Disc(Settings):
    """A disc with two driven wheels, such as the Turtlebot 2.

    Parameters
    ----------
    radius
        m.
    max_speed
        m/s, forwards and backwards.
    max_turn
        rad/s, either way.
    max_acceleration, max_turn_acceleration
        m/s² and rad/s²; None obeys at once. The Turtlebot 2 is usually driven at 1 m/s² and 2 rad/s².
    wheel_base
        Distance between the wheels, m.
    slip
        Each wheel rolls (1 + `slip` ξ) times as far as it should, ξ standard normal, drawn anew every step.
    wheel_gains
        What the left and the right wheel roll over what they should; 0.7 is a weak motor or a small wheel.
    swapped
        Whether each wheel is wired to the other's command: the body turns the wrong way.
    delay
        Time from a command to its effect, s. Until then the one before it is obeyed, and the first finds it
        at rest.

    Raises
    ------
    ArenaError
        For parameters that are not positive and finite.
    """

    axes: ClassVar[tuple[Axis, ...]] = POSE
    motors: ClassVar[tuple[Unit, ...]] = ("m", "rad")

    radius: Annotated[float, Field(gt=0, le=1e3)] = 0.18
    max_speed: Annotated[float, Field(gt=0, le=1e3)] = 0.65
    max_turn: Annotated[float, Field(gt=0, le=1e3)] = np.pi
    max_acceleration: Annotated[float, Field(gt=0, le=1e6)] | None = None
    max_turn_acceleration: Annotated[float, Field(gt=0, le=1e6)] | None = None
    wheel_base: Annotated[float, Field(gt=0, le=1e3)] = 0.23
    slip: Share = 0.0
    wheel_gains: tuple[_Gain, _Gain] = (1.0, 1.0)
    swapped: bool = False
    delay: Annotated[float, Field(ge=0, le=10)] = 0.0

    @property
    def disturbed(self) -> bool:
        """Whether it does anything but what it is told."""
        return bool(self.slip or self.wheel_gains != (1.0, 1.0) or self.swapped or self.delay)

    @property
    def limits(self) -> Limits:
        """What it can do at most, as the kernels want it."""
        accelerations = (self.max_acceleration or math.inf, self.max_turn_acceleration or math.inf)
        return self.radius, self.max_speed, self.max_turn, *accelerations, *self.lags, self.wheel_base

    @property
    def lags(self) -> tuple[float, float]:
        """Time constants of speed and turn rate, s: zero, it has no mass."""
        return 0.0, 0.0

    def velocities(self, commands: Float[np.ndarray, "... 2"]) -> Float[np.ndarray, "... 2"]:
        """Turn commands in [−1, 1] into speed (m/s) and turn rate (rad/s)."""
        asked: np.ndarray = commands * [self.max_speed, self.max_turn]
        return asked

    def is_free(self, arena: Arena, configurations: Configurations) -> Bool[np.ndarray, " bodies"]:
        """Whether it touches nothing there and is on the platform."""
        return arena.is_free(configurations[:, :2], max(0.0, self.radius - TOLERANCE))

    def sample_free(self, arena: Arena, count: int, rng: np.random.Generator) -> Configurations:
        """Draw poses evenly from free space.

        Raises
        ------
        ArenaError
            When it fits nowhere.
        """
        places = arena.sample_free(count, self.radius, rng)
        return np.column_stack([places, rng.uniform(-np.pi, np.pi, count)])

    def camera_poses(self, configurations: Configurations) -> Float[np.ndarray, "bodies 3"]:
        """Its own: the eye is in its middle and looks ahead."""
        return configurations

    def segments(self, configurations: Configurations) -> Segments:
        """Place its middle, of which all of it is within its radius."""
        return np.repeat(configurations[:, None, None, :2], 2, axis=2)

    def at_large(self, arena: Arena, count: int) -> Rollers:
        """Give the physics of this many of its kind."""
        return Rollers(self, arena, count)

    def from_wheels(self, left: float, right: float) -> tuple[float, float]:
        """Turn the speeds of the wheels' rims (m/s) into the speed (m/s) and turn rate (rad/s) of the body.

        >>> speed, turn = Disc(wheel_base=0.2).from_wheels(0.1, 0.3)
        >>> round(speed, 12), round(turn, 12)
        (0.2, 1.0)
        """
        return 0.5 * (left + right), (right - left) / self.wheel_base

    def place(
        self, arena: Arena, configuration: tuple[float, ...], rng: np.random.Generator | None = None
    ) -> Drive:
        """Put the body into an arena; its slip is drawn from the generator, and without slip nothing is.

        Raises
        ------
        ArenaError
            For a pose that is not finite or where the body touches something, and slip without a generator.
        """
        check_generator(self.slip, rng)
        check_starts(self, arena, np.array([configuration], dtype=float))
        x, y, heading = configuration
        return Drive(self, arena, (x, y, heading), rng)
