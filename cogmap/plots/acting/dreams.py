"""Dreams: imagined views beside those that are seen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from arena.rooms.arena import Arena
from cogmap.errors import CogmapError
from cogmap.imagination.surprise import Surprise
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.style import (
    BAD,
    GOOD,
    INK,
    SOFT,
    TINY,
    colour_bar,
    new_figure,
    new_panels,
    tidy,
    tidy_legend,
    tidy_room,
)

Views = UInt8[np.ndarray, "views height width 3"]
GAIN = 4
"""By which differences are shown larger."""
LINES = {
    "mean view": SOFT,
    "nearest by true pose": INK,
    "decoder": "#7c6bb0",
    "turned": "#d99a2b",
    "blend": "#5a9e6f",
    "warp": GOOD,
    "warp, from outside": BAD,
}


def plot_dreams(seen: Views, dreamt: Views) -> Figure:
    """Draw views, what was imagined of each, and the difference, four times as strong.

    Raises
    ------
    CogmapError
        For views that are not pairs.
    """
    _check_pairs(seen, dreamt)
    error = np.clip(GAIN * np.abs(seen.astype(int) - dreamt), 0, 255).astype(np.uint8)
    return _sheet({"seen": seen, "imagined": dreamt, f"difference × {GAIN}": error})


def plot_expectations(before: Views, expected: Views, after: Views, steps: pd.DataFrame) -> Figure:
    """Draw what is seen, what is expected next and what comes; below, how right it is, step by step.

    Parameters
    ----------
    before, expected, after
        Some of the steps.
    steps
        `ahead_psnr_db`, `persistence_psnr_db` and `turned_psnr_db` of all.
    """
    _check_pairs(expected, after)
    rows, (height, width) = len(before), before.shape[1:3]
    figure = new_figure(12.0, rows * (4.0 * height / width + 0.1) + 3.0)
    parts: Any = figure.subfigures(2, 1, height_ratios=[rows * (4.0 * height / width + 0.1) + 0.3, 2.7])
    top, bottom = parts
    panels = top.subplots(rows, 3, squeeze=False)
    for row, trio in zip(panels, zip(before, expected, after, strict=True), strict=True):
        for axes, image in zip(row, trio, strict=True):
            _show(axes, image)
    for axes, name in zip(panels[0], ("seen now", "expected next", "seen next"), strict=True):
        axes.set_title(name, fontsize=TINY, color=INK)
    axes = bottom.subplots()
    names = {
        "ahead_psnr_db": "expected",
        "turned_psnr_db": "same place, turned",
        "persistence_psnr_db": "same view",
    }
    for (key, name), colour in zip(names.items(), (GOOD, "#d99a2b", BAD), strict=True):
        axes.hist(steps[key], bins=40, color=colour, alpha=0.7, label=f"{name}: {steps[key].median():.1f} dB")
    tidy(axes, x="PSNR (dB)", y="steps")
    axes.legend(fontsize=TINY, frameon=False)
    return figure


def plot_dream_errors(arena: Arena, dreams: pd.DataFrame) -> Figure:
    """Draw how good dreams are where, and by method.

    Parameters
    ----------
    arena
        The room.
    dreams
        A row per method and target: `method`, `x_m`, `y_m`, `psnr_db`, `distance_m`.
    """
    figure, (plan, near, share) = new_panels(13.0, 4.2, 1, 3)
    warp = dreams[dreams["method"] == "warp"]
    tidy_room(plan, title="where")
    draw_surfaces(plan, arena)
    for text in plan.texts:
        text.set_visible(False)
    dots = plan.scatter(
        warp["x_m"], warp["y_m"], c=warp["psnr_db"], s=16, cmap="viridis", zorder=4, linewidths=0
    )
    colour_bar(plan, dots, "PSNR (dB)")
    frame_room(plan, arena.walkable.bounds, 0.1)
    near.plot(100 * warp["distance_m"], warp["psnr_db"], ".", color=GOOD, markersize=4)
    tidy(near, x="nearest remembered place (cm)", y="PSNR (dB)", title="how far from memory")
    for name, rows in dreams.groupby("method", sort=False):
        ranked = np.sort(rows["psnr_db"])
        colour = LINES.get(str(name), SOFT)
        share.plot(
            ranked, np.linspace(0, 1, len(ranked)), color=colour, label=f"{name}: {np.median(ranked):.1f}"
        )
    tidy(share, x="PSNR (dB)", y="share of views below", title="median by method (dB)")
    tidy_legend(share, loc="beside")
    return figure


def plot_film(arena: Arena, poses: Float[np.ndarray, "frames 3"], seen: Views, dreamt: Views) -> Figure:
    """Draw a dreamt way in the room, and six of its frames, imagined and as a camera sees them there."""
    _check_pairs(seen, dreamt)
    frames = np.unique(np.linspace(0, len(poses) - 1, min(6, len(poses))).astype(int))
    figure = new_figure(13.0, 4.6)
    parts: Any = figure.subfigures(1, 2, width_ratios=[4.2, 8.8])
    left, right = parts
    plan = left.subplots()
    tidy_room(plan, title="the dreamt way")
    draw_surfaces(plan, arena)
    for text in plan.texts:
        text.set_visible(False)
    plan.plot(*poses[:, :2].T, color=GOOD, linewidth=1.5, zorder=7)
    draw_arrows(plan, poses[frames], 0.3, color=GOOD, width=0.007, zorder=8)
    for index, frame in enumerate(frames):
        plan.annotate(
            f"{index + 1}",
            poses[frame, :2],
            (4, 4),
            textcoords="offset points",
            fontsize=TINY,
            color=INK,
            zorder=9,
        )
    frame_room(plan, arena.bounds, 0.1)
    panels = right.subplots(len(frames), 2, squeeze=False)
    for index, (row, frame) in enumerate(zip(panels, frames, strict=True)):
        for axes, image in zip(row, (dreamt[frame], seen[frame]), strict=True):
            _show(axes, image)
        row[0].set_ylabel(f"{index + 1}", fontsize=TINY, color=INK, rotation=0, ha="right", va="center")
    for axes, name in zip(panels[0], ("imagined", "seen there"), strict=True):
        axes.set_title(name, fontsize=TINY, color=INK)
    return figure


def plot_surprise(
    arena: Arena,
    views: Views,
    found: Surprise,
    where: Float[np.ndarray, "2"],
    metres: Callable[[Float[np.ndarray, "places 2"]], Float[np.ndarray, "places 2"]],
) -> Figure:
    """Draw some views, what surprises in them, and over the changed room where all of them place it.

    Parameters
    ----------
    arena
        The room as it is now.
    views, found
        What is seen, and what surprises in it.
    where
        The place, m.
    metres
        Lays places of the map in the room.
    """
    shown = np.argsort(-found.pixels.max(axis=(1, 2)), kind="stable")[:: max(1, len(views) // 8)][:5]
    figure = new_figure(13.0, 4.8)
    parts: Any = figure.subfigures(1, 2, width_ratios=[8.0, 5.0])
    left, right = parts
    panels = left.subplots(len(shown), 2, squeeze=False)
    for row, view in zip(panels, shown, strict=True):
        _show(row[0], views[view])
        row[1].imshow(
            found.pixels[view] / found.threshold, cmap="magma", vmin=0, vmax=2, interpolation="nearest"
        )
        row[1].set(xticks=[], yticks=[])
        row[1].spines[:].set_visible(False)
    panels[0, 0].set_title("seen", fontsize=TINY, color=INK)
    panels[0, 1].set_title("surprise (white: twice the threshold)", fontsize=TINY, color=INK)
    plan = right.subplots()
    tidy_room(plan, title=f"where, by {int(found.notable.sum())} of {len(views)} views")
    if found.changed:
        pooled = found.plan()
        x, y = np.meshgrid(pooled.x, pooled.y)
        laid = metres(np.column_stack([x.ravel(), y.ravel()])).reshape(*x.shape, 2)
        mesh = plan.pcolormesh(
            laid[:, :, 0], laid[:, :, 1], pooled.share, cmap="magma", shading="gouraud", zorder=0
        )
        colour_bar(plan, mesh, "surprised in its direction")
    draw_surfaces(plan, arena)
    for text in plan.texts:
        text.set_visible(False)
    plan.plot(
        *where, "o", markersize=11, markerfacecolor="none", markeredgecolor=GOOD, markeredgewidth=2, zorder=9
    )
    frame_room(plan, arena.bounds, 0.1)
    return figure


def _sheet(columns: dict[str, Views]) -> Figure:
    rows, height, width, _ = next(iter(columns.values())).shape
    figure, panels = new_panels(
        13.0, rows * (4.3 * height / width + 0.12) + 0.3, rows, len(columns), squeeze=False
    )
    for column, (name, views) in enumerate(columns.items()):
        panels[0, column].set_title(name, fontsize=TINY, color=INK)
        for axes, view in zip(panels[:, column], views, strict=True):
            _show(axes, view)
    return figure


def _show(axes: Axes, image: UInt8[np.ndarray, "height width 3"]) -> None:
    axes.imshow(image, interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set_visible(False)


def _check_pairs(first: Views, second: UInt8[np.ndarray, "others rows columns 3"]) -> None:
    if first.shape != second.shape or not len(first):
        raise CogmapError(
            f"views of shape {first.shape} and {second.shape} are no pairs; give as many of both"
        )
