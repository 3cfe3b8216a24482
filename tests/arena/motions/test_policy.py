import gymnasium
import numpy as np

from arena import Arena, Camera, Policy, explore
from arena.motions.policy import Sensed

EYE = Camera.panoramic(16, 4)


class Watched:
    """Notes what it is told, and stops after ten views."""

    def __init__(self) -> None:
        self.told: list[Sensed] = []

    def __call__(self, sensed: Sensed) -> np.ndarray | None:
        self.told.append(sensed)
        return np.array([0.5, 0.1]) if len(self.told) < 10 else None


def test_a_policy_is_told_what_the_environment_lets_sense_and_no_pose() -> None:
    policy = Watched()
    assert isinstance(policy, Policy)
    explore(Arena.load("pillar"), policy, EYE)
    space = gymnasium.make("arena/Explorer-v0", arena="pillar", camera=EYE).observation_space
    assert len(policy.told) == 10
    assert all(sensed in space for sensed in policy.told)
