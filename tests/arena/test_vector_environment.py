from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from arena.bodies.disc import Disc
from arena.bodies.heavy_disc import HeavyDisc
from arena.bodies.neck import Neck
from arena.environment import Observation
from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.smell.nose import Nose
from arena.vector_environment import VectorExplorer


def both(mode: AutoresetMode, **fields: Any) -> tuple[Any, Any]:
    fields = {"arena": "pillar", "camera": Camera.panoramic(16, 4), "max_episode_steps": 6, **fields}
    ours = gymnasium.make_vec(
        "arena/Explorer-v0",
        num_envs=5,
        vectorization_mode="vector_entry_point",
        autoreset_mode=mode,
        **fields,
    )
    assert isinstance(ours, VectorExplorer)
    one = {"vectorization_mode": "sync", "vector_kwargs": {"autoreset_mode": mode}}
    return ours, gymnasium.make_vec("arena/Explorer-v0", num_envs=5, **one, **fields)


def same(found: Any, wanted: Any) -> None:
    if isinstance(wanted, dict):
        assert found.keys() == wanted.keys()
        for key in wanted:
            same(found[key], wanted[key])
    elif isinstance(wanted, tuple) or getattr(wanted, "dtype", np.dtype(int)).hasobject:
        for a, b in zip(found, wanted, strict=True):
            same(a, b)
    else:
        np.testing.assert_array_equal(found, wanted)
        assert getattr(found, "dtype", None) == getattr(wanted, "dtype", None)


def brightening(before: Observation, after: Observation) -> float:
    return after["view"].mean() - before["view"].mean() + after["odour"].item(1)


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize(
    "fields",
    [
        {"nose": Nose(fluctuation=0.3)},
        {"control": "wheels", "reward": brightening},
        {"camera": Camera.panoramic(16, 4, noise=0.1)},
        {"body": Disc(slip=0.1, wheel_gains=(0.7, 1.0), swapped=True, delay=0.07)},
        {"body": HeavyDisc(delay=0.05)},
        {"arena": "furnished", "body": Neck(base=Disc(slip=0.1)), "camera": Overhead(16, 16, noise=0.1)},
    ],
)
def test_each_is_as_alone_bit_by_bit(mode: AutoresetMode, fields: dict[str, Any]) -> None:
    ours, alone = both(mode, **fields)
    same(ours.reset(seed=3), alone.reset(seed=3))
    ours.action_space.seed(0)
    for _ in range(20):
        actions = ours.action_space.sample()
        for found, wanted in zip(ours.step(actions), alone.step(actions), strict=True):
            same(found, wanted)


def test_without_autoreset_those_that_ended_are_reset_by_hand() -> None:
    ours, alone = both(AutoresetMode.DISABLED)
    same(ours.reset(seed=list(range(5))), alone.reset(seed=list(range(5))))
    for _ in range(6):
        *_, ended, _ = ours.step(np.full((5, 2), 0.3, np.float32))
        alone.step(np.full((5, 2), 0.3, np.float32))
    assert ended.all()
    with pytest.raises(ArenaError, match="reset_mask"):
        ours.step(np.zeros((5, 2), np.float32))
    mask = np.array([True, False, True, False, False])
    found, wanted = (env.reset(options={"reset_mask": mask.copy()}) for env in (ours, alone))
    same(found, wanted)


def test_what_is_given_is_not_changed_later_and_fits_the_spaces() -> None:
    ours, _ = both(AutoresetMode.NEXT_STEP)
    sensed, _ = ours.reset(seed=0)
    kept = sensed["view"].copy()
    later = ours.step(np.ones((5, 2), np.float32))[0]
    np.testing.assert_array_equal(sensed["view"], kept)
    assert sensed in ours.observation_space
    assert later in ours.observation_space


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"num_envs": 0}, "num_envs is 0; give a whole number"),
        ({"render_mode": "rgb_array"}, "draw no frames"),
    ],
)
def test_bad_parameters_are_one_sentence(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(ArenaError, match=message):
        VectorExplorer("pillar", **fields)


def test_bad_actions_and_steps_before_reset() -> None:
    ours = VectorExplorer("pillar", num_envs=2)
    with pytest.raises(ArenaError, match="call reset"):
        ours.step(np.zeros((2, 2)))
    ours.reset(seed=0)
    for bad in (np.zeros((3, 2)), np.full((2, 2), np.nan)):
        with pytest.raises(ArenaError, match="action"):
            ours.step(bad)


def test_what_is_handed_out_may_be_changed_in_place() -> None:
    def run(*, meddle: bool) -> list[np.ndarray]:
        env = VectorExplorer(num_envs=np.int64(3), camera=Camera.panoramic(16, 4))
        seen, _ = env.reset(seed=np.arange(3))
        rewards = []
        for _ in range(3):
            if meddle:
                seen["odour"] -= seen["odour"].mean()
            seen, reward, *_ = env.step(np.full((3, 2), 0.3))
            rewards.append(reward)
        return rewards

    np.testing.assert_array_equal(run(meddle=False), run(meddle=True))
