"""`make verify`: how soon a page answers a click, and how often it shows a driven explorer, on one core."""

import time
from collections.abc import Callable

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, Disc, explore
from benchmarks.timing import one_core
from cogmap import CognitiveMap
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.player import Player
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

pytestmark = pytest.mark.full

CLICKS, FRAMES = 60, 200
BARS = [("click_median_ms", "≤", 100), ("click_p95_ms", "≤", 100), ("driven_hz", "≥", 20)]


def test_a_page_answers_in_time(judge: Callable[..., None]) -> None:
    room, camera = Arena.load("furnished"), Camera.panoramic(360, 60)
    walk = explore(room, Brownian(), camera, views=17_000, seed=0)
    cmap = CognitiveMap(seed=0).fit(walk.views, walk.odours).refine(walk.views)
    world = World(room, camera, Disc(), Mind(cmap, memory=walk.views), walk)
    world.prepare()
    player, rng = Player(Session(world)), np.random.default_rng(0)
    with one_core():
        player.turn(0.0)
        waits = []
        for x, y in room.sample_free(CLICKS, 0.2, rng).tolist():
            started = time.perf_counter()
            player.hear({"stand": [x, y], "heading": float(rng.uniform(-np.pi, np.pi))})
            assert player.turn(0.02) is not None
            waits.append(1000 * (time.perf_counter() - started))
        player.hear({"stand": [0.0, 0.0], "heading": 0.0})
        player.hear({"drive": [0.6, 0.5]})
        started = time.perf_counter()
        shown = [player.turn(0.04) for _ in range(FRAMES)]
        hertz = FRAMES / (time.perf_counter() - started)
    assert None not in shown
    median, late = np.percentile(waits, [50, 95]).tolist()
    judge("page", {"click_median_ms": median, "click_p95_ms": late, "driven_hz": hertz}, BARS)
