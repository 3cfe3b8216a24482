"""Two real rats, whose paths the `ratinabox` package ships, in arenas that fit them."""

import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from arena import Arena, Camera, Disc, Replay, explore
from cogmap.plots import plot_walk

RATS = {"sargolini": (0.0, 0.0, 1.0, 1.0), "tanni": (-0.05, -0.05, 3.55, 2.55)}
BODY = Disc(radius=0.005)
"""A path is that of a point on the head."""


def fitting(rat: str) -> Arena:
    x0, y0, x1, y1 = RATS[rat]
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    materials = ["brick", "timber", "tiles", "granite"]
    walls = [
        {"start": a, "end": b, "material": material, "height": 0.5}
        for a, b, material in zip(corners, corners[1:] + corners[:1], materials, strict=True)
    ]
    sources = [{"position": (x0 + 0.3 * (x1 - x0), y0 + 0.6 * (y1 - y0))}]
    return Arena.create(name=rat, platform=[corners], walls=walls, sources=sources)


@pytest.fixture(params=RATS)
def rat(request: pytest.FixtureRequest) -> tuple[Arena, Path]:
    spec = find_spec("ratinabox")
    if spec is None or spec.origin is None:
        pytest.skip("ratinabox is not installed")
    return fitting(request.param), Path(spec.origin).parent / "data" / f"{request.param}.npz"


@pytest.mark.full
def test_the_rat_goes_where_it_went(rat: tuple[Arena, Path], tmp_path: Path) -> None:
    arena, path = rat
    walk = Replay(path=path).walk(arena, BODY, None, np.random.default_rng(0))
    recorded = np.load(path)
    sys.stdout.write(f"{arena.name}: {walk.notes}, {len(walk.times):,} views in {walk.times[-1]:.0f} s\n")
    assert walk.notes["samples"] == len(recorded["t"])
    assert walk.notes["clipped"] == 0
    found = np.searchsorted(walk.times + recorded["t"][0], recorded["t"] - 1e-6)
    np.testing.assert_array_equal(walk.poses[found, :2], recorded["pos"])
    assert len(walk.times) == len(recorded["t"]) + walk.notes["interpolated"]
    assert np.diff(walk.times).max() < 1.5 * np.median(np.diff(walk.times))
    # It looks where it goes.
    step = np.diff(walk.poses[:, :2], axis=0)
    fast = np.hypot(*step.T) / np.diff(walk.times) > 0.1
    off = np.angle(np.exp(1j * (np.arctan2(step[:, 1], step[:, 0]) - walk.poses[:-1, 2])))[fast]
    assert np.median(np.abs(off)) < np.deg2rad(15)
    plot_walk(arena, walk.times, walk.poses).savefig(tmp_path / "walk.png")


@pytest.mark.full
def test_the_rat_sees_and_smells_on_the_way(rat: tuple[Arena, Path]) -> None:
    arena, path = rat
    seen = explore(arena, Replay(path=path, view_every_m=0.1), Camera.panoramic(90, 15), body=BODY, views=500)
    assert seen.views.shape == (500, 15, 90, 3)
    assert seen.attributes["walk"]["clipped"] == 0
    moved = np.hypot(*np.diff(seen.poses[:, :2], axis=0).T)
    assert np.median(moved) < 0.11
