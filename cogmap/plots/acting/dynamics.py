"""Stops of a body with mass, from above and over time, and views foretold beside those seen."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from arena.acting import Journeys
from arena.bodies.heavy_disc import HeavyDisc
from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.rooms.views import draw_panorama
from cogmap.plots.style import BAD, GOOD, HUES, INK, SMALL, SOFT, new_figure, tidy, tidy_legend, tidy_room

SHOWN = 4
"""Journeys of each body that are drawn."""

_Stops = tuple[Journeys, Float[np.ndarray, "journeys 3"], int, HeavyDisc]
"""Journeys, the poses of their goals, the decisions of the run-up, and the body."""


def plot_stops(arena: Arena, stops: list[_Stops], tables: dict[str, pd.DataFrame]) -> Figure:
    """Draw ways over the room, a colour for each body, speed over time, and how many stop how near.

    Parameters
    ----------
    arena
        The room.
    stops
        Of each body the journeys, the poses of the goals (m and rad), the decisions of the run-up, itself.
    tables
        `position_error_m` and `stopped` of every journey, by who foretells.
    """
    figure = new_figure(12.0, 5.6)
    left, right = figure.subfigures(1, 2, width_ratios=[1.3, 1], squeeze=False).flat
    plan = left.subplots()
    tidy_room(plan, title="from full speed (thin: run-up) to a stop at the pose of an image (arrow)")
    draw_surfaces(plan, arena)
    for text in plan.texts:
        text.set_visible(False)
    speeds, nearness = right.subplots(2, 1)
    for number, (gone, goals, run_up, body) in enumerate(stops):
        hue = HUES(number / len(stops))
        ways = gone.poses[:, :SHOWN, :2].transpose(1, 0, 2)
        for part, width in ((ways[:, : run_up + 1], 0.5), (ways[:, run_up:], 1.8)):
            plan.add_collection(LineCollection(list(part), colors=[hue], linewidths=width, zorder=6))
        plan.plot(*ways[:, run_up].T, "o", color=hue, markersize=4, zorder=7)
        draw_arrows(plan, goals[:SHOWN], 0.2, color=hue, width=0.006, zorder=8)
        _draw_speed(speeds, gone, run_up, body, hue)
    frame_room(plan, arena.walkable.bounds, 0.15)
    tidy(speeds, x="time since the run-up ended (s)", y="speed (m/s)", title="slowing down to a stop")
    speeds.axvline(0, color=SOFT, linewidth=0.8, linestyle=":")
    tidy_legend(speeds)
    for (name, table), colour in zip(tables.items(), (GOOD, BAD, INK), strict=False):
        off = np.sort(np.where(table["stopped"], 100 * table["position_error_m"], np.inf))
        nearness.step(off, np.arange(1, len(off) + 1) / len(off), where="post", color=colour, label=name)
    nearness.axvline(3, color=SOFT, linewidth=0.8, linestyle=":")
    nearness.set(xlim=(0, 10), ylim=(0, 1.02))
    tidy(nearness, x="distance from the goal (cm)", y="share of journeys", title="stopped within")
    tidy_legend(nearness, loc="lower right")
    return figure


def _draw_speed(axes: Axes, gone: Journeys, run_up: int, body: HeavyDisc, colour: object) -> None:
    """Draw the speeds (m/s) of a body's first journey."""
    last = int(gone.steps[0])
    step = np.linalg.norm(np.diff(gone.poses[: last + 1, 0, :2], axis=0), axis=1)
    dt = gone.times[1] - gone.times[0]
    label = f"{body.mass:.1f} kg, {body.max_speed:.2f} m/s"
    axes.plot(gone.times[:last] + dt / 2 - run_up * dt, step / dt, color=colour, linewidth=1.3, label=label)


def plot_foretold(
    now: UInt8[np.ndarray, "moments height width 3"],
    foretold: UInt8[np.ndarray, "moments height width 3"],
    first_order: UInt8[np.ndarray, "moments height width 3"],
    then: UInt8[np.ndarray, "moments height width 3"],
) -> Figure:
    """Draw strips: what is seen now, what is foretold by second order and by first, and what is seen then."""
    rows = {
        "now": now,
        "foretold": foretold,
        "seen then": then,
        "foretold by first order": first_order,
    }
    height, width = now.shape[1:3]
    columns = min(2, len(now))
    sets = -(-len(now) // columns)
    figure = new_figure(12.0, sets * (4 * (12.0 / columns - 0.6) * height / width + 1.3))
    blocks = figure.subfigures(sets, columns, squeeze=False)
    for moment, block in zip(range(len(now)), blocks.flat, strict=False):
        for axes, (name, views) in zip(block.subplots(len(rows), 1), rows.items(), strict=True):
            tidy(axes, title=name, size=SMALL - 1)
            draw_panorama(axes, views[moment])
            axes.tick_params(labelbottom=name == "foretold by first order")
    return figure
