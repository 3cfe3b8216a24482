"""Freezing: a page as one file that asks for nothing, with what is seen and thought at sampled poses."""

from __future__ import annotations

import html
import json
from importlib import resources
from pathlib import Path

import numpy as np
from jaxtyping import Float

from cogmap.atomic import atomic_write, user_path
from cogmap.errors import CogmapError
from cogmap.pages.live.frames import frame
from cogmap.pages.live.scenery import Json, scenery
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

LARGEST = 20_000_000
"""Bytes of a file that can be mailed."""
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
"""What a browser lets the file ask for: nothing."""
HEADINGS = 8
"""Directions looked into from every place."""


def freeze(world: World, out: str | Path, *, poses: int = 240, seed: int = 0) -> Path:
    """Write a page that needs no server: a click leads to the nearest of the poses that it holds.

    Parameters
    ----------
    world
        What is shown.
    out
        A file that ends in .html; an earlier one is replaced.
    poses
        How many it holds at most, eight directions from each of so many places; some 45 KB each.
    seed
        Of the noise of eye and nose.

    Raises
    ------
    CogmapError
        For another kind of file, too few poses, and a page of more than 20 MB.
    """
    out = user_path(out)
    if out.suffix != ".html":
        raise CogmapError(f"a page is not written as {out.suffix or 'a folder'}; let it end in .html")
    if poses < HEADINGS:
        raise CogmapError(f"{poses} poses are too few; give at least {HEADINGS}, one place all round")
    session = Session(world, seed=seed)
    text = _page(world, [_frozen(session, pose) for pose in sampled_poses(world, poses // HEADINGS)])
    if len(text.encode()) > LARGEST:
        raise CogmapError(
            f"the page would have {len(text.encode()) / 1e6:.0f} MB, more than 20; "
            f"give fewer than {poses} poses"
        )
    with atomic_write(out) as path:
        path.write_text(text, encoding="utf-8")
    return out


def sampled_poses(world: World, places: int) -> Float[np.ndarray, "poses 3"]:
    """Choose places far from each other among those remembered, and look all round from each."""
    known = world.poses[:, :2]
    known = known[world.body.is_free(world.room, world.poses)]
    chosen = [int(np.linalg.norm(known - known.mean(axis=0), axis=1).argmin())]
    away = np.linalg.norm(known - known[chosen[0]], axis=1)
    while len(chosen) < min(places, len(known)):
        chosen.append(int(away.argmax()))
        away = np.minimum(away, np.linalg.norm(known - known[chosen[-1]], axis=1))
    headings = np.arange(HEADINGS) * (2 * np.pi / HEADINGS) - np.pi + np.pi / HEADINGS
    return np.array([(*known[place], heading) for place in chosen for heading in headings])


def _frozen(session: Session, pose: Float[np.ndarray, "3"]) -> Json:
    session.stand(*pose.tolist())
    return frame(session, session.look())


def _page(world: World, frames: list[Json]) -> str:
    # views that several poses have in common, such as remembered ones, are held once
    held: dict[str, int] = {}
    for each in frames:
        for near in each["near"]:
            held.setdefault(near["view"], len(held))
    packed = [
        {**each, "near": [{**near, "view": held[near["view"]]} for near in each["near"]]} for each in frames
    ]
    told = json.dumps({"scene": scenery(world), "frames": packed, "held": list(held)})
    # what closes a script ends it wherever it stands
    told = told.replace("</", "<\\/")
    folder = resources.files("cogmap.pages.live")
    style, script = ((folder / name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
    title = html.escape(f"cogmap: {world.room.name}")
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>
body {{ margin: 14px; background: #f4f5f6; }}
{style}
</style>
</head>
<body>
<main id="page"></main>
<script type="module">
{script}
thaw(document.getElementById("page"), {told});
</script>
</body>
</html>
"""
