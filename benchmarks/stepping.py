"""Steps per second of the gymnasium environment that sees and smells, against RatInABox's blind agent."""

import importlib.util
from collections.abc import Callable

import gymnasium
import numpy as np

from benchmarks.timing import ROOM, Figures, missing, one_core, rate, versus

STEPS = 200


def stepping() -> Figures:
    """Step with a 92×15 strip and smell, in turn with `Agent.update`, both on the same core."""
    with one_core():
        ours = explorer()
        if importlib.util.find_spec("ratinabox") is None:
            ours()
            return {"per_s": rate(ours), **missing("ratinabox")}
        return versus(ours, rat())


def explorer() -> Callable[[], int]:
    """Give work that steps through gymnasium's own wrappers at random velocities, without its checker."""
    env = gymnasium.make("arena/Explorer-v0", arena=ROOM, max_episode_steps=10**9, disable_env_checker=True)
    env.reset(seed=0)
    actions = np.random.default_rng(0).uniform(-1, 1, (STEPS, 2)).astype(np.float32)
    actions[:, 0] = np.abs(actions[:, 0])

    def walk() -> int:
        for action in actions:
            env.step(action)
        return STEPS

    return walk


def rat() -> Callable[[], int]:
    """Give work that moves RatInABox's agent at random in a box of the platform's size."""
    from ratinabox.Agent import Agent  # noqa: PLC0415  a peer that may be missing
    from ratinabox.Environment import Environment  # noqa: PLC0415

    agent = Agent(Environment(params={"aspect": 4 / 3, "scale": 3}), params={"save_history": False})

    def walk() -> int:
        for _ in range(STEPS):
            agent.update()
        return STEPS

    return walk
