import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.navigation.hypotheses import Hypotheses, SceneMemory

STEPS = 40
TURNED = np.array([1.5, 1.3, 1.1, 0.9])


def circuit(*, marked: bool, rounds: int = 8) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A walk round and round: angle, codes and smells; opposite places look alike but for a mark at one."""
    rng = np.random.default_rng(0)
    angle = 2 * np.pi * np.arange(rounds * STEPS) / STEPS + 0.02 * rng.standard_normal(rounds * STEPS)
    return angle, seen(angle, marked=marked), np.column_stack([np.cos(angle), np.sin(angle)])


def seen(angle: np.ndarray, *, marked: bool) -> np.ndarray:
    mark = np.exp(8 * (np.cos(angle) - 1)) if marked else 0 * angle
    return np.column_stack([np.cos(2 * angle), np.sin(2 * angle), 6 * mark])


def looked(angles: np.ndarray, *, marked: bool) -> tuple[Hypotheses, np.ndarray]:
    known, codes, smells = circuit(marked=marked)
    memory = SceneMemory(codes, smells)
    looks = memory.looks(seen(angles, marked=marked))
    found = Hypotheses(memory, looks[0])
    for look in looks[1:]:
        found.weigh(look)
    return found, known


def test_a_mark_tells_places_apart_that_look_alike() -> None:
    alike, _ = looked(np.array([1.5]), marked=True)
    assert len(alike.evidence_) >= 2
    assert alike.lead_ < 5
    found, known = looked(TURNED, marked=True)
    assert found.lead_ > 5
    assert np.cos(known[found.view_] - TURNED[-1]) > 0.9


def test_without_a_mark_nothing_tells_them_apart() -> None:
    found, _ = looked(TURNED, marked=False)
    assert len(found.evidence_) >= 2
    assert found.lead_ < 2


def test_too_little_memory_is_refused() -> None:
    _, codes, smells = circuit(marked=True, rounds=2)
    with pytest.raises(CogmapError, match="no memory"):
        _ = SceneMemory(codes, smells).known
