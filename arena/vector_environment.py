"""The vectorised environment: many animals in one room that pass through each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from arena.bodies.base import POSE
from arena.environment import Explorer, OdourClimbed, copied
from arena.errors import ArenaError
from arena.explorers import Explorers, Observation
from arena.rooms.arena import Arena
from arena.settings import Whole, checked_whole

Truth = dict[str, Any]


class VectorExplorer(gymnasium.vector.VectorEnv[Observation, np.ndarray, np.ndarray]):
    """Many an `Explorer` in one room, each the same as alone with its seed, bit by bit.

    `gymnasium.make_vec("arena/Explorer-v0", num_envs=1024, vectorization_mode="vector_entry_point",
    arena="furnished")`. All bodies move, all noses smell and all eyes are painted in one call each.
    Observations and `info` are those of gymnasium's own `SyncVectorEnv`, and so are seeds and autoreset.

    Parameters
    ----------
    arena
        As for `Explorer`.
    num_envs
        How many animals.
    max_episode_steps
        Steps after which an episode is truncated; None never does.
    autoreset_mode
        A gymnasium `AutoresetMode` or its value.
    fields
        What else an `Explorer` takes, but `render_mode`.

    Raises
    ------
    ArenaError
        As `Explorer` does, and for a count or length of an episode below one.
    """

    def __init__(
        self,
        arena: Arena | str | Path = "furnished",
        *,
        num_envs: Whole = 1,
        max_episode_steps: Whole | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        **fields: Any,
    ) -> None:
        num_envs = checked_whole("num_envs", num_envs, 1)
        if max_episode_steps is not None:
            max_episode_steps = checked_whole("max_episode_steps", max_episode_steps, 1)
        if fields.get("render_mode") is not None:
            raise ArenaError("many explorers draw no frames; leave render_mode out")
        self.explorer = Explorer(arena, **fields)
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.explorer.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = self.explorer.observation_space
        self.single_action_space = self.explorer.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._most = math.inf if max_episode_steps is None else max_episode_steps
        one = self.explorer
        self._explorers = Explorers(one.arena, one.camera, nose=one.nose, body=one.body, count=num_envs)
        self._steps = np.zeros(num_envs, int)
        self._done = np.zeros(num_envs, bool)
        self._rngs: list[Any] = [None] * num_envs
        self._sensed: Observation = {}

    def reset(
        self,
        *,
        seed: Whole | Sequence[Whole | None] | np.ndarray | None = None,
        options: Mapping[str, Any] | None = None,
    ) -> tuple[Observation, Truth]:
        """Begin episodes, in those where `options["reset_mask"]` is true, or in all; see `Explorer.reset`."""
        options = dict(options or {})
        which = np.flatnonzero(options.pop("reset_mask", np.ones(self.num_envs, bool)))
        if isinstance(seed, int | np.integer):
            seed = [checked_whole("seed", seed) + k for k in range(self.num_envs)]
        seeds = None if seed is None else [None if s is None else checked_whole("seed", s) for s in seed]
        if seeds is not None and len(seeds) != self.num_envs:
            raise ArenaError(f"there are {len(seeds)} seeds for {self.num_envs} explorers; give one each")
        self._begin(which, options, seeds)
        self._sensed = self._explorers.sense(which)
        return copied(self._sensed), self._truth(which)

    def step(self, actions: np.ndarray) -> tuple[Observation, np.ndarray, np.ndarray, np.ndarray, Truth]:
        """Obey for `dt` seconds, then look and smell; who has ended begins anew."""
        mode, actions, everyone = self.autoreset_mode, np.asarray(actions, float), np.arange(self.num_envs)
        if not self._sensed:
            raise ArenaError("the animals are nowhere yet; call reset() before the first step()")
        if actions.shape != self.action_space.shape:
            raise ArenaError(
                f"the actions have shape {actions.shape}; for {self.num_envs} give {self.action_space.shape}"
            )
        if mode is AutoresetMode.DISABLED and self._done.any():
            raise ArenaError("some episodes have ended; reset them with options={'reset_mask': ended}")
        again = self._done & (mode is AutoresetMode.NEXT_STEP)
        self._move(np.flatnonzero(~again), actions)
        self._begin(np.flatnonzero(again), {})
        before, self._sensed = self._sensed, self._explorers.sense(everyone)
        rewards = np.where(again, 0.0, self._judge(before, self._sensed))
        truncated = self._steps >= self._most
        self._done = truncated.copy()
        info = self._truth(everyone)
        if mode is AutoresetMode.SAME_STEP and truncated.any():
            ended, last = np.flatnonzero(truncated), np.full(self.num_envs, None)
            for k in ended.tolist():
                last[k] = _row(self._sensed, k)
            final = {"final_obs": last, "final_info": self._truth(ended)}
            self._begin(ended, {})
            self._sensed = self._explorers.sense(ended)
            info = {**self._truth(everyone), **final, **{f"_{name}": truncated.copy() for name in final}}
        return copied(self._sensed), rewards, np.zeros(self.num_envs, bool), truncated, info

    def _begin(
        self, which: np.ndarray, options: Mapping[str, Any], seeds: Sequence[int | None] | None = None
    ) -> None:
        one, starts = self.explorer, []
        for k in which.tolist():
            seed = None if seeds is None else seeds[k]
            # The explorer lends itself: what it draws at a reset is what it would draw alone.
            if seed is None and self._rngs[k] is not None:
                one.np_random = self._rngs[k]
            else:
                gymnasium.Env.reset(one, seed=seed)
            self._rngs[k] = one.np_random
            starts.append(one.start(options))
        self._explorers.begin(which, starts, [self._rngs[k] for k in which.tolist()])
        self._steps[which], self._done[which] = 0, False

    def _move(self, which: np.ndarray, actions: np.ndarray) -> None:
        if not np.isfinite(actions[which]).all():
            raise ArenaError("some actions are not finite; give numbers between -1 and 1")
        self._explorers.act(which, self.explorer.velocities(actions[which]), self.explorer.dt)
        self._steps[which] += 1

    def _judge(self, before: Observation, after: Observation) -> np.ndarray:
        reward = self.explorer.reward
        if isinstance(reward, OdourClimbed):
            return reward.of_all(before, after)
        return np.array([reward(_row(before, k), _row(after, k)) for k in range(self.num_envs)])

    def _truth(self, which: np.ndarray) -> Truth:
        told, there = dict[str, np.ndarray](), np.zeros(self.num_envs, bool)
        there[which] = True
        explorers = self._explorers
        truth = {"pose": explorers.poses(which), "touched": explorers.touched(which)}
        if explorers.body.axes != POSE:
            truth["joints"] = explorers.configurations(which)
        for name, known in truth.items():
            told[name] = np.zeros((self.num_envs, *known.shape[1:]), known.dtype)
            told[name][which] = known
            told[f"_{name}"] = there.copy()
        return told


def _row(sensed: Observation, k: int) -> Observation:
    return {name: values[k].copy() for name, values in sensed.items()}
