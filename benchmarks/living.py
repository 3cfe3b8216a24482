"""How soon the live page answers a click, and how often it shows a driven explorer, on one core."""

import time

import numpy as np

from arena import Brownian, Camera, Disc, explore
from benchmarks.timing import ROOM, Figures, one_core
from cogmap import CognitiveMap
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.player import Player
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

VIEWS = 17_000
CLICKS, FRAMES = 60, 200
STEP = 0.04
"""Seconds of the explorer's time from frame to frame."""


def living() -> Figures:
    """Answer clicks all over the platform, then drive on: all that panels show, before a browser draws it.

    Physics, the view, what the map perceives of it, the view that it imagines there, surprise, and all of
    them as the JSON and the JPEG that a browser takes. Frames are steps of 40 ms.
    """
    camera = Camera.panoramic()
    walk = explore(ROOM, Brownian(), camera, views=VIEWS, seed=0)
    cmap = CognitiveMap(seed=0).fit(walk.views, walk.odours).refine(walk.views)
    world = World(ROOM, camera, Disc(), Mind(cmap, memory=walk.views), walk)
    world.prepare()
    player, rng = Player(Session(world)), np.random.default_rng(0)
    with one_core():
        player.turn(0.0)
        waits = []
        for x, y in ROOM.sample_free(CLICKS, 0.2, rng).tolist():
            started = time.perf_counter()
            player.hear({"stand": [x, y], "heading": float(rng.uniform(-np.pi, np.pi))})
            player.turn(STEP)
            waits.append(1000 * (time.perf_counter() - started))
        player.hear({"stand": [0.0, 0.0], "heading": 0.0})
        player.hear({"drive": [0.6, 0.5]})
        started, shown = time.perf_counter(), 0
        for _ in range(FRAMES):
            shown += player.turn(STEP) is not None
        hertz = shown / (time.perf_counter() - started)
    median, late = np.percentile(waits, [50, 95]).tolist()
    return {"click_median_ms": median, "click_p95_ms": late, "driven_hz": hertz}
