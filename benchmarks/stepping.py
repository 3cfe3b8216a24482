"""Steps per second of the gymnasium environment that sees and smells, against RatInABox's blind agent."""

import importlib.util
from collections.abc import Callable

import gymnasium
import numpy as np

from benchmarks.timing import ROOM, Figures, missing, one_core, rate, versus

STEPS = 400
EXPLORERS = 1024


def stepping() -> Figures:
    """Step with a 92×15 strip and smell on one core, steps per second.

    One explorer stands beside `Agent.update` of RatInABox, which sees and smells nothing, and 1,024 in one
    room, by `gymnasium.make_vec`, beside the one.
    """
    with one_core():
        ours = explorer()
        together: Figures = {"explorers": versus(explorers(), ours, beside="one explorer")}
        if importlib.util.find_spec("ratinabox") is None:
            return {"explorer": {"per_s": rate(ours), **missing("RatInABox")}, **together}
        return {"explorer": versus(ours, rat(), beside="RatInABox"), **together}


def explorer() -> Callable[[], int]:
    """Give work that steps through gymnasium's own wrappers, unchecked: runs, and spins at walls."""
    env = gymnasium.make("arena/Explorer-v0", arena=ROOM, max_episode_steps=10**9, disable_env_checker=True)
    env.reset(seed=0)
    runs, spin = _runs(STEPS), np.array([0.0, 1.0], np.float32)

    def walk() -> int:
        spins = 0
        for run in runs:
            *_, info = env.step(spin if spins else run)
            spins = 12 if info["touched"] else max(0, spins - 1)
        return STEPS

    return walk


def explorers(count: int = EXPLORERS) -> Callable[[], int]:
    """Give work that steps once with many explorers in one room, who do the same."""
    env = gymnasium.make_vec(
        "arena/Explorer-v0", num_envs=count, vectorization_mode="vector_entry_point", arena=ROOM
    )
    env.reset(seed=0)
    runs, spin, spins = _runs(count), np.array([0.0, 1.0], np.float32), np.zeros(count, int)

    def walk() -> int:
        *_, info = env.step(np.where(spins[:, None] > 0, spin, runs))
        spins[:] = np.where(info["touched"], 12, np.maximum(0, spins - 1))
        return count

    return walk


def _runs(count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    return rng.uniform((0.2, -0.5), (0.8, 0.5), (count, 2)).astype(np.float32)


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
