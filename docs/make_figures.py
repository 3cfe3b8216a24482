"""Draw the figures of the documentation with the library's own plots: `python docs/make_figures.py`.

A quarter of an hour of one core. Everything is drawn from seed 0; figures go to `docs/figures`.
"""

from __future__ import annotations

import argparse
import io
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import cv2
import numpy as np
import torch
from matplotlib.figure import Figure
from PIL import Image

import arena
import cogmap
import neurons
from arena.topview import TopView
from cogmap.experiments.demo import demo
from cogmap.experiments.registry import run_experiment
from cogmap.pages.film import write_film
from cogmap.plots.style import new_panels, tidy, tidy_room

if TYPE_CHECKING:
    from jaxtyping import UInt8

    from arena import Arena, Camera, Recording
    from cogmap import CognitiveMap

OUT = Path(__file__).parent / "figures"
SIZES = {"rotation": ("ring", 3000), "cyclic": ("cylinder", 3000), "brownian": ("torus", 8000)}
"""Experiments of the paper: the figure that is taken from each, and from how many views."""
THUMBNAILS = {
    "map": "figures/place_cells.png",
    "reach": "journey.png",
    "camera": "figures/views.png",
    "body": "torus.png",
    "paper": "figures/brownian_torus.png",
    "sweep": "populations.png",
}
DEMO = ("room", "views", "place_cells", "heading_cells", "compass", "position", "metric_map", "barcodes")


def main() -> None:
    """Draw all of them, or those parts that are named."""
    parts = {"demo": of_the_demo, "layers": of_the_layers, "paper": of_the_paper, "thumbnails": of_the_readme}
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", nargs="*", default=list(parts), choices=list(parts))
    parser.add_argument("--views", type=int, default=17_000)
    told = parser.parse_args()
    OUT.mkdir(exist_ok=True)
    for part in told.part:
        parts[part](told.views)


def of_the_demo(views: int) -> None:
    """Keep what `cogmap demo` leaves behind."""
    with TemporaryDirectory() as folder:
        out = Path(folder) / "demo"
        demo(arena.Arena.load("furnished"), out, views=views)
        for name in DEMO:
            keep(out / f"{name}.png", name)


def of_the_paper(views: int) -> None:
    """Draw a ring, a cylinder and a solid torus."""
    for name, (figure, usual) in SIZES.items():
        with TemporaryDirectory() as folder:
            out = Path(folder) / name
            run_experiment(name, out, views=min(views, usual), seed=0)
            keep(out / f"{figure}.png", f"{name}_{figure}")


def of_the_layers(views: int) -> None:
    """Look into a map, layer by layer, and let it dream of a way."""
    room, eye = arena.Arena.load("furnished"), arena.Camera.panoramic()
    walk = arena.explore(room, arena.Brownian(), eye, views=views, seed=0)
    charts = 3000 if views >= 9000 else views // 3
    cmap = cogmap.CognitiveMap(charts=charts, seed=0).fit(walk.views, walk.odours)
    draw_retina(np.asarray(walk.views[:1]))
    draw_components(cmap)
    draw_spectrum(cmap)
    draw_atlas(cmap)
    draw_smell(cmap, room, walk)
    cmap.refine(walk.views)
    draw_percepts(cmap, room, eye)
    draw_film(cmap, room, eye, walk)


def of_the_readme(_: int) -> None:
    """Small pictures for six links."""
    for name, picture in THUMBNAILS.items():
        image = Image.open(OUT.parent / picture).convert("RGB")
        across, down = image.size
        # the upper left part of a tall or wide sheet, in the shape of a card
        image = image.crop((0, 0, min(across, round(1.6 * down)), min(down, round(across / 1.6))))
        image.resize((280, 175), Image.Resampling.LANCZOS).quantize(96).save(
            OUT / f"small_{name}.png", optimize=True
        )


def draw_retina(view: UInt8[np.ndarray, "1 60 360 3"]) -> None:
    """Draw a view, and what the retina makes of it."""
    strip = neurons.Retina(60, 360)(torch.from_numpy(view)).reshape(15, 3, 90).permute(0, 2, 1).numpy()
    figure, axes = new_panels(7.0, 2.6, 2, 1)
    shown = np.clip(0.5 + strip / (2 * np.abs(strip).max()), 0, 1)
    for panel, image, title in zip(
        axes,
        (view[0], shown),
        ("a view, 360×60 pixels", "what the retina makes of it, 90×15 receptors"),
        strict=True,
    ):
        panel.imshow(image, aspect="auto", extent=(-180, 180, 0, 1))
        tidy(panel, title=title)
        panel.set_yticks([])
        panel.set_xticks(range(-180, 181, 90))
    axes[1].set_xlabel("azimuth, °")
    save(figure, "retina")


def draw_components(cmap: CognitiveMap) -> None:
    """Draw the first components of the code, as strips."""
    weights = cmap.state_dict()["code.weight"][[0, 1, 4, 9, 19, 39]].numpy().reshape(-1, 15, 3, 90)
    figure, axes = new_panels(7.0, 2.4, 3, 2)
    for panel, weight, order in zip(axes.flat, weights, (1, 2, 5, 10, 20, 40), strict=True):
        image = weight.transpose(0, 2, 1)
        panel.imshow(np.clip(0.5 + image / (2 * np.abs(image).max()), 0, 1), aspect="auto")
        tidy(panel, title=f"component {order}")
        panel.set_xticks([])
        panel.set_yticks([])
    save(figure, "components")


def draw_spectrum(cmap: CognitiveMap) -> None:
    """How much of a chart's variance lies along each tangent."""
    share = np.asarray(cmap.spectrum_)
    figure, axes = new_panels(4.2, 2.4)
    axes.bar(
        np.arange(1, len(share) + 1),
        share,
        color=["#c44e52" if k < 3 else "#bbbbbb" for k in range(len(share))],
    )
    tidy(axes, x="tangent", y="share of variance", title=f"{100 * cmap.vote_:.0f} % of the charts say: three")
    save(figure, "spectrum")


def draw_atlas(cmap: CognitiveMap) -> None:
    """Draw the centres of the charts, coloured by the heading that they have agreed on."""
    state = cmap.state_dict()
    centres, phases = state["charts.centres"].numpy(), state["readout.phases"].numpy()
    laid = cogmap.LandmarkIsomap(3, seed=0).fit_transform(centres)
    smell = state["readout.intercepts"].numpy()[:, 0]
    figure = cogmap.plots.plot_embedding(laid, phases, {"log smell of the first odour": smell})
    save(figure, "atlas")


def draw_smell(cmap: CognitiveMap, room: Arena, walk: Recording) -> None:
    """Draw what is smelt, with the nose's noise, and what sight recalls of it."""
    fresh = arena.explore(
        room, arena.Brownian(), arena.Camera.panoramic(), views=min(len(walk), 5000), seed=1000
    )
    smelt, recalled = np.log(np.asarray(fresh.odours)), cmap.perceive(fresh.views).odour
    x, y = fresh.require("poses")[:, :2].T
    figure, axes = new_panels(7.0, 2.5, 1, 3, sharex=True, sharey=True)
    true = np.log(room.odours.concentration(np.column_stack([x, y])))[:, 0]
    panels = {"true": true, "smelt, 10 % noise": smelt[:, 0], "recalled from sight": recalled[:, 0]}
    for panel, (title, value) in zip(axes, panels.items(), strict=True):
        panel.scatter(x, y, c=value, s=2, vmin=true.min(), vmax=true.max(), rasterized=True)
        tidy_room(panel, title=title)
    save(figure, "smell")


def draw_percepts(cmap: CognitiveMap, room: Arena, eye: Camera) -> None:
    """Errors of place by charts alone and after places have been relaxed."""
    fresh = arena.explore(room, arena.Brownian(), eye, views=1500, seed=1000)
    known = arena.explore(room, arena.Brownian(), eye, views=1500, seed=2000)
    seen, learnt = cmap.perceive(fresh.views), cmap.perceive(known.views)
    figure, axes = new_panels(6.0, 2.4)
    for name, activity, train in (("charts alone", seen.plain, learnt.plain), ("relaxed", seen, learnt)):
        frame = cogmap.cells.fit_map_frame(train.position, known.require("poses")[:, :2])
        laid = cogmap.cells.place_map(activity.position, frame)
        off = 100 * np.sort(np.linalg.norm(laid - fresh.require("poses")[:, :2], axis=1))
        axes.semilogx(off, np.linspace(0, 1, len(off)), label=f"{name}: median {np.median(off):.2g} cm")
    axes.legend(frameon=False, fontsize=8)
    tidy(axes, x="error of place, cm", y="share of fresh views", title="")
    save(figure, "relaxed")


def draw_film(cmap: CognitiveMap, room: Arena, eye: Camera, walk: Recording) -> None:
    """Draw a way that is dreamt, and what is then seen on it, beside the room from above; as a GIF."""
    dream = cogmap.Imagination(cmap, memory=walk.views)
    ends = np.array([[-1.6, -1.1, 0.4], [1.6, 1.0, 2.2]])
    film = dream.film(*eye.render(room, ends))
    known = cmap.perceive(walk.views)
    poses_known = walk.require("poses")
    north = cogmap.cells.fit_heading_frame(known.phase, poses_known[:, 2])
    frame = cogmap.cells.fit_map_frame(known.position, poses_known[:, :2])
    heading = north.rotation + film.phase * (-1 if north.mirror else 1)
    poses = np.column_stack([cogmap.cells.place_map(film.position, frame), heading])
    kept = np.linspace(0, len(poses) - 1, min(60, len(poses))).astype(int)
    poses, dreamt = poses[kept], film.views[kept]
    seen = eye.render(room, poses)
    above = TopView(room, 300)
    frames = [
        _frame(above.draw(tuple(pose), 0.18, poses[: index + 1, :2]), eyes, mind)
        for index, (pose, eyes, mind) in enumerate(zip(poses, seen, dreamt, strict=True))
    ]
    save_gif(np.stack(frames), "dreamt_and_seen")


def _frame(
    above: UInt8[np.ndarray, "rows columns 3"],
    seen: UInt8[np.ndarray, "60 360 3"],
    dreamt: UInt8[np.ndarray, "60 360 3"],
) -> UInt8[np.ndarray, "height width 3"]:
    height, width = 300, 460
    side = np.full((height, width, 3), 255, np.uint8)
    for top, view, words in (
        (0, dreamt, "a way, dreamt from two pictures"),
        (150, seen, "what an eye sees there"),
    ):
        cv2.putText(side, words, (10, top + 24), cv2.FONT_HERSHEY_SIMPLEX, 0.55, (40, 40, 40), 1, cv2.LINE_AA)
        side[top + 36 : top + 136, 10:450] = cv2.resize(view, (440, 100), interpolation=cv2.INTER_AREA)
    return np.concatenate([above, side], axis=1)


def save(figure: Figure, name: str) -> None:
    """Keep a figure in few colours: a page loads dozens of them."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=110, facecolor="white")
    _shrink(Image.open(drawn), name)


def keep(picture: Path, name: str) -> None:
    """Keep a picture that an experiment has drawn, no wider than a page."""
    image = Image.open(picture).convert("RGB")
    if image.width > 1100:
        image = image.resize((1100, round(image.height * 1100 / image.width)), Image.Resampling.LANCZOS)
    _shrink(image, name)


def save_gif(frames: UInt8[np.ndarray, "frames height width 3"], name: str) -> None:
    """Write frames by the library's film writer, and put them into one GIF."""
    with TemporaryDirectory() as folder:
        write_film(frames, Path(folder) / "frames")
        pictures = [
            Image.open(path).convert("RGB") for path in sorted((Path(folder) / "frames").glob("*.png"))
        ]
    colours = [picture.quantize(64, dither=Image.Dither.NONE) for picture in pictures]
    colours[0].save(
        OUT / f"{name}.gif", save_all=True, append_images=colours[1:], duration=120, loop=0, optimize=True
    )


def _shrink(image: Image.Image, name: str) -> None:
    image.convert("RGB").quantize(192).save(OUT / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
