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

from arena.bodies.disc import Disc, Drive, Pose
from arena.errors import ArenaError
from arena.explorers import Observation
from arena.eye.base import Eye
from arena.eye.camera import Camera
from arena.motions.locomotion import random_start
from arena.rooms.arena import Arena
from arena.settings import Settings
from arena.smell.nose import Nose
from arena.topview import TopView

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
    the nose smells them. An action is two numbers in [−1, 1]: speed over `body.max_speed` and turn rate over
    `body.max_turn`, or the speeds of the left and the right wheel over `body.max_speed`; what is too much the
    body cuts. No state ends an episode; gymnasium truncates it after `max_episode_steps` (2000).

    `reset(options={"pose": (x, y, heading)})` chooses the start, which is drawn from free space otherwise.
    The truth is in `info` only: `pose` (x, y in m, heading in rad) and `touched`, whether the last step was
    stopped by a wall or the platform's border.

    Parameters
    ----------
    arena
        A room, the name of one in the gallery, or the path of a TOML file.
    camera, nose, body
        The animal.
    control
        "velocity" or "wheels".
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
        arena: Arena | str | Path,
        *,
        camera: Eye = Camera.panoramic(92, 15),
        nose: Nose = Nose(),
        body: Disc = Disc(),
        control: Literal["velocity", "wheels"] = "velocity",
        reward: Reward = OdourClimbed(),
        dt: float = 0.05,
        render_mode: Literal["rgb_array"] | None = None,
    ) -> None:
        if not 0 < dt < math.inf:
            raise ArenaError(f"dt is {dt} s; give a positive length of a step")
        if control not in ("velocity", "wheels"):
            raise ArenaError(f"control is {control!r}; choose 'velocity' or 'wheels'")
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
        self.action_space = gymnasium.spaces.Box(-1, 1, (2,), np.float32)
        odorants, smelt = len(self.arena.sources), np.finfo(np.float32)
        self.observation_space = gymnasium.spaces.Dict(  # type: ignore[assignment]
            {
                "view": gymnasium.spaces.Box(0, 255, (camera.height, camera.width, 3), np.uint8),
                "odour": gymnasium.spaces.Box(smelt.tiny, smelt.max, (odorants,), np.float32),
            }
        )
        self._top = TopView(self.arena)
        self._drive: Drive | None = None
        self._now = np.zeros(1)

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode, at `options["pose"]` or anywhere in free space."""
        super().reset(seed=seed)
        self._drive = self.body.place(self.arena, self.starting_pose(options or {}), self.np_random)
        self._sniffer = self.nose.sniffer(len(self.arena.sources), self.np_random)
        self._now[0] = 0.0
        self._trail: list[tuple[float, float]] = []
        return self._sense(self._drive, touched=False)

    def starting_pose(self, options: Mapping[str, Any]) -> Pose:
        """Read the options of `reset`, or draw a pose from free space."""
        return _start(options) or random_start(self.arena, self.body, self.np_random)

    def step(self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Obey for `dt` seconds, then look and smell."""
        if self._drive is None:
            raise ArenaError("the animal is nowhere yet; call reset() before the first step()")
        command = np.asarray(action)
        if command.shape != (2,):
            raise ArenaError(
                f"the action has shape {command.shape}; {self.control} takes two numbers between -1 and 1"
            )
        first, second = command.tolist()
        if self.control == "wheels":
            speed, turn = self.body.from_wheels(first * self.body.max_speed, second * self.body.max_speed)
        else:
            speed, turn = first * self.body.max_speed, second * self.body.max_turn
        touched = self._drive.step(speed, turn, self.dt)
        self._now[0] += self.dt
        before = self._sensed
        after, info = self._sense(self._drive, touched=touched)
        return after, self.reward(before, after), False, False, info

    def render(self) -> UInt8[np.ndarray, "height width 3"] | None:
        """Draw what the animal sees beside where it is."""
        if self.render_mode is None:
            return None
        if self._drive is None:
            raise ArenaError("the animal is nowhere yet; call reset() before render()")
        view = self._sensed["view"]
        top = self._top.draw(self._drive.pose, self.body.radius, np.array(self._trail))
        rows = len(top)
        # A strip is many times as wide as high: no more than two squares of the frame.
        scale = min(rows / view.shape[0], 2 * rows / view.shape[1])
        size = max(1, round(scale * view.shape[1])), max(1, round(scale * view.shape[0]))
        shown = cv2.resize(view, size, interpolation=cv2.INTER_NEAREST if scale > 1 else cv2.INTER_AREA)
        frame = np.zeros((rows, size[0], 3), np.uint8)
        above = (rows - size[1]) // 2
        frame[above : above + size[1]] = shown
        return np.hstack([frame, top])

    def _sense(self, drive: Drive, *, touched: bool) -> tuple[Observation, dict[str, Any]]:
        pose = np.array([drive.pose])
        view = self.camera.render(self.arena, pose, rng=self.np_random)[0]
        odour = self._sniffer.smell(self.arena.odours.concentration(pose[:, :2]), self._now)[0]
        if self.render_mode is not None:
            self._trail.append(drive.pose[:2])
        self._sensed = {"view": view, "odour": odour}
        return self._sensed, {"pose": pose[0], "touched": touched}


def _start(options: Mapping[str, Any]) -> Pose | None:
    """Read the options of `Explorer.reset`."""
    unknown = options.keys() - {"pose"}
    if unknown:
        raise ArenaError(f"unknown options {sorted(unknown)}; the only one is 'pose', (x, y, heading)")
    if "pose" not in options:
        return None
    try:
        x, y, heading = (float(part) for part in options["pose"])
    except (TypeError, ValueError):
        raise ArenaError(f"the option pose is {options['pose']!r}; give x, y (m) and heading (rad)") from None
    return x, y, heading
