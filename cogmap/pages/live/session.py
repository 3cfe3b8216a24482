"""A session: one explorer, what is done to it, and what it comes to, step by step. It knows no browser."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Float, Float32, UInt8

from arena import Arena, Box, Recording
from arena.angles import wrap_angle
from arena.errors import ArenaError
from arena.explorers import Explorers
from cogmap.control import Outcome, Reaching
from cogmap.errors import CogmapError
from cogmap.pages.live.mind import Thought
from cogmap.pages.live.world import World

DECISION = 0.2
"""Time (s) from one decision of what goes by itself to the next, as it learnt what commands do."""
LONGEST = 0.1
"""Of a step, s: a page that was asleep does not leap."""
ROUTE = 12
"""Dreamt views that a route is shown by."""
_ONE = np.zeros(1, int)


class Doing(StrEnum):
    """What moves the explorer."""

    STANDING = "standing"
    DRIVEN = "driven"
    GOING = "going"
    REPLAYING = "replaying"


@dataclass(frozen=True)
class Look:
    """All that a page shows of a moment. The truth in it, `pose` and what is beside it, is to be drawn."""

    pose: Float[np.ndarray, "3"] | None
    """Where the explorer is (m, m, rad); None in a replay without poses."""
    view: UInt8[np.ndarray, "height width 3"]
    """Black in the dark."""
    thought: Thought
    ghost: Float[np.ndarray, "3"]
    """Where the map believes it is, laid in the room; NaN for what it cannot tell."""
    errors: tuple[float, float]
    """Distance and angle between both, m and rad, NaN where unknown."""
    touched: bool


class Session:
    """An explorer in a world, driven by hand, by sight alone to a goal, or by a recording.

    Parameters
    ----------
    world
        Shared by all sessions, which change nothing of it: a box that one moves stays for the others.
    seed
        Of the start, slip and the noise of eye and nose.

    Attributes
    ----------
    doing, lights, room
        What moves it, whether it sees, and the room with whatever was moved.
    goal, route
        Pose of the goal (m, m, rad) and corners of the way to it, laid in the room; None and empty without.
    dreamt
        Dreamt views of the route, one more a step until all are there.
    replay, at
        Name of the recording that is replayed, and which of its views is shown.
    said
        What there is to say: how a journey ended, or why something was refused.
    """

    def __init__(self, world: World, *, seed: int = 0) -> None:
        self.world, self.room, self.lights = world, world.room, True
        self.doing, self.said = Doing.STANDING, ""
        self.goal: Float[np.ndarray, "3"] | None = None
        self.route: Float[np.ndarray, "points 2"] = np.zeros((0, 2))
        self.dreamt: list[UInt8[np.ndarray, "height width 3"]] = []
        self.replay, self.at, self.playing = "", 0, False
        self.version = 0
        self._rng = np.random.default_rng(seed)
        self._drive = np.zeros(2)
        self._policy: Reaching | None = None
        self._since, self._clock, self._touched = 0.0, 0.0, False
        self._believed = np.nan
        self._to_dream: deque[Float[np.ndarray, "3"]] = deque()
        start = world.body.sample_free(world.room, 1, self._rng)[0]
        self._explorers = self._begun(world.room, start)

    @property
    def pose(self) -> Float[np.ndarray, "3"]:
        """Where the explorer is (m, m, rad): the truth."""
        return np.asarray(self._explorers.poses(_ONE)[0])

    def stand(self, x: float, y: float, heading: float | None = None) -> None:
        """Put the explorer somewhere; it looks as before when no heading (rad) is given."""
        facing = float(self.pose[2]) if heading is None else float(wrap_angle(np.array(heading)))
        try:
            self._explorers = self._begun(self.room, np.array([x, y, facing]))
        except ArenaError:
            self.said = "the explorer does not fit there; choose a place on the platform, clear of walls"
            return
        self._rest()

    def turn(self, heading: float) -> None:
        """Let it look elsewhere (rad) from where it is."""
        self.stand(float(self.pose[0]), float(self.pose[1]), heading)

    def drive(self, forward: float, turn: float) -> None:
        """Drive it by hand until told otherwise: shares of its speed and turn rate, in [−1, 1]."""
        asked = np.clip(np.nan_to_num([forward, turn]), -1, 1)
        if asked.any():
            if self.doing is not Doing.DRIVEN:
                self._rest()
            self.doing, self._drive = Doing.DRIVEN, asked
        elif self.doing is Doing.DRIVEN:
            self.doing = Doing.STANDING

    def aim(self, x: float, y: float, heading: float) -> None:
        """Set a goal by the image that is seen from there, and go by sight alone.

        The pose makes the image; neither the map nor what goes is told it.
        """
        pose = np.array([x, y, heading], np.float64)
        if self.world.mind.reacher is None:
            self.said = self.world.mind.reason or "it does not know what its commands do; give --motor"
            return
        if not self.world.body.is_free(self.room, pose[None])[0]:
            self.said = "the goal is where the explorer does not fit; choose another"
            return
        image = self._seen(self.room, pose)
        self._rest()
        with self.world.lock:
            try:
                self._policy = self.world.mind.reacher.towards(image)
            except CogmapError as error:
                self.said = str(error)
                return
            self.goal, self.doing, self._since, self.said = pose, Doing.GOING, DECISION, "on its way"
            try:
                way = self.world.mind.way(self._sense()["view"][0], image, ROUTE)
            except CogmapError as error:
                # what goes bridges unknown views, or says itself that no way is known
                self.said = f"on its way, and does not dream it: {error}"
                return
        self.route, self._to_dream = self.world.in_room(way[:, :2]), deque(way)

    def stop(self) -> None:
        """Stop whatever moves it."""
        self._rest()

    def light(self, *, on: bool) -> None:
        """Switch the lamp; in the dark the nose is left."""
        self.lights = on
        self.version += 1

    def move_box(self, box: int, x: float, y: float) -> None:
        """Put the middle of a box elsewhere (m). The map remembers it where it was."""
        if not 0 <= box < len(self.room.boxes):
            self.said = f"there is no box {box}; the room has {len(self.room.boxes)}"
            return
        boxes = list(self.room.boxes)
        boxes[box] = Box(**{**boxes[box].model_dump(), "center": (float(x), float(y))})
        self._furnish(tuple(boxes))

    def tidy(self) -> None:
        """Put all boxes back."""
        self._furnish(self.world.room.boxes)

    def replayed(self, name: str) -> None:
        """Replay a recording by its name, from its beginning; an empty name ends it."""
        recordings = self.world.replays or {}
        if name and name not in recordings:
            self.said = f"there is no recording {name!r}; choose among {', '.join(recordings)}"
            return
        self._rest()
        self.replay, self.at, self.playing = name, 0, False
        if name:
            self.doing = Doing.REPLAYING
            shape = recordings[name].views.shape[1:]
            if tuple(shape) != self.world.mind.cmap.view_shape_ and recordings[name].poses is None:
                self.said = f"{name} has views of {shape[0]}×{shape[1]} pixels and no poses to look from"
                self.replay, self.doing = "", Doing.STANDING

    def scrub(self, view: int) -> None:
        """Show a view of the recording that is replayed."""
        if self.replay:
            self.at = int(np.clip(view, 0, self.length - 1))
            self._clock = float(self._recording.times[self.at])
            self.version += 1

    def play(self, *, on: bool) -> None:
        """Let the recording that is replayed run, at its own pace."""
        self.playing = on and bool(self.replay)

    @property
    def length(self) -> int:
        """Views of the recording that is replayed."""
        return len(self._recording) if self.replay else 0

    def step(self, seconds: float) -> bool:
        """Let time pass: give whether anything changed that a page shows."""
        before = self.version
        seconds = min(max(seconds, 0.0), LONGEST)
        if self._to_dream:
            with self.world.lock:
                self.dreamt.append(self.world.mind.dream(self._to_dream.popleft()))
            self.version += 1
        if self.doing is Doing.DRIVEN:
            self._act(self._drive, seconds)
        elif self.doing is Doing.GOING:
            self._go(seconds)
        elif self.playing:
            self._play_on(seconds)
        return self.version != before

    def look(self) -> Look:
        """Sense where it is, and think."""
        if self.replay:
            pose, view, odour = self._replayed_moment()
        else:
            sensed = self._sense()
            pose, view, odour = self.pose, sensed["view"][0], sensed["odour"][0]
        with self.world.lock:
            mind = self.world.mind
            lit = self.lights or bool(self.replay)
            thought = mind.look(view) if lit else mind.sniff(odour, self._believed)
        activity = thought.activity
        if lit:
            self._believed = float(activity.phase[0])
        where = self.world.in_room(activity.position.astype(np.float64))[0]
        ghost = np.array([*where, self.world.facing(float(activity.phase[0]))])
        away, turned = np.nan, np.nan
        if pose is not None:
            away = float(np.linalg.norm(ghost[:2] - pose[:2]))
            turned = float(abs(wrap_angle(np.array(ghost[2] - pose[2]))))
        return Look(pose, view, thought, ghost, (away, turned), self._touched)

    def _begun(self, room: Arena, pose: Float[np.ndarray, "3"]) -> Explorers:
        world = self.world
        explorers = Explorers(room, world.camera, nose=world.nose, body=world.body, count=1)
        explorers.begin(_ONE, [tuple(pose.tolist())], [self._rng])
        return explorers

    def _rest(self) -> None:
        self.doing, self._policy, self._drive = Doing.STANDING, None, np.zeros(2)
        self.replay, self.playing, self._touched, self.said = "", False, False, ""
        self.goal, self.route, self.dreamt = None, np.zeros((0, 2)), []
        self._to_dream.clear()
        self.version += 1

    def _furnish(self, boxes: tuple[Box, ...]) -> None:
        pose = self.pose
        try:
            room = self.room.model_copy(update={"boxes": boxes})
            self._explorers, self.room = self._begun(room, pose), room
        except ArenaError as error:
            self.said = f"the box stays where it was: {error}"
        self.version += 1

    def _sense(self) -> dict[str, np.ndarray]:
        sensed = self._explorers.sense(_ONE)
        if self.lights:
            return sensed
        return {**sensed, "view": np.zeros_like(sensed["view"])}

    def _seen(self, room: Arena, pose: Float[np.ndarray, "3"]) -> UInt8[np.ndarray, "height width 3"]:
        rng = self._rng if self.world.camera.noise else None
        return np.asarray(self.world.camera.render(room, pose[None], rng=rng)[0])

    def _act(self, command: Float[np.ndarray, "2"], seconds: float) -> None:
        self._explorers.act(_ONE, self.world.body.velocities(command[None]), seconds)
        self._touched = bool(self._explorers.touched(_ONE)[0])
        self.version += 1

    def _go(self, seconds: float) -> None:
        """Obey the last command, and ask for the next when its time is over."""
        if self._policy is None:
            return
        while seconds > 1e-9:
            if self._since > DECISION - 1e-9:
                sensed = {name: values[0] for name, values in self._sense().items()}
                with self.world.lock:
                    command = self._policy(sensed)
                if command is None:
                    self._arrive(self._policy)
                    return
                self._drive, self._since = np.asarray(command, np.float64), 0.0
            passed = min(seconds, DECISION - self._since)
            self._act(self._drive, passed)
            self._since += passed
            seconds -= passed

    def _arrive(self, policy: Reaching) -> None:
        """Say how a journey ended; goal and route stay to be seen."""
        arrived = policy.outcomes_[0] == Outcome.ARRIVED
        self.said = "arrived" if arrived else policy.reasons_[0]
        self.doing, self._policy, self._drive = Doing.STANDING, None, np.zeros(2)
        self.version += 1

    @property
    def _recording(self) -> Recording:
        return (self.world.replays or {})[self.replay]

    def _play_on(self, seconds: float) -> None:
        times = self._recording.times
        self._clock += seconds
        there = int(np.searchsorted(times, self._clock, side="right")) - 1
        there = min(max(there, 0), self.length - 1)
        if there != self.at:
            self.at = there
            self.version += 1
        self.playing = there < self.length - 1

    def _replayed_moment(
        self,
    ) -> tuple[
        Float[np.ndarray, "3"] | None, UInt8[np.ndarray, "height width 3"], Float32[np.ndarray, "odorants"]
    ]:
        walk = self._recording
        pose = None if walk.poses is None else np.asarray(walk.poses[self.at], np.float64)
        view = np.asarray(walk.views[self.at])
        if view.shape != self.world.mind.cmap.view_shape_ and pose is not None:
            view = self._seen(self.room, pose)
        return pose, view, np.zeros(0, np.float32)
