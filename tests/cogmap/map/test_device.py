from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap import Activity, CogmapError, CognitiveMap
from cogmap.map.device import checked_device
from cogmap.map.lesions import weights_of
from tests.elsewhere import ELSEWHERE, Elsewhere, is_elsewhere


@pytest.fixture(scope="module")
def walk() -> Recording:
    return explore(Arena.load("furnished"), Brownian(), Camera.panoramic(90, 15), views=500, seed=0)


@pytest.fixture
def elsewhere(monkeypatch: pytest.MonkeyPatch) -> Iterator[Elsewhere]:
    def one_by_one(work: Callable[[Any], Any], items: Iterator[Any]) -> Iterator[Any]:
        return map(work, items)

    # what is played is played for one thread
    monkeypatch.setattr("cogmap.map.cognitive_map.in_order", one_by_one)
    # the processor needs no such setting, and torch would warn of algorithms that it lacks
    monkeypatch.setattr(torch, "use_deterministic_algorithms", lambda **_: None)
    with Elsewhere() as played:
        yield played


@pytest.mark.parametrize("name", ["gpu", "cuda:99", "meta", "cpu:x", ""])
def test_a_device_that_is_not_there_is_refused(walk: Recording, name: str) -> None:
    with pytest.raises(CogmapError, match=f"device is '{name}'; give one that is there .*: cpu"):
        CognitiveMap(charts=100, device=name).fit(walk.views, walk.odours)


def test_the_processor_is_always_there() -> None:
    assert checked_device("cpu") == torch.device("cpu")


def assert_same(a: Activity, b: Activity) -> None:
    for name in ("place", "heading", "phase", "odour", "position"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.near_guard
@pytest.mark.filterwarnings("ignore::cogmap.UntrustedMapWarning")
@pytest.mark.parametrize(("charts", "grown"), [(100, 100), (60, 120)])
def test_all_that_is_learnt_lies_on_the_device_and_is_as_on_the_processor(
    walk: Recording, elsewhere: Elsewhere, tmp_path: Path, charts: int, grown: int
) -> None:
    options: dict[str, Any] = {"charts": charts, "most_charts": grown, "place_cells": 20, "heading_cells": 12}
    there = CognitiveMap(**options, device="cuda:0").fit(walk.views, walk.odours)
    assert elsewhere.ran > 1000
    assert all(is_elsewhere(weight) for weight in there.state_dict().values())
    here = CognitiveMap(**options).fit(walk.views, walk.odours)
    assert len(here.state_dict()["charts.centres"]) == grown
    assert there.metric_reason_ == here.metric_reason_
    there.save(tmp_path / "map")
    loaded = CognitiveMap.load(tmp_path / "map")
    assert loaded.device == "cpu"
    again = CognitiveMap.load(tmp_path / "map", device=str(ELSEWHERE))
    for other in (there, loaded, again):
        for name, weight in weights_of(here).items():
            np.testing.assert_array_equal(weights_of(other)[name].numpy(), weight.numpy())
        assert_same(other.perceive(walk.views), here.perceive(walk.views))
        assert_same(other.perceive(odours=walk.odours), here.perceive(odours=walk.odours))
        np.testing.assert_array_equal(other.encode(walk.views), here.encode(walk.views))
    assert is_elsewhere(again.state_dict()["charts.centres"])


def test_maps_learn_apart_on_two_devices(walk: Recording, elsewhere: Elsewhere) -> None:
    grown = {}
    for device in ("cpu", "cuda:0"):
        cmap = CognitiveMap(charts=60, epoch=len(walk), device=device)
        for _ in range(10):
            cmap.partial_fit(walk.views, walk.odours)
        grown[device] = cmap
    here, there = grown.values()
    away = there.fork().partial_fit(walk.views[:300], walk.odours[:300])
    twice = here.fork().partial_fit(walk.views[:300], walk.odours[:300])
    for cmap, other in ((here, away), (there, twice)):
        cmap.partial_fit(walk.views[300:500], walk.odours[300:500]).merge(other)
    assert elsewhere.ran > 1000
    for name, weight in weights_of(here).items():
        np.testing.assert_array_equal(weights_of(there)[name].numpy(), weight.numpy())


@pytest.mark.skipif(not torch.accelerator.is_available(), reason="PyTorch finds no accelerator here")
@pytest.mark.filterwarnings("ignore::cogmap.UntrustedMapWarning")
def test_another_device_gives_a_map_as_good_and_the_same_bits_twice(walk: Recording) -> None:
    name = str(torch.accelerator.current_accelerator())
    try:
        checked_device(name)
    except CogmapError as error:
        pytest.skip(str(error))
    first, second, here = (
        CognitiveMap(charts=300, device=device).fit(walk.views, walk.odours) for device in (name, name, "cpu")
    )
    assert first.state_dict()["charts.centres"].device.type == torch.device(name).type
    for key, weight in weights_of(first).items():
        np.testing.assert_array_equal(weights_of(second)[key].numpy(), weight.numpy())
    smelt = [cmap.perceive(walk.views).odour - np.log(walk.odours) for cmap in (first, here)]
    assert np.median(np.abs(smelt[0])) < 1.1 * np.median(np.abs(smelt[1]))
