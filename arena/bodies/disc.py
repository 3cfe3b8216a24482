"""The body: a disc with differential drive (two wheels), which walls stop."""

import math
from typing import Annotated

import numpy as np
import pymunk
from pydantic import Field

from arena.angles import wrap_angle
from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.settings import Settings

TOLERANCE = 1e-3
"""How far (m) a start may reach beyond free space; a step never reaches beyond it by more than `_CLOSE`."""
_CLOSE = 1e-6

Pose = tuple[float, float, float]
"""x and y in m, heading in rad."""


class Drive:
    """A body at large in an arena; `Disc.place` makes one.

    Each step gives a pymunk disc the velocity of the wheels and lets pymunk move it and find what it hits. A
    disc that overlaps a wall is pushed out along the shortest way, so it slides without friction; where that
    fails, in a wedge or in a gap too narrow for it, it stays where it was. Steps are divided so that none is
    longer than a fifth of the radius: no wall is thin enough to be passed, nor any gap that is narrower than
    the body by 1 %.

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

    def __init__(self, body: "Disc", arena: Arena, pose: Pose) -> None:
        self.body = body
        self._heading = pose[2]
        self._space = arena.space()
        self._disc = pymunk.Body(mass=1.0, moment=math.inf)
        self._disc.position = pose[:2]
        shape = pymunk.Circle(self._disc, body.radius)
        # Queries with the disc's own filter leave it out.
        self._others = shape.filter = pymunk.ShapeFilter(group=1)
        self._space.add(self._disc, shape)
        self._space.on_collision(pre_solve=self._on_collision)
        self._overlaps = False

    @property
    def pose(self) -> Pose:
        """Where the body is, its heading in (−π, π]."""
        x, y = self._disc.position
        return x, y, wrap_angle(self._heading)

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
        body, disc = self.body, self._disc
        speed = max(-body.max_speed, min(body.max_speed, speed))
        turn = max(-body.max_turn, min(body.max_turn, turn))
        self.speed, speed = _approach(self.speed, speed, body.max_acceleration, dt)
        self.turn, turn = _approach(self.turn, turn, body.max_turn_acceleration, dt)
        parts = max(1, math.ceil(5 * abs(speed) * dt / body.radius))
        dt /= parts
        self.contact = None
        for _ in range(parts):
            # Half the turn first: second-order accurate along the arc.
            course = self._heading + 0.5 * turn * dt
            self._heading += turn * dt
            vx, vy = disc.velocity = speed * math.cos(course), speed * math.sin(course)
            self._space.step(dt)
            if self._overlaps:
                self._push_out(vx * dt, vy * dt)
        return self.contact is not None

    def ahead(self, reach: float) -> float | None:
        """Look straight ahead from the centre: give the normal (rad) of what is within reach (m), or None."""
        x, y = self._disc.position
        goal = x + reach * math.cos(self._heading), y + reach * math.sin(self._heading)
        wall = self._space.segment_query_first((x, y), goal, 0.0, self._others)
        return None if wall is None else wall.normal.angle

    def _on_collision(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: object) -> None:
        # pymunk's own solver leaves centimetres of overlap and then works them off as speed.
        arbiter.process_collision = False
        self._overlaps = True

    def _push_out(self, dx: float, dy: float) -> None:
        self._overlaps = False
        x0, y0 = x, y = self._disc.position
        # A corner takes a few pushes; what twenty do not free is a wedge.
        for _ in range(20):
            wall = self._space.point_query_nearest((x, y), self.body.radius - _CLOSE, self._others)
            if wall is None:
                break
            px, py = wall.point
            stretch = self.body.radius / max(wall.distance, _CLOSE * self.body.radius)
            x, y = px + stretch * (x - px), py + stretch * (y - py)
        else:
            x, y = x0 - dx, y0 - dy
        if (x, y) != (x0, y0):
            self._disc.position = x, y
            self.contact = math.atan2(y - y0, x - x0)


def _approach(now: float, goal: float, limit: float | None, dt: float) -> tuple[float, float]:
    """Change by no more than limit a second towards the goal: give what is reached in dt, and the mean."""
    if limit is None:
        return goal, goal
    change = goal - now
    needed = abs(change) / limit
    if needed < dt:
        return goal, goal - 0.5 * change * needed / dt
    end = now + math.copysign(limit * dt, change)
    return end, 0.5 * (now + end)


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

    Raises
    ------
    ArenaError
        For parameters that are not positive and finite.
    """

    radius: Annotated[float, Field(gt=0, le=1e3)] = 0.18
    max_speed: Annotated[float, Field(gt=0, le=1e3)] = 0.65
    max_turn: Annotated[float, Field(gt=0, le=1e3)] = np.pi
    max_acceleration: Annotated[float, Field(gt=0, le=1e6)] | None = None
    max_turn_acceleration: Annotated[float, Field(gt=0, le=1e6)] | None = None
    wheel_base: Annotated[float, Field(gt=0, le=1e3)] = 0.23

    def from_wheels(self, left: float, right: float) -> tuple[float, float]:
        """Turn the speeds of the wheels' rims (m/s) into the speed (m/s) and turn rate (rad/s) of the body.

        >>> speed, turn = Disc(wheel_base=0.2).from_wheels(0.1, 0.3)
        >>> round(speed, 12), round(turn, 12)
        (0.2, 1.0)
        """
        return 0.5 * (left + right), (right - left) / self.wheel_base

    def place(self, arena: Arena, pose: Pose) -> Drive:
        """Put the body into an arena.

        Raises
        ------
        ArenaError
            For a pose that is not finite or where the body touches something.
        """
        if not np.isfinite(pose).all():
            raise ArenaError(f"the start {pose} is not finite; give x, y (m) and heading (rad)")
        if not arena.is_free(np.array([pose[:2]], dtype=float), max(0.0, self.radius - TOLERANCE))[0]:
            raise ArenaError(
                f"a body of radius {self.radius:g} m cannot start at ({pose[0]:g}, {pose[1]:g}) m: it would "
                "touch a wall or leave the platform; choose a start in free space"
            )
        return Drive(self, arena, pose)
