"""The gymnasium environment: an animal in a room, steered by someone who senses what it senses."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import cv2
import gymnasium
import numpy as np
from jaxtyping import Float, UInt8
from pydantic import Field

from arena.bodies.base import POSE, Body, Placed
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.explorers import Observation
from arena.eye.base import AnyEye, see
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.settings import Settings, Whole, checked_whole
from arena.smell.nose import Nose
from arena.topview import TopView

_COUNTS = ("nothing", "one number", "two numbers", "three numbers", "four numbers")

Reward = Callable[[Observation, Observation], float]
"""Judges a step by what was sensed before and after it."""


class OdourClimbed(Settings):
    r"""Reward the climb of one odour as it is smelt, log c(after) − log c(before).

    Parameters
    ----------
    odorant
        Which, counted from 0.

    Raises
    ------
    ArenaError
        When there is no such odorant.
    """

    odorant: Annotated[int, Field(ge=0)] = 0

    def __call__(self, before: Observation, after: Observation) -> float:
        """Judge a step."""
        return math.log(self._smelt(after).item()) - math.log(self._smelt(before).item())

    def of_all(self, before: Observation, after: Observation) -> Float[np.ndarray, " explorers"]:
        """Judge a step of many, each as alone, bit by bit."""
        # numpy's own logarithm has another last digit.
        up, down = (np.array([*map(math.log, self._smelt(sensed).tolist())]) for sensed in (after, before))
        climbed: np.ndarray = up - down
        return climbed

    def _smelt(self, sensed: Observation) -> np.ndarray:
        try:
            return np.asarray(sensed["odour"][..., self.odorant])
        except IndexError:
            raise ArenaError(
                f"there is no odorant {self.odorant} to climb, the room has {sensed['odour'].shape[-1]} "
                "odour sources; choose another one, another room or another reward"
            ) from None


class Explorer(gymnasium.Env[Observation, np.ndarray]):
    """An animal that sees and smells a room: `gymnasium.make("arena/Explorer-v0", arena="furnished")`.

    An observation is `{"view": (height, width, 3) uint8, "odour": (odorants,) float32}`, concentrations as
    the nose smells them. An action is a number in [−1, 1] for each motor: of a disc speed over
    `body.max_speed` and turn rate over `body.max_turn`, or the speeds of the left and the right wheel over
    `body.max_speed`; what is too much the body cuts. No state ends an episode; gymnasium truncates it after
    `max_episode_steps` (2000).

    `reset(options={"pose": (x, y, heading)})` chooses the start, which is drawn from free space otherwise;
    of a body with joints `options={"joints": (...)}`, where it is on its axes. The truth is in `info` only:
    `pose` (x, y in m, heading in rad, of the eye), `joints` if there are any, and `touched`, whether the
    last step was stopped: by a wall, the platform's border, the end of an axis.

    Parameters
    ----------
    arena
        A room, the name of one in the gallery, or the path of a TOML file; a furnished one unless told.
    camera, nose, body
        The animal.
    control
        "velocity" or, of a disc, "wheels".
    reward
        Judges a step by the observations before and after it; the climb of the first odour unless told.
    dt
        Length of a step, s.
    render_mode
        "rgb_array" for frames with the view beside a top view; None for none.

    Raises
    ------
    ArenaError
        For parameters, options and actions that mean nothing, and for steps before the first reset.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 20}  # noqa: RUF012

    def __init__(
        self,
        arena: Arena | str | Path = "furnished",
        *,
        camera: AnyEye = Camera.panoramic(92, 15),
        nose: Nose = Nose(),
        body: Body = Disc(),
        control: Literal["velocity", "wheels"] = "velocity",
        reward: Reward = OdourClimbed(),
        dt: float = 0.05,
        render_mode: Literal["rgb_array"] | None = None,
    ) -> None:
        if not 0 < dt < math.inf:
            raise ArenaError(f"dt is {dt} s; give a positive length of a step")
        if control not in ("velocity", "wheels"):
            raise ArenaError(f"control is {control!r}; choose 'velocity' or 'wheels'")
        if control == "wheels" and not isinstance(body, Disc):
            raise ArenaError(f"the {type(body).__name__} has no two wheels; choose the control 'velocity'")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ArenaError(f"render_mode is {render_mode!r}; choose 'rgb_array' or None")
        self.arena = arena if isinstance(arena, Arena) else Arena.load(arena)
        self.camera = camera
        self.nose = nose
        self.body = body
        self.control = control
        self.reward = reward
        self.dt = dt
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": max(1, round(1 / dt))}
        self.action_space = gymnasium.spaces.Box(-1, 1, (len(body.motors),), np.float32)
        odorants, smelt = len(self.arena.sources), np.finfo(np.float32)
        self.observation_space = gymnasium.spaces.Dict(  # type: ignore[assignment]
            {
                "view": gymnasium.spaces.Box(0, 255, (camera.height, camera.width, 3), np.uint8),
                "odour": gymnasium.spaces.Box(smelt.tiny, smelt.max, (odorants,), np.float32),
            }
        )
        self._top = TopView(self.arena)
        self._placed: Placed | None = None
        self._now = np.zeros(1)

    def reset(
        self, *, seed: Whole | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode, where the options say or anywhere in free space."""
        super().reset(seed=None if seed is None else checked_whole("seed", seed))
        self._placed = self.body.place(self.arena, self.start(options or {}), self.np_random)
        self._sniffer = self.nose.sniffer(len(self.arena.sources), self.np_random)
        self._now[0] = 0.0
        self._trail: list[tuple[float, float]] = []
        info = self._sense(self._placed, touched=False)
        return copied(self._sensed), info

    def start(self, options: Mapping[str, Any]) -> tuple[float, ...]:
        """Read the options of `reset`, or draw a start from free space."""
        drawn = _start(options, self.body)
        return drawn or tuple(self.body.sample_free(self.arena, 1, self.np_random)[0].tolist())

    def velocities(self, actions: Float[np.ndarray, "... motors"]) -> Float[np.ndarray, "... motors"]:
        """Turn actions into what the motors should do, m/s or rad/s."""
        if self.control == "wheels" and isinstance(self.body, Disc):
            wheels = (actions * self.body.max_speed).reshape(-1, 2).tolist()
            rolled = [self.body.from_wheels(left, right) for left, right in wheels]
            return np.array(rolled).reshape(actions.shape)
        return self.body.velocities(actions)

    def step(self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Obey for `dt` seconds, then look and smell."""
        if self._placed is None:
            raise ArenaError("the animal is nowhere yet; call reset() before the first step()")
        command = np.asarray(action, float)
        if command.shape != self.action_space.shape:
            wanted = _COUNTS[len(self.body.motors)]
            raise ArenaError(
                f"the action has shape {command.shape}; {self.control} takes {wanted} between -1 and 1"
            )
        touched = self._placed.go(self.velocities(command).tolist(), self.dt)
        self._now[0] += self.dt
        before = self._sensed
        info = self._sense(self._placed, touched=touched)
        after = copied(self._sensed)
        return after, self.reward(before, copied(after)), False, False, info

    def render(self) -> UInt8[np.ndarray, "height width 3"] | None:
        """Draw what the animal sees beside where it is, padded to an even size, as films want it."""
        if self.render_mode is None:
            return None
        if self._placed is None:
            raise ArenaError("the animal is nowhere yet; call reset() before render()")
        view = self._sensed["view"]
        there = np.array([self._placed.configuration])
        pose, links = self.body.camera_poses(there)[0].tolist(), None
        if self.body.axes != POSE:
            links = self.body.segments(there)[0]
        top = self._top.draw(tuple(pose), self.body.radius, np.array(self._trail), links)
        rows = len(top)
        # A strip is many times as wide as high: no more than two squares of the frame.
        scale = min(rows / view.shape[0], 2 * rows / view.shape[1])
        size = max(1, round(scale * view.shape[1])), max(1, round(scale * view.shape[0]))
        shown = cv2.resize(view, size, interpolation=cv2.INTER_NEAREST if scale > 1 else cv2.INTER_AREA)
        frame = np.zeros((rows, size[0], 3), np.uint8)
        above = (rows - size[1]) // 2
        frame[above : above + size[1]] = shown
        drawn = np.hstack([frame, top])
        odd = [(0, length % 2) for length in drawn.shape[:2]]
        return np.pad(drawn, [*odd, (0, 0)])

    def _sense(self, placed: Placed, *, touched: bool) -> dict[str, Any]:
        there = np.array([placed.configuration])
        poses = self.body.camera_poses(there)
        view = np.empty((1, self.camera.height, self.camera.width, 3), np.uint8)
        see(self.camera, self.arena, self.body, there, out=view, rng=self.np_random)
        odour = self._sniffer.smell(self.arena.odours.concentration(poses[:, :2]), self._now)[0]
        if self.render_mode is not None:
            self._trail.append((poses[0, 0], poses[0, 1]))
        self._sensed = {"view": view[0], "odour": odour}
        joints = {} if self.body.axes == POSE else {"joints": there[0]}
        return {"pose": poses[0], "touched": touched, **joints}


def copied(sensed: Observation) -> Observation:
    """Copy what is handed out: whoever scales it in place changes neither reward nor frame."""
    return {name: values.copy() for name, values in sensed.items()}


def _start(options: Mapping[str, Any], body: Body) -> tuple[float, ...] | None:
    """Read the options of `Explorer.reset`."""
    name, wanted = "pose" if body.axes == POSE else "joints", ", ".join(axis.name for axis in body.axes)
    unknown = options.keys() - {name}
    if unknown:
        raise ArenaError(f"unknown options {sorted(unknown)}; the only one is {name!r}, ({wanted})")
    if name not in options:
        return None
    try:
        start = tuple(float(part) for part in options[name])
    except (TypeError, ValueError):
        start = ()
    if len(start) != len(body.axes):
        raise ArenaError(f"the option {name} is {options[name]!r}; give {wanted}, in m and rad")
    return start
