"""Jointed bodies: what chains of joints share, whatever they are called."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated

import numpy as np
import shapely
from jaxtyping import Bool, Float, Int
from pydantic import Field, model_validator

from arena.angles import wrap_angle
from arena.bodies.base import TOLERANCE, Alone, Axis, Configurations, Segments, Unit, check_generator, wrapped
from arena.bodies.linkage import Chain, are_clear, bend_all, turn_all
from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.settings import Settings, Share

Gain = Annotated[float, Field(gt=0, le=10)]
Metres = Annotated[float, Field(ge=1e-3, le=1e3)]
Speed = Annotated[float, Field(gt=0, le=1e3)]
Point = tuple[float, float]


class Jointed(Settings):
    """A chain of joints on a base, each with a motor and a straight link, all in one plane above the floor.

    The room stops it where it is higher than this plane. It has no mass: motors obey at once.

    Parameters
    ----------
    height
        Of the plane above the floor, m: walls and solids that are no higher are passed over.
    slip
        Each motor moves (1 + `slip` ξ) times as far as it should, ξ standard normal, drawn anew every step.
    motor_gains
        What each motor moves over what it should; 0.7 is a weak one. None is 1 for all.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    height: Annotated[float, Field(ge=0, le=1e3)] = 0.3
    slip: Share = 0.0
    motor_gains: tuple[Gain, ...] | None = None

    @model_validator(mode="after")
    def _one_gain_each(self) -> "Jointed":
        if self.motor_gains is not None and len(self.motor_gains) != len(self.axes):
            raise ValueError(f"{len(self.motor_gains)} gains for {len(self.axes)} motors; give one each")
        return self

    @property
    @abstractmethod
    def axes(self) -> tuple[Axis, ...]:
        """Its joints, from the base on."""

    @property
    @abstractmethod
    def radius(self) -> float:
        """Half of how thick its links are, m."""

    @property
    @abstractmethod
    def chain(self) -> Chain:
        """Its geometry, as the kernels want it."""

    @property
    @abstractmethod
    def most(self) -> tuple[float, ...]:
        """What each motor can do at most, m/s or rad/s."""

    @property
    def motors(self) -> tuple[Unit, ...]:
        """Each joint has one."""
        return tuple(axis.unit for axis in self.axes)

    def velocities(self, commands: Float[np.ndarray, "... motors"]) -> Float[np.ndarray, "... motors"]:
        """Turn commands in [−1, 1], cut to these, into m/s or rad/s."""
        asked: np.ndarray = np.clip(commands, -1, 1) * np.array(self.most)
        return asked

    def is_free(self, arena: Arena, configurations: Configurations) -> Bool[np.ndarray, " bodies"]:
        """Whether all joints are within their ranges, and no link touches anything."""
        free, joints = np.empty(len(configurations), bool), np.ascontiguousarray(configurations, float)
        are_clear(joints, self.chain, max(0.0, self.radius - TOLERANCE), self.edges(arena), free)
        low, high = self.ranges.T
        free &= ((low <= joints) & (joints <= high)).all(axis=1)
        # What crosses no edge is in a solid as a whole, or not at all.
        for solid in arena.solids:
            if solid.height > self.height:
                free &= ~shapely.contains_xy(shapely.Polygon(solid.outline), self.segments(joints)[:, 0, 0])
        return free

    def sample_free(self, arena: Arena, count: int, rng: np.random.Generator) -> Configurations:
        """Draw configurations evenly from the free ones.

        Raises
        ------
        ArenaError
            When less than one in a thousand is free.
        """
        low, high = np.clip(self.ranges, -np.pi, np.pi).T
        limited = [axis.limits is not None for axis in self.axes]
        low[limited], high[limited] = self.ranges[limited].T
        found, drawn = np.empty((0, len(low))), 0
        while len(found) < count:
            tried = rng.uniform(low, high, (2 * count + 16, len(low)))
            found, drawn = np.concatenate([found, tried[self.is_free(arena, tried)]]), drawn + len(tried)
            if drawn > 10_000 and 1000 * len(found) < drawn:
                raise ArenaError(
                    f"the {type(self).__name__} is hardly ever free in arena {arena.name!r}; move its base, "
                    "lift it above what stops it, or take a smaller one"
                )
        return found[:count]

    def camera_poses(self, configurations: Configurations) -> Float[np.ndarray, "bodies 3"]:
        """Where the end of the last link is, and where it points."""
        turned = configurations[:, [axis.unit == "rad" for axis in self.axes]].sum(axis=1)
        return np.column_stack([self.segments(configurations)[:, -1, 1], wrap_angle(self.chain[2] + turned)])

    def segments(self, configurations: Configurations) -> Segments:
        """Place the links."""
        links = np.empty((*configurations.shape, 2, 2))
        bend_all(np.ascontiguousarray(configurations, float), self.chain, links)
        return links

    def place(
        self, arena: Arena, configuration: tuple[float, ...], rng: np.random.Generator | None = None
    ) -> Alone:
        """Put it into a room; its slip is drawn from the generator.

        Raises
        ------
        ArenaError
            Where it cannot start, and for slip without a generator.
        """
        check_generator(self.slip, rng)
        return Alone(self, arena, configuration, rng)

    def at_large(self, arena: Arena, count: int) -> "Linkages":
        """Give the physics of this many of its kind."""
        return Linkages(self, arena, count)

    @property
    def ranges(self) -> Float[np.ndarray, "axes 2"]:
        """First and last of each axis; infinite for a circle."""
        return np.array([axis.limits or (-math.inf, math.inf) for axis in self.axes])

    def edges(self, arena: Arena) -> Float[np.ndarray, "edges 2 2"]:
        """List the ends (m) of all in the room that stops it."""
        faces = arena.surfaces
        return np.stack([faces.start, faces.end], axis=1)[faces.height > self.height]


class Linkages:
    """Jointed bodies of one kind at large in a room; see `arena.bodies.base.AtLarge`."""

    def __init__(self, body: Jointed, arena: Arena, count: int) -> None:
        self._body, self._edges = body, body.edges(arena)
        self._joints = np.full((count, len(body.axes)), math.nan)
        self._touched = np.zeros(count, bool)

    @property
    def configurations(self) -> Configurations:
        """Where each is."""
        return wrapped(self._body, self._joints)

    @property
    def touched(self) -> Bool[np.ndarray, " bodies"]:
        """Whether an obstacle or the end of an axis stopped it in its last step."""
        return self._touched.copy()

    def begin(self, which: Int[np.ndarray, " some"], configurations: Configurations) -> None:
        """Put these there."""
        self._joints[which], self._touched[which] = configurations, False

    def step(
        self,
        which: Int[np.ndarray, " some"],
        velocities: Float[np.ndarray, "some motors"],
        dt: float,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Let the motors of these turn for dt (s), each slipping by its own generator."""
        body = self._body
        moving = velocities * np.array(body.motor_gains or 1.0)
        if body.slip:
            moving *= 1 + body.slip * np.reshape(
                [rng.standard_normal(moving.shape[1]) for rng in rngs], moving.shape
            )
        joints, touched = self._joints[which], np.zeros(len(which), bool)
        turn_all(joints, body.chain, body.ranges, body.radius, self._edges, moving, dt, touched)
        self._joints[which], self._touched[which] = joints, touched
