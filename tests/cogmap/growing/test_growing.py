import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from arena import Arena, Arm
from cogmap import CogmapError, CognitiveMap, UnlikeArithmeticWarning
from cogmap.growing import growing, growth
from cogmap.growing.checkpoint import Checkpoint, Place
from cogmap.growing.work import Outcome, do
from neurons.stages import STAGES
from tests.cogmap.growing.conftest import SMALL, backwards, grown, weights


def test_every_view_of_every_explorer_is_learnt_once(undisturbed: Path) -> None:
    cmap = CognitiveMap.load(undisturbed)
    state = cmap.state_dict()
    # what a view excites sums to one
    for cells in ("place", "heading"):
        assert float(state[f"{cells}.afferents.activity"].sum()) == pytest.approx(SMALL["views"], rel=1e-5)
    assert bool(state["olfaction.gram"][:, 0, 0].sum() > 0)
    assert (cmap.charts, cmap.epoch, cmap.view_shape_) == (60, 400, (15, 90, 3))
    assert cmap._rooms[0].stage is cmap._rooms[0].stages[-1]
    assert not list(undisturbed.parent.glob("*.growing"))


def test_the_map_is_that_of_the_usual_means_but_for_rounding(tmp_path: Path) -> None:
    changed = {"views": 1600, "explorers": 4, "charts": 100, "epoch": 1024}
    cmap = grown(tmp_path / "map", **changed)
    expedition = growing.Expedition(
        Arena.load("furnished").to_toml(), growing.Brownian(), SMALL["camera"], growing.Nose(),
        growing.Disc(), 4, 1600, 0,
    )  # fmt: skip
    ways = [expedition.walk(k) for k in range(4)]
    smells = np.concatenate([way.log_odours for way in ways])
    views = [expedition.views_on(k, ways[k].poses)[:] for k in range(4)]
    seen = np.concatenate(views)
    same = {name: SMALL[name] for name in ("components", "place_cells", "heading_cells")}
    usual = CognitiveMap(charts=100, epoch=1024, **same)
    for index, stage in enumerate(STAGES):
        if not stage.sums:
            for first in range(0, stage.epochs * 1024, growth.PIECE):
                count = min(growth.PIECE, stage.epochs * 1024 - first)
                rows = growth.picked(1600, first, count, (0, index))
                usual.partial_fit(seen[rows], np.exp(smells[rows]))
            continue
        forks = [usual.fork() for _ in range(4)]
        for k, fork in enumerate(forks):
            fork.partial_fit(views[k], np.exp(ways[k].log_odours), jump=True)
            usual.merge(fork)
    mine, its = cmap.state_dict(), usual.state_dict()
    for name in (
        "code.weight",
        "charts.centres",
        "olfaction.gram",
        "place.centres",
        "place.afferents.activity",
    ):
        torch.testing.assert_close(mine[name], its[name], rtol=2e-3, atol=2e-3)


def test_the_same_bytes_whoever_is_done_first(
    undisturbed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growing, "in_threads", lambda tasks, **_: backwards(tasks))
    grown(tmp_path / "map")
    assert weights(tmp_path / "map") == weights(undisturbed)


class Killed(BaseException):
    pass


def test_cut_off_at_every_moment_it_ends_with_the_same_bytes(
    undisturbed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growth, "EVERY", 0.0)
    monkeypatch.setattr(growth, "PIECE", 512)
    save, places = Checkpoint.save, list[Place]()

    def save_and_die(checkpoint: Checkpoint, cmap: CognitiveMap, place: Place) -> None:
        save(checkpoint, cmap, place)
        if place not in places:
            places.append(place)
            if len(places) % 3 == 1:
                raise Killed

    monkeypatch.setattr(Checkpoint, "save", save_and_die)
    cuts = 0
    while not (tmp_path / "map").exists():
        try:
            grown(tmp_path / "map")
        except Killed:
            cuts += 1
    assert cuts >= 9
    assert {place.merged for place in places if place.stage == "metric_map"} == {0, 1, 2, 3, 4, 5}
    assert weights(tmp_path / "map") == weights(undisturbed)
    assert not Checkpoint.beside(tmp_path / "map").folder.exists()


def test_what_is_merged_is_not_made_again_at_the_end(
    undisturbed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growth, "EVERY", 0.0)
    save, done = Checkpoint.save, list[tuple[str, int]]()

    def save_and_die(checkpoint: Checkpoint, cmap: CognitiveMap, place: Place) -> None:
        save(checkpoint, cmap, place)
        if place == Place("afferents", 3):
            raise Killed

    def noted(tasks: Any, **_: Any) -> Any:
        for task in tasks:
            done.append((task.work.__name__, task.number))
            yield do(task)

    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(Checkpoint, "save", save_and_die)
        grown(tmp_path / "map")
    monkeypatch.setattr(growing, "in_threads", noted)
    grown(tmp_path / "map")
    works = ("walk_share", "code_share", "recall_share", "learn_share")
    assert done == [(work, number) for work in works for number in (3, 4)]
    assert weights(tmp_path / "map") == weights(undisturbed)


def test_cut_off_when_all_is_done_it_is_put_away(
    undisturbed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save = CognitiveMap.save

    def save_and_die(cmap: CognitiveMap, path: Path) -> None:
        save(cmap, path)
        if path == tmp_path / "map":
            raise Killed

    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(CognitiveMap, "save", save_and_die)
        grown(tmp_path / "map")
    assert Checkpoint.beside(tmp_path / "map").folder.exists()
    assert grown(tmp_path / "map").charts == 60
    assert weights(tmp_path / "map") == weights(undisturbed)
    assert not Checkpoint.beside(tmp_path / "map").folder.exists()


def test_another_seed_and_other_walks_give_another_map(undisturbed: Path, tmp_path: Path) -> None:
    grown(tmp_path / "map", seed=1)
    assert weights(tmp_path / "map") != weights(undisturbed)


def test_charts_are_added_until_they_agree_and_learn_again(tmp_path: Path) -> None:
    cmap = grown(tmp_path / "map", views=400, charts=30, epoch=400, most_charts=60)
    state = cmap.state_dict()
    assert len(state["charts.centres"]) == 60
    assert float(state["place.afferents.activity"].sum()) == pytest.approx(400, rel=1e-5)


def test_sight_alone_is_learnt_without_cells(tmp_path: Path) -> None:
    room = Arena.load("furnished").model_copy(update={"sources": ()})
    cmap = growing.grow(room, tmp_path / "map", **{**SMALL, "views": 300, "charts": 30, "epoch": 300})
    assert cmap.odorants_ == 0
    assert [stage.name for stage in cmap._rooms[0].stages] == ["code", "charts", "rest"]
    assert float(cmap.state_dict()["charts.centres"].abs().sum()) > 0


def test_smell_first_is_grown_too(tmp_path: Path) -> None:
    cmap = grown(tmp_path / "map", views=300, charts=30, epoch=300, smell_first=True)
    assert float(cmap.state_dict()["place.afferents.activity"].sum()) == pytest.approx(300, rel=1e-5)


def test_a_finished_map_is_left_as_it_is(undisturbed: Path) -> None:
    before = weights(undisturbed)
    with pytest.raises(CogmapError, match="exists already and is left as it is"):
        grown(undisturbed)
    assert weights(undisturbed) == before


def test_another_map_that_grows_there_is_not_touched(tmp_path: Path) -> None:
    checkpoint = Checkpoint.beside(tmp_path / "map")
    with pytest.raises(Killed), checkpoint.opened({"seed": 7}):
        raise Killed
    plan = (checkpoint.folder / "growing.json").read_bytes()
    with pytest.raises(CogmapError, match="of a different arena and motion and camera"):
        grown(tmp_path / "map")
    assert (checkpoint.folder / "growing.json").read_bytes() == plan


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"explorers": 0}, "explorers is 0; give a whole number"),
        ({"views": True}, "views is True"),
        ({"explorers": 2000}, "803 views for 2000 explorers"),
        ({"charts": 900}, "803 views for 900 charts"),
        ({"epoch": 804}, "an epoch is 804 views and there are 803"),
        ({"seed": -1}, "seed is -1"),
        ({"threads": 0}, "threads is 0"),
        ({"scheduler": "tcp://127.0.0.1:9"}, "give one of them"),
        ({"body": Arm()}, "of kind Arm; many explorers are discs"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_done(
    changed: dict[str, Any], said: str, tmp_path: Path
) -> None:
    with pytest.raises(CogmapError, match=said):
        grown(tmp_path / "map", **changed)
    assert not list(tmp_path.iterdir())


def test_unlike_arithmetic_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def unlike(tasks: Any, **_: Any) -> Any:
        for task in tasks:
            outcome = do(task)
            yield Outcome(outcome.number, outcome.found, "another")

    monkeypatch.setattr(growing, "in_threads", unlike)
    with pytest.warns(UnlikeArithmeticWarning, match="done in 2 arithmetics"):
        grown(tmp_path / "map", views=300, charts=30, epoch=300)


def test_charts_are_a_third_of_few_views() -> None:
    assert [growing.usual_charts(views) for views in (1, 300, 1_000_000)] == [1, 100, growing.MOST_CHARTS]


def test_progress_counts_all_that_is_done(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    grown(tmp_path / "map", views=300, charts=30, epoch=300, progress=True)
    said = capfd.readouterr().err
    assert "afferents: 100%" in said
    assert "left" in said
    assert json.loads((tmp_path / "map" / "map.json").read_text("utf-8"))["settings"]["charts"] == 30
