from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from arena import Arena
from cogmap.experiments.controls import homology as module
from cogmap.experiments.controls.homology import Case
from cogmap.experiments.registry import experiments, run_experiment
from cogmap.map.activity import Activity
from cogmap.shape import Betti, Nerve

ROOMS = {"open_field", "furnished", "pillar", "two_pillars", "l_shape"}


def found(
    numbers: tuple[int, ...],
    *,
    loops: tuple[float, ...] = (5.0, 1.5),
    voids: tuple[float, ...] = (1.1,),
    reasons: tuple[str, ...] = ("", "", ""),
) -> Betti:
    bars = [np.array([[0.0, np.inf]]), *(np.array([[1.0, ratio] for ratio in r]) for r in (loops, voids))]
    return Betti(
        numbers, tuple(bars), (np.inf, 2.0, 1.25), (3, 3, 2), 3, (400, 400, 150), 17_000, "geodesic", reasons
    )


def test_rooms_visited_unless_told_are_those_whose_holes_are_known() -> None:
    homology = experiments()["homology"]
    assert {homology.room, *homology.extra_rooms} == ROOMS


@pytest.mark.parametrize(
    ("numbers", "expected", "judged"),
    [
        ((1, 2, 1), (1, 2, 1), "right"),
        ((1, 2, 1), (1, 2), "right"),
        ((1, 2, 0), (1, 2, 1), "wrong"),
        ((2, 1, 0), (1, 1), "wrong"),
    ],
)
def test_a_case_is_right_where_it_is_asked(
    numbers: tuple[int, ...], expected: tuple[int, ...], judged: str
) -> None:
    assert Case("pillar", "fused", expected, found(numbers), None).right == (judged == "right")
    assert not Case("pillar", "fused", expected, None, None).right


def test_a_nerve_is_right_when_its_numbers_are() -> None:
    def case(nerve: Nerve | None) -> Case:
        return Case("pillar", "place", (1, 1), found((1, 3, 0)), nerve)

    assert case(Nerve((1, 1), (9, 9, 9))).nerve_right
    assert not case(Nerve((1, 2), (9, 9, 9))).nerve_right
    assert not case(None).nerve_right


def test_the_margin_is_that_of_the_closest_call_asked_for() -> None:
    def margin(expected: tuple[int, ...], loops: tuple[float, ...], voids: tuple[float, ...]) -> float | None:
        return Case("pillar", "fused", expected, found((1, 1, 0), loops=loops, voids=voids), None).margin

    assert margin((1, 1), (5.0, 1.6), (1.24,)) == pytest.approx(2.0 / 1.6)
    assert margin((1, 1), (2.2, 1.6), (1.24,)) == pytest.approx(1.1)
    assert margin((1, 1, 0), (2.2, 1.6), (1.2,)) == pytest.approx(1.25 / 1.2)
    assert margin((1,), (2.2, 1.6), (1.2,)) is None
    assert Case("pillar", "fused", (1, 1), None, None).margin is None


def test_it_writes_right_and_wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Homology is replaced, as the small walk leaves gaps; heading is as without a compass."""
    told = {"view_manifold": (1, 2, 1), "fused": (1, 1, 0), "place": (1, 1, 0)}
    asked: list[Activity] = []

    def fake(codes: np.ndarray, activity: Activity, smells: np.ndarray, *, seed: int) -> dict[str, Betti]:
        assert codes.shape == (300, 60)
        assert smells.shape == (300, 3)
        assert seed == 2
        asked.append(activity)
        doubts = {"place": ("", "", "a doubt"), "view_manifold": ("", "a doubt", "")}
        return {
            name: found(numbers, reasons=doubts.get(name, ("", "", ""))) for name, numbers in told.items()
        }

    monkeypatch.setattr(module, "homologies", fake)
    monkeypatch.setattr(module, "population_nerve", lambda rates: Nerve((1, 1), (rates.shape[1], 2, 1)))
    result = run_experiment("homology", tmp_path / "out", room=Arena.load("pillar"), views=300, seed=2)
    (activity,) = asked
    assert len(activity) == 300
    assert result.metrics["arena"] == "pillar"
    assert (result.metrics["right"], result.metrics["cases"]) == (2, 4)
    assert (result.metrics["nerve_right"], result.metrics["nerve_cases"]) == (1, 2)
    # What is not asked for need not be sure, and headings without a compass are not.
    assert (result.metrics["resolved"], result.metrics["wrong_and_resolved"]) == (2, 1)
    rooms = result.metrics["rooms"]["pillar"]
    assert rooms["view_manifold"]["resolved"] == [True, False, True]
    assert rooms["view_manifold"]["unresolved_because"] == ["", "a doubt", ""]
    assert {name: told["right"] for name, told in rooms.items()} == {
        "view_manifold": True,
        "fused": False,
        "place": True,
        "heading": False,
    }
    assert rooms["fused"]["betti"] == [1, 1, 0]
    assert rooms["fused"]["expected"] == [1, 2]
    assert rooms["fused"]["votes"] == [3, 3, 2]
    assert rooms["place"]["nerve"] == [1, 1]
    assert "betti" not in rooms["heading"]
    assert all(told["reason"] for told in rooms.values())
    assert {file.stem for file in (tmp_path / "out").glob("*.png")} == {"barcodes", "miss_pillar_fused"}
    bars = pd.read_parquet(tmp_path / "out" / "bars.parquet")
    fused = bars[(bars["cloud"] == "fused") & (bars["dimension"] == 1)]
    assert fused["ratio"].tolist() == [5.0, 1.5]
    assert fused["counts"].tolist() == [True, False]
    assert set(fused["threshold"]) == {2.0}
    assert set(bars["arena"]) == {"pillar"}


def test_unless_told_it_visits_all_its_rooms(monkeypatch: pytest.MonkeyPatch) -> None:
    def fake(conditions: module.Conditions) -> list[Case]:
        nerve = Nerve((1, 1), (60, 9, 9))
        return [Case(conditions.room.name, "heading", (1, 1), found((1, 1, 0)), nerve)]

    monkeypatch.setattr(module, "_visit", fake)
    metrics = run_experiment("homology").metrics
    assert metrics["arena"] == "open_field, furnished, pillar, two_pillars, l_shape"
    assert ", ".join(metrics["rooms"]) == metrics["arena"]
    assert metrics["right"] == metrics["cases"] == metrics["nerve_right"] == metrics["nerve_cases"] == 5
