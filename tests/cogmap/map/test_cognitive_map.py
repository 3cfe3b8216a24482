import copy
import inspect
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pandas as pd
import pytest
import torch
from sklearn.base import clone

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap import Activity, CogmapError, CognitiveMap, OpenSeamWarning, UntrustedMapWarning, score
from cogmap.cells import decode_positions
from cogmap.map import topology
from cogmap.map.cognitive_map import BATCH
from cogmap.map.diagnosis import topology_verdict
from neurons.circuit import Circuit
from neurons.errors import NeuronsError
from neurons.network import Network
from neurons.rooms import Rooms
from neurons.stages import STAGES, Batch, StripStage, chosen, joined
from tests.cogmap.conftest import Refined
from tests.cogmap.shape.numbers import betti_of

SHARED = 3000
Grow = Callable[..., CognitiveMap]


def same(a: CognitiveMap, b: CognitiveMap) -> bool:
    one, other = a._rooms[0].state_dict(), b._rooms[0].state_dict()
    return one.keys() == other.keys() and all(
        torch.equal(one[name].nan_to_num(), other[name].nan_to_num()) for name in one
    )


def assert_same(a: Activity, b: Activity) -> None:
    for name in ("place", "heading", "phase", "odour", "position"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.fixture(scope="module")
def stroll(camera: Camera) -> Recording:
    """Too short for a map to be trusted, and long enough to tell one map from another."""
    return explore(Arena.load("furnished"), Brownian(), camera, views=1500, seed=0)


def learn(recording: Recording, *, seed: int = 0) -> CognitiveMap:
    return CognitiveMap(charts=150, components=20, seed=seed).fit(recording.views, recording.odours)


@pytest.fixture(scope="module")
def learnt(stroll: Recording) -> CognitiveMap:
    return learn(stroll)


def test_poses_cannot_reach_learning(stroll: Recording, learnt: CognitiveMap) -> None:
    rng = np.random.default_rng(7)
    lied_to = replace(stroll, poses=rng.permutation(stroll.poses), times=stroll.times[::-1].copy())
    assert stroll.without_truth().poses is None
    assert same(learnt, learn(stroll.without_truth()))
    assert same(learnt, learn(lied_to))
    for taught in (CognitiveMap.fit, CognitiveMap.partial_fit, CognitiveMap.perceive):
        told = set(inspect.signature(taught).parameters)
        assert told <= {"self", "views", "odours", "progress", "further", "jump"}


def test_one_thread_or_two_give_the_same_map(stroll: Recording, camera: Camera, learnt: CognitiveMap) -> None:
    threads, cast = torch.get_num_threads(), numba.get_num_threads()
    grown = []
    for count in (1, 2):
        torch.set_num_threads(count)
        numba.set_num_threads(min(count, numba.config.NUMBA_NUM_THREADS))
        seen = explore(Arena.load("furnished"), Brownian(), camera, views=len(stroll), seed=0)
        np.testing.assert_array_equal(seen.views, stroll.views)
        grown.append(learn(seen))
        assert torch.get_num_threads() == count
    torch.set_num_threads(threads)
    numba.set_num_threads(cast)
    assert same(*grown)
    assert same(grown[0], learnt)


def test_another_seed_gives_another_map(stroll: Recording, learnt: CognitiveMap) -> None:
    assert not same(learnt, learn(stroll, seed=1))


def test_fit_is_epochs_of_partial_fit(
    stroll: Recording, learnt: CognitiveMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    # what is made of a view is rounded by the company it is seen in, so both learn from the same
    whole = torch.cat([strip for _, strip in learnt._strips(stroll.views)])
    index = {view.tobytes(): row for row, view in enumerate(stroll.views)}
    made: dict[Callable[..., Any], Any] = {}

    def which(_: CognitiveMap, views: np.ndarray) -> Iterator[tuple[slice, torch.Tensor]]:
        for start in range(0, len(views), BATCH):
            rows = slice(start, start + BATCH)
            yield rows, torch.tensor([[float(index[view.tobytes()])] for view in views[rows]])

    def see(network: Network, views: torch.Tensor) -> Any:
        network.advance_stage()
        look = type(network.stage).see
        if look not in made:
            made[look] = joined([look(network, batch) for batch in whole.split(BATCH)])
        return chosen(made[look], views.flatten().long())

    monkeypatch.setattr(CognitiveMap, "_strips", which)
    monkeypatch.setattr(Network, "see", see)
    monkeypatch.setattr(Rooms, "_strange", lambda *_: (0.0, 0))  # which has nothing to look at here
    streamed = CognitiveMap(charts=learnt.charts, components=learnt.components, epoch=len(stroll), seed=0)
    order = np.random.default_rng(0)
    for stage in STAGES:
        for _ in range(stage.epochs):
            rows = np.arange(len(stroll)) if stage.in_order else order.permutation(len(stroll))
            streamed.partial_fit(stroll.views[rows], stroll.odours[rows])
    assert same(streamed, learnt)


def test_fit_asks_the_stages_for_epochs_and_order(walk: Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    smelt: list[torch.Tensor] = []

    @dataclass(frozen=True)
    class Listening(StripStage):
        name = "listening"
        in_order = True
        epochs: int = 2

        def learn(self, circuit: Circuit, batch: Batch[torch.Tensor]) -> None:  # noqa: ARG002
            smelt.append(batch.log_odours)

    stages = (*STAGES[:2], Listening(), *STAGES[2:])
    monkeypatch.setattr("cogmap.map.cognitive_map.STAGES", stages)
    grown = CognitiveMap(charts=20, components=10).fit(walk.views[:300], walk.odours[:300])
    np.testing.assert_array_equal(torch.cat(smelt), np.log(np.tile(walk.odours[:300], (2, 1))))
    assert list(grown.seconds_) == ["retina", *(stage.name for stage in stages)]


def test_place_cells_can_learn_before_anything_is_seen(walk: Recording, tmp_path: Path) -> None:
    views, odours = walk.views[:300], walk.odours[:300]
    infant = CognitiveMap(charts=20, components=10, place_cells=30, smell_first=True, epoch=300)
    infant.partial_fit(views, odours)
    learnt = infant.state_dict()
    assert int(learnt["place.initialised"]) == 30
    assert int(learnt["charts.initialised"]) == 0
    infant.save(tmp_path / "map")
    other = CognitiveMap.load(tmp_path / "map")
    for each in (infant, other):
        each.partial_fit(views, odours).partial_fit(views, odours)
    assert same(infant, other)


def test_small_map_knows_place_and_heading(walk: Recording, camera: Camera, cmap: CognitiveMap) -> None:
    fresh = explore(Arena.load("furnished"), Brownian(), camera, views=600, seed=1000)
    found = score(cmap.perceive(fresh.views), fresh.poses, train=(cmap.perceive(walk.views), walk.poses))
    assert cmap.trusted_, cmap.reason_
    assert found["heading_resultant"] > 0.98
    assert found["position_median_m"] < 0.15
    assert cmap.dimension_ == 3
    assert cmap.vote_ > 0.5
    assert cmap.spectrum_[:3].sum() > 0.8 > cmap.spectrum_[:2].sum()


def test_diagnosis_of_a_map(cmap: CognitiveMap, monkeypatch: pytest.MonkeyPatch) -> None:
    told = cmap.diagnosis({})
    assert told.heading.trusted
    assert told.place.trusted
    assert told.metric_map.reason == cmap.metric_reason_
    assert told.topology.trusted
    monkeypatch.setattr(topology, "betti", lambda _: betti_of((1, 1, 0), ("", "close", "")))
    assert cmap.diagnosis().topology == topology_verdict(topology.homology_of_charts(cmap._rooms[0].charts))
    assert "close" in cmap.diagnosis().topology.reason
    loopless = {"seen": betti_of((1, 0, 0))}
    assert cmap.diagnosis(loopless).topology.trusted
    misled = copy.deepcopy(cmap)
    misled._rooms[0].agreement[1] = torch.nan  # no loop closes
    assert "never turned all round, or these are too few views" in misled.diagnosis(loopless).topology.reason
    misled = copy.deepcopy(cmap)
    misled._rooms[0].ambiguity = torch.tensor([0.1, 0.0])
    told = misled.diagnosis({})
    assert told.heading.trusted
    assert "several places" in told.place.reason == misled.reason_
    assert not misled.trusted_


def test_saved_and_loaded_map_perceives_the_same_bits(
    walk: Recording, cmap: CognitiveMap, tmp_path: Path
) -> None:
    cmap.save(tmp_path / "map")
    loaded = CognitiveMap.load(tmp_path / "map")
    assert_same(loaded.perceive(walk.views[:300]), cmap.perceive(walk.views[:300]))
    assert_same(loaded.perceive(odours=walk.odours), cmap.perceive(odours=walk.odours))
    assert loaded.trusted_ == cmap.trusted_
    with pytest.raises(CogmapError, match="exists already"):
        cmap.save(tmp_path / "map")


def test_a_view_is_perceived_alike_in_any_company(walk: Recording, cmap: CognitiveMap) -> None:
    together = cmap.perceive(walk.views[:300])
    alone = cmap.perceive(walk.views[299:300])
    np.testing.assert_allclose(together.odour[299:], alone.odour, atol=1e-4)
    np.testing.assert_allclose(together.place[299:], alone.place, atol=1e-3)


def test_in_the_dark_there_is_place_only(walk: Recording, cmap: CognitiveMap) -> None:
    dark = cmap.perceive(odours=walk.odours)
    assert np.isnan(dark.phase).all()
    assert np.isnan(dark.heading).all()
    np.testing.assert_array_equal(dark.odour, np.log(walk.odours))
    quiet = cmap.perceive(odours=np.exp(cmap.perceive(walk.views).odour))
    agreement = [
        np.corrcoef(a.place.ravel(), cmap.perceive(walk.views).place.ravel())[0, 1] for a in (dark, quiet)
    ]
    assert 0.3 < agreement[0] < agreement[1]
    assert agreement[1] > 0.5


def test_both_senses_at_once_pick_charts_by_smell_too(walk: Recording, cmap: CognitiveMap) -> None:
    views = walk.views[: BATCH + 44]
    seen = cmap.perceive(views)
    both = cmap.perceive(views, odours=np.exp(seen.odour))
    # smell says what sight has recalled: nothing new
    turned = np.angle(np.exp(1j * (both.phase - seen.phase)))
    assert np.median(abs(turned)) < np.deg2rad(1.5)
    # the first views again, where the last ones are smelt
    away = cmap.perceive(views[:44], odours=np.exp(seen.odour[BATCH:]))
    near = np.linalg.norm(away.odour - seen.odour[BATCH:], axis=1)
    assert np.median(near) < 0.7 * np.median(np.linalg.norm(seen.odour[:44] - seen.odour[BATCH:], axis=1))


def test_order_teaches_a_metric_map_and_shuffled_views_do_no_harm(
    walk: Recording, camera: Camera, grow: Grow
) -> None:
    walk = explore(Arena.load("open_field"), Brownian(), camera, views=len(walk), seed=1)
    order = np.random.default_rng(3).permutation(len(walk))
    led, lost = grow(walk), grow(replace(walk, views=walk.views[order], odours=walk.odours[order]))
    assert led.trusted_
    assert lost.trusted_
    assert not led.metric_reason_
    assert "in order" in lost.metric_reason_
    seen, other = (grown.perceive(walk.views) for grown in (led, lost))
    assert np.isnan(other.position).all()
    found, plain = (score(told, walk.poses, train=(told, walk.poses)) for told in (seen, other))
    assert found["metric_map_r2"] > 0.98
    assert found["heading_median_deg"] < 0.8 * plain["heading_median_deg"]
    dark = led.perceive(odours=np.exp(seen.odour))
    np.testing.assert_allclose(dark.position, seen.position, atol=1e-3)


def test_views_that_do_not_follow_can_be_told(walk: Recording, cmap: CognitiveMap) -> None:
    grown = copy.deepcopy(cmap)
    for jump in (False, True):
        grown._rooms[0].views_seen.fill_(grown._rooms[0].begins("metric_map"))
        grown.partial_fit(walk.views[:20], walk.odours[:20], jump=True)
        grown.partial_fit(walk.views[20:21], walk.odours[20:21], jump=jump)
        assert grown._rooms[0].metric_map.recent.isnan().any() == jump


def test_a_coarse_map_says_so(walk: Recording) -> None:
    coarse = CognitiveMap(charts=20, components=10).fit(walk.views, walk.odours)
    assert not coarse.trusted_
    assert "chart" in coarse.reason_
    with pytest.warns(UntrustedMapWarning, match="not to be trusted"):
        coarse.perceive(walk.views[:5])


@pytest.mark.near_guard
def test_a_coarse_map_adds_charts_until_they_agree(walk: Recording, tmp_path: Path) -> None:
    grown = CognitiveMap(charts=100, components=40, most_charts=1000).fit(walk.views, walk.odours)
    assert grown.trusted_, grown.reason_
    assert len(grown._rooms[0].charts) in {200, 400, 800}
    grown.save(tmp_path / "map")
    loaded = CognitiveMap.load(tmp_path / "map")
    assert loaded.most_charts == 1000
    assert_same(loaded.perceive(walk.views[:100]), grown.perceive(walk.views[:100]))


def test_charts_that_agree_are_left_alone(walk: Recording, cmap: CognitiveMap) -> None:
    free = CognitiveMap(charts=cmap.charts, components=cmap.components, most_charts=3000)
    assert same(free.fit(walk.views, walk.odours), cmap)
    with pytest.raises(CogmapError, match="most_charts is 799; give a whole number of at least 800"):
        CognitiveMap(charts=800, most_charts=799).fit(walk.views, walk.odours)


def test_an_unfinished_map_says_so(walk: Recording) -> None:
    young = CognitiveMap(charts=300, epoch=1500).partial_fit(walk.views[:500], walk.odours[:500])
    assert not young.trusted_
    assert "'code' stage" in young.reason_
    told = young.diagnosis()
    assert {told.heading.reason, told.place.reason, told.metric_map.reason, told.topology.reason} == {
        young.reason_
    }


def test_bad_input_is_refused(walk: Recording, cmap: CognitiveMap) -> None:
    views, odours = walk.views[:400], walk.odours[:400]
    broken = odours.copy()
    broken[7, 1] = np.nan
    for give, sentence in [
        ((views.astype(np.float32), odours), "uint8"),
        ((views[0], odours), "shape"),
        ((views[:0], odours[:0]), "no views"),
        ((views, broken), "odours of view 7"),
        ((views, -odours), "above 0"),
        ((views, odours[:-1]), "400 views but 399 odours"),
        ((views[:100], odours[:100]), "100 views for 300 charts"),
    ]:
        with pytest.raises(CogmapError, match=sentence):
            CognitiveMap(charts=300).fit(*give)
    for count in ({"charts": 0}, {"components": -1}, {"place_cells": 0}, {"heading_cells": 0}, {"seed": -1}):
        with pytest.raises(CogmapError, match=next(iter(count))):
            CognitiveMap(**{"charts": 300, **count}).fit(views, odours)
    with pytest.raises(CogmapError, match="camera the map was learnt with"):
        cmap.perceive(np.zeros((2, 60, 360, 3), np.uint8))
    with pytest.raises(CogmapError, match="odorants"):
        cmap.perceive(odours=odours[:, :2])
    with pytest.raises(CogmapError, match="or both"):
        cmap.perceive()
    with pytest.raises(CogmapError, match="400 views but 399 odours"):
        cmap.perceive(views, odours=odours[:-1])
    with pytest.raises(CogmapError, match="learnt nothing"):
        CognitiveMap().perceive(views)


def test_sight_alone_is_a_map_without_populations(
    walk: Recording, cmap: CognitiveMap, tmp_path: Path
) -> None:
    alone = CognitiveMap(charts=400, components=20).fit(walk.views)
    assert alone.odorants_ == 0
    assert alone.dimension_ == 3
    np.testing.assert_allclose(
        alone.encode(walk.views[:50]).std(), cmap.encode(walk.views[:50]).std(), rtol=0.3
    )
    assert not alone.trusted_
    assert "need a second sense" in alone.reason_
    assert "need a second sense" in alone.metric_reason_
    told = alone.diagnosis()
    for verdict in (told.heading, told.place, told.metric_map):
        assert "sense" in verdict.reason
    assert "look alike are one" in told.topology.reason
    with pytest.warns(UntrustedMapWarning, match="second sense"):
        act = alone.perceive(walk.views[:7])
    assert (act.place.shape, act.heading.shape, act.phase.shape) == ((7, 150), (7, 60), (7,))
    assert (act.odour.shape, act.position.shape) == ((7, 0), (7, 2))
    for silent in (act.place, act.heading, act.phase, act.position):
        assert np.isnan(silent).all()
    alone.save(tmp_path / "map")
    again = CognitiveMap.load(tmp_path / "map")
    np.testing.assert_array_equal(again.encode(walk.views[:9]), alone.encode(walk.views[:9]))
    assert (again.reason_, again.eye_) == (alone.reason_, "panorama")
    with pytest.raises(CogmapError, match="knows no odours"):
        alone.perceive(odours=walk.odours[:7])
    with pytest.raises(CogmapError, match="knows no odours"):
        alone.perceive(walk.views[:7], odours=walk.odours[:7])
    with pytest.raises(CogmapError, match="begun by sight alone"):
        alone.partial_fit(walk.views[:7], walk.odours[:7])
    with pytest.raises(CogmapError, match="there are no odours"):
        cmap.partial_fit(walk.views[:7])


def test_a_stream_of_sight_alone_ends_with_its_charts(walk: Recording) -> None:
    cmap = CognitiveMap(charts=100, components=10, epoch=300)
    for _ in range(9):
        cmap.partial_fit(walk.views[:300])
    assert "'charts' stage" in cmap.reason_
    cmap.partial_fit(walk.views[:300]).partial_fit(walk.views[:100])
    assert "second sense" in cmap.reason_
    assert cmap.dimension_ > 0


def test_eyes_with_borders_have_maps(tmp_path: Path) -> None:
    seen = explore(Arena.load("furnished"), Brownian(), Camera.perspective(64, 48), views=1500, seed=0)
    cmap = CognitiveMap(charts=300, components=20).fit(seen.views, seen.odours)
    assert cmap.eye_ == "perspective"
    assert cmap.dimension_ in {2, 3}
    cmap.save(tmp_path / "map")
    assert CognitiveMap.load(tmp_path / "map").eye_ == "perspective"
    with pytest.warns(UntrustedMapWarning):
        act = cmap.perceive(seen.views)
    read = decode_positions(act.odour[::2], seen.poses[::2, :2], act.odour[1::2])
    assert np.median(np.linalg.norm(read - seen.poses[1::2, :2], axis=1)) < 0.35
    told = CognitiveMap(charts=300, components=20, eye="panorama")
    with pytest.raises(CogmapError, match="choose one of panorama, perspective"):
        CognitiveMap(charts=300, eye="fisheye").fit(seen.views, seen.odours)
    with pytest.warns(OpenSeamWarning), pytest.raises(NeuronsError, match="record with a larger camera"):
        told.fit(seen.views, seen.odours)


def grown(walk: Recording, *, split: int | None, folder: Path) -> CognitiveMap:
    """Learn epoch after epoch, by two explorers from `split` on in stages whose work can be shared."""
    cmap = CognitiveMap(charts=500, components=20, epoch=SHARED)
    order = np.random.default_rng(0)
    for stage in STAGES:
        for _ in range(stage.epochs):
            rows = np.arange(SHARED) if stage.in_order else order.permutation(SHARED)
            if not stage.sums:
                cmap.partial_fit(walk.views[rows], walk.odours[rows])
                continue
            here, there = np.split(rows, [SHARED // 2 if split is None else split])
            if split is None:
                cmap.partial_fit(walk.views[here], walk.odours[here], jump=True)
                cmap.partial_fit(walk.views[there], walk.odours[there], jump=True)
            else:
                cmap.fork().save(folder / stage.name)
                away = CognitiveMap.load(folder / stage.name)
                cmap.partial_fit(walk.views[here], walk.odours[here], jump=True)
                away.partial_fit(walk.views[there], walk.odours[there], jump=True)
                assert cmap.merge(away) is cmap
    return cmap


def test_two_explorers_are_as_good_as_one(camera: Camera, tmp_path: Path) -> None:
    walk = explore(Arena.load("open_field"), Brownian(), camera, views=SHARED, seed=0)
    whole, merged = (grown(walk, split=split, folder=tmp_path) for split in (None, SHARED // 2))
    assert whole.trusted_
    assert merged.trusted_
    seen = [each.perceive(walk.views) for each in (whole, merged)]
    for name, scale in {"odour": 1, "place": 20, "heading": 20, "position": 1}.items():
        one, other = (getattr(activity, name) for activity in seen)
        np.testing.assert_allclose(other, one, atol=1e-5 * scale, rtol=1e-5, err_msg=name)
    turned = np.exp(1j * (seen[1].phase - seen[0].phase))
    np.testing.assert_allclose(turned, np.ones(SHARED), atol=1e-5)


def test_a_grown_map_goes_on_with_what_others_see(walk: Recording, cmap: CognitiveMap) -> None:
    alone, away = copy.deepcopy(cmap), cmap.fork()
    alone.partial_fit(walk.views[:600], walk.odours[:600])
    away.partial_fit(walk.views[:600], walk.odours[:600])
    joined = copy.deepcopy(cmap).merge(away)
    for name in ("place", "heading"):
        one, other = (getattr(each.perceive(walk.views[:300]), name) for each in (alone, joined))
        np.testing.assert_allclose(other, one, atol=2e-4)
    with pytest.raises(CogmapError, match="learnt nothing"):
        copy.deepcopy(cmap).merge(CognitiveMap())
    with pytest.raises(CogmapError, match="learnt nothing"):
        CognitiveMap().fork()


def test_what_the_layers_refuse_the_map_refuses_in_the_same_words(
    walk: Recording, cmap: CognitiveMap
) -> None:
    young = CognitiveMap(charts=30, components=20).partial_fit(walk.views[:50], walk.odours[:50])
    with pytest.raises(CogmapError, match="'code' stage, in which units compete"):
        young.fork()
    with pytest.raises(CogmapError, match="differ in views, odorants"):
        copy.deepcopy(cmap).merge(young)


def test_lazy_views_are_read_by_the_thread_that_asks(walk: Recording, cmap: CognitiveMap) -> None:
    readers: set[int] = set()

    class Lazy:
        shape, dtype, ndim = walk.views.shape, walk.views.dtype, 4

        def __getitem__(self, rows: slice) -> np.ndarray:
            readers.add(threading.get_ident())
            return np.asarray(walk.views[rows])

    np.testing.assert_array_equal(cmap.encode(Lazy()), cmap.encode(walk.views))
    assert readers == {threading.get_ident()}


def test_a_refined_map_perceives_more_finely_and_is_saved_with_it(
    refined: Refined, camera: Camera, tmp_path: Path
) -> None:
    cmap, fresh = refined.cmap, explore(refined.room, Brownian(), camera, views=200, seed=1000)
    assert not cmap.refine_reason_
    known, seen = cmap.perceive(refined.walk.views[::5]), cmap.perceive(fresh.views)
    assert seen.position.dtype == seen.phase.dtype == seen.novelty.dtype == np.float32
    fine, plain = (
        score(told, fresh.poses, train=(before, refined.walk.poses[::5]))
        for told, before in ((seen, known), (seen.plain, known.plain))
    )
    assert fine["metric_map_median_m"] < 0.3 * plain["metric_map_median_m"]
    assert fine["heading_median_deg"] < plain["heading_median_deg"]
    cmap.save(tmp_path / "map")
    loaded = CognitiveMap.load(tmp_path / "map").perceive(fresh.views)
    assert_same(loaded, seen)
    np.testing.assert_array_equal(loaded.novelty, seen.novelty)
    assert cmap.perceive(odours=fresh.odours).plain is None


def test_what_cannot_be_refined_says_so_and_stays_as_it_was(
    stroll: Recording, learnt: CognitiveMap, refined: Refined
) -> None:
    views = stroll.views[:100]
    with pytest.warns(UntrustedMapWarning, match="places are not relaxed: "):
        untrusted = copy.deepcopy(learnt).refine(views)
    assert untrusted.refine_reason_ == (untrusted.reason_ or untrusted.metric_reason_)
    assert untrusted.relaxed_places_ is None
    few = copy.deepcopy(refined.cmap)
    with pytest.warns(UntrustedMapWarning, match="places are not relaxed: there are 60 views"):
        few.refine(refined.walk.views[:60])
    assert "more than 60" in few.refine_reason_
    seen = few.perceive(refined.walk.views[:50])
    assert seen.plain is None
    assert seen.novelty is None
    assert_same(seen, refined.cmap.perceive(refined.walk.views[:50]).plain)


@pytest.fixture(scope="module")
def numpys(stroll: Recording) -> CognitiveMap:
    """A map of the same walk, told everything by other types than `learnt`."""
    counts = np.array([150, 20])
    cmap = CognitiveMap(charts=counts[0], components=counts[1], smell=np.float32(0.5), seed=np.uint8(0))
    return cmap.fit(torch.from_numpy(stroll.views), pd.DataFrame(stroll.odours))


def test_numbers_of_numpy_views_of_torch_and_odours_of_pandas_make_the_same_map(
    numpys: CognitiveMap, learnt: CognitiveMap, tmp_path: Path
) -> None:
    assert same(numpys, learnt)
    numpys.save(tmp_path / "map")
    loaded = CognitiveMap.load(tmp_path / "map")
    assert same(loaded, learnt)
    assert {type(value) for value in loaded.get_params().values()} <= {int, float, bool, str, type(None)}


@pytest.mark.filterwarnings("ignore::cogmap.errors.UntrustedMapWarning")
def test_lists_of_views_are_perceived(stroll: Recording, learnt: CognitiveMap) -> None:
    assert_same(learnt.perceive(list(stroll.views[:5])), learnt.perceive(stroll.views[:5]))
    assert_same(
        learnt.perceive(torch.from_numpy(stroll.views[:5]), odours=stroll.odours[:5].tolist()),
        learnt.perceive(stroll.views[:5], odours=stroll.odours[:5]),
    )


@pytest.mark.parametrize(
    "setting",
    [
        {"seed": -1},
        {"seed": np.int64(-1)},
        {"smell": np.nan},
        {"smell": np.float32(-1)},
        {"epoch": np.int64(0)},
    ],
)
def test_a_bad_setting_is_refused_before_anything_is_learnt(
    stroll: Recording, setting: dict[str, Any]
) -> None:
    (name,) = setting
    cmap = CognitiveMap(charts=150, **setting)
    with pytest.raises(CogmapError, match=f"{name} is"):
        cmap.fit(stroll.views, stroll.odours)
    assert not hasattr(cmap, "_rooms")


def test_a_map_is_cloned_and_told_its_parameters(learnt: CognitiveMap) -> None:
    blank = clone(learnt)
    assert blank.get_params() == learnt.get_params()
    assert not hasattr(blank, "_rooms")
    assert blank.set_params(charts=7, seed=np.int64(2)).charts == 7
    with pytest.raises(CogmapError, match="unknown parameter 'chart'; choose one of charts"):
        blank.set_params(chart=7)
    with pytest.raises(CogmapError, match="has learnt with other parameters"):
        learnt.set_params(charts=7)
    assert learnt.charts == 150


def test_a_map_tells_what_it_is_and_whether_it_has_learnt(learnt: CognitiveMap, cmap: CognitiveMap) -> None:
    assert repr(clone(learnt)) == "CognitiveMap(charts=150, components=20)"
    told = "that has learnt from views of 15×90 pixels and 3 odorants: "
    assert repr(learnt) == f"<CognitiveMap(charts=150, components=20) {told}{learnt.reason_}>"
    assert repr(cmap).endswith(f"{told}trusted>")
