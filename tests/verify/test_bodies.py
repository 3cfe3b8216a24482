"""`make verify`: bodies whose mechanism nobody has described, five walks of each, figures with their bars."""

from functools import cache
from typing import Any, NamedTuple

import pytest

from arena import Arm, Body, Neck, Rail, Turntable
from cogmap.experiments.registry import run_experiment

pytestmark = pytest.mark.full

SEEDS = (0, 1, 2, 3, 4)
RESOLVED = 4
"""Walks of five after which all Betti numbers are resolved, at least, where d ≤ 2."""


class Case(NamedTuple):
    """An experiment, the body it is told, and what must be found."""

    experiment: str
    body: Body
    dimension: int
    betti: list[int]
    located: tuple[float, ...] = ()
    """Errors of joints by a `Localiser` at most, medians, ° or m."""
    regressed: tuple[float, ...] = ()
    """Errors of joints by coordinates and regression, likewise."""
    most_views: int = 4000
    """Kept in the even memory."""


CASES = {
    "rail": Case("rail", Rail(), 1, [1, 0, 0], (0.0015,), (0.01,)),
    "turntable": Case("turntable", Turntable(), 1, [1, 1, 0], (0.1,), (1.6,)),
    **{
        f"{name} {limits}": Case(name, Arm(limits=limits), 2, betti, located, regressed)
        for name, located, regressed in (
            ("arm", (0.3, 0.3), (3.0, 3.0)),
            ("watched_arm", (0.15, 0.5), (1.5, 4.0)),
        )
        for limits, betti in (("none", [1, 2, 1]), ("one", [1, 1, 0]), ("both", [1, 0, 0]))
    },
    "neck": Case("neck", Neck(deck="unseen"), 3, [1, 1, 0], most_views=12_000),
}
LEAST = {
    "shoulder_cells_passing": 0.95,
    "elbow_cells_passing": 0.95,
    "reached_1deg": 0.97,
    "reached_half_deg": 0.92,
}
MOST = {"way_ratio_median": 1.4}
"""Bars of arms whose joints have no limits."""


@cache
def found(case: str, seed: int) -> dict[str, Any]:
    """Run an experiment once for all that is asked of it."""
    chosen = CASES[case]
    metrics = run_experiment(chosen.experiment, seed=seed, body=chosen.body).metrics
    print(case, seed, *(f"{key}={value}" for key, value in sorted(metrics.items())))  # noqa: T201
    return metrics


def within(errors: list[float], bars: tuple[float, ...]) -> bool:
    """Whether each joint's error is below its bar, where there are bars."""
    return not bars or all(error <= bar for error, bar in zip(errors, bars, strict=True))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("case", CASES)
def test_degrees_of_freedom_holes_and_joints_are_found(case: str, seed: int) -> None:
    metrics, wanted = found(case, seed), CASES[case]
    assert metrics["dimension"] == wanted.dimension
    assert metrics["betti"] == wanted.betti
    assert metrics["memory_views"] <= wanted.most_views
    assert within(metrics["joint_median_deg"], wanted.located)
    if all(metrics["betti_resolved"]):  # else there are no coordinates
        assert within(metrics["regression_median_deg"], wanted.regressed)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("case", [case for case in CASES if case.endswith("none")])
def test_an_arm_is_split_by_a_sense_and_reaches(case: str, seed: int) -> None:
    metrics = found(case, seed)
    missed = [f"{key} {metrics[key]:g} < {bar:g}" for key, bar in LEAST.items() if metrics[key] < bar]
    missed += [f"{key} {metrics[key]:g} > {bar:g}" for key, bar in MOST.items() if metrics[key] > bar]
    assert not missed


@pytest.mark.parametrize("case", CASES)
def test_none_is_resolved_and_wrong_and_most_are_resolved(case: str) -> None:
    """A number that is not resolved may be wrong; one that is may not."""
    wanted, resolved = CASES[case], []
    for seed in SEEDS:
        metrics = found(case, seed)
        numbers = zip(metrics["betti"], wanted.betti, metrics["betti_resolved"], strict=True)
        assert not [number for number, true, sure in numbers if sure and number != true], seed
        resolved.append(all(metrics["betti_resolved"]))
    if wanted.dimension <= 2:
        assert sum(resolved) >= RESOLVED
