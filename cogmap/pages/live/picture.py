"""The picture: a moment of a session as pixels, without a browser, for films."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from cogmap.pages.live.pictures import heat
from cogmap.pages.live.scenery import scenery
from cogmap.pages.live.session import Look, Session
from cogmap.pages.live.world import World
from cogmap.plots.style import BAD, GOOD, INK, SOFT, direction_colours

WIDTH, HEIGHT, DPI = 1280, 720, 100
"""Of a picture, pixels."""
PLAN = (20, 50, 730, 690)
STRIPS = ((775, 60), (775, 178), (775, 296))
"""Upper left corners of what is seen, dreamt and surprises, pixels; each is `STRIP` wide and high."""
STRIP = (480, 80)
CELLS, RING = (775, 425, 1065, 690), (1085, 440, 1260, 690)
"""Left, top, right, bottom, pixels."""
GOAL = "#2c8c52"
_SHIFT = 4


@dataclass(frozen=True, eq=False)
class Painting:
    """Paints moments of sessions in a world: the room, what is seen, dreamt and surprises, both populations.

    The truth is red, where the map believes to be is blue, and a goal and the way to it are green.

    Parameters
    ----------
    world
        What is shown.
    """

    world: World

    def paint(self, session: Session, look: Look) -> UInt8[np.ndarray, "height width 3"]:
        """Paint a moment, 1280×720."""
        picture = self._still.copy()
        dreamt = look.thought.dreamt
        surprise = None if dreamt is None or dreamt.unusual is None else heat(dreamt.unusual)
        shown = (look.view, None if dreamt is None else dreamt.view, surprise)
        for (left, top), view in zip(STRIPS, shown, strict=True):
            if view is not None:
                picture[top : top + STRIP[1], left : left + STRIP[0]] = cv2.resize(
                    view, STRIP, interpolation=cv2.INTER_AREA
                )
        self._paint_cells(picture, look)
        self._paint_ring(picture, look)
        if len(session.route):
            _polyline(picture, self._on_plan(session.route), GOAL, 3)
        for pose, colour, filled in (
            (session.goal, GOAL, False),
            (look.pose, BAD, True),
            (look.ghost, GOOD, False),
        ):
            if pose is not None and np.isfinite(pose[:2]).all():
                self._paint_body(picture, pose, colour, filled=filled)
        return picture

    def _paint_body(
        self, picture: np.ndarray, pose: Float[np.ndarray, "3"], colour: str, *, filled: bool
    ) -> None:
        here = self._on_plan(pose[None, :2])[0]
        radius = self.world.body.radius * self._scale
        _disc(picture, here, radius, colour, -1 if filled else 3)
        if np.isfinite(pose[2]):
            nose = here + radius * np.array([np.cos(pose[2]), -np.sin(pose[2])])
            _polyline(picture, np.stack([here, nose]), "white" if filled else colour, 3)

    def _paint_cells(self, picture: np.ndarray, look: Look) -> None:
        rates = np.nan_to_num(look.thought.activity.place[0]) / self.world.full_rates[0]
        there = self._in_cells(np.array(scenery(self.world)["preferred"]["place"]))
        blue = np.array(to_rgb(GOOD))
        for place, rate in zip(there, np.clip(rates, 0, 1), strict=True):
            share = 0.07 + 0.93 * rate
            _disc(picture, place, 7.0, 1 - share * (1 - blue), -1)
        if look.pose is not None:
            _disc(picture, self._in_cells(look.pose[None, :2])[0], 4.0, BAD, 2)

    def _paint_ring(self, picture: np.ndarray, look: Look) -> None:
        left, top, right, bottom = RING
        middle, inner = np.array([(left + right) / 2, (top + bottom) / 2]), 0.3 * (right - left)
        angles = np.array(scenery(self.world)["preferred"]["heading"])
        rates = np.clip(np.nan_to_num(look.thought.activity.heading[0]) / self.world.full_rates[1], 0, 1)
        for angle, rate, hue in zip(angles, rates, direction_colours(angles), strict=True):
            ray = np.array([np.cos(angle), -np.sin(angle)])
            ends = middle + np.outer([inner, inner + 2 + 0.18 * (right - left) * rate], ray)
            _polyline(picture, ends, 1 - (0.25 + 0.75 * rate) * (1 - hue[:3]), 4)
        for pose, colour in ((look.pose, BAD), (look.ghost, GOOD)):
            if pose is not None and np.isfinite(pose[2]):
                ray = np.array([np.cos(pose[2]), -np.sin(pose[2])])
                _polyline(picture, np.stack([middle, middle + 0.85 * inner * ray]), colour, 3)

    @property
    def _scale(self) -> float:
        """Pixels per m of the plan."""
        x0, y0, x1, y1 = self.world.room.bounds
        left, top, right, bottom = PLAN
        return float(min((right - left) / (x1 - x0 + 0.2), (bottom - top) / (y1 - y0 + 0.2)))

    def _on_plan(self, points: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points 2"]:
        x0, y0, x1, y1 = self.world.room.bounds
        left, top, right, bottom = PLAN
        middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
        there = (points - middle) * [self._scale, -self._scale]
        return np.asarray(np.add(there, [(left + right) / 2, (top + bottom) / 2]))

    def _in_cells(self, points: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points 2"]:
        x0, y0, x1, y1 = self.world.room.walkable.bounds
        left, top, right, bottom = CELLS
        scale = min((right - left) / (x1 - x0), (bottom - top) / (y1 - y0))
        middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
        return np.asarray((points - middle) * [scale, -scale] + [(left + right) / 2, (top + bottom) / 2])

    @cached_property
    def _still(self) -> UInt8[np.ndarray, "height width 3"]:
        """Paint everything that does not move."""
        figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, facecolor="white")
        canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, WIDTH), ylim=(HEIGHT, 0))
        axes.set_axis_off()
        room = scenery(self.world)["room"]

        def lines(found: list[Any], colour: str, width: float, style: str = "-", order: int = 2) -> None:
            drawn = [self._on_plan(np.array(line)) for line in found]
            axes.add_collection(
                LineCollection(drawn, colors=colour, linewidths=width, linestyles=style, zorder=order)
            )

        for odour in room["odours"]:
            lines(odour["lines"], odour["colour"], 1.0)
        lines(room["platform"], SOFT, 0.9, "--")
        for solid in room["solids"]:
            outline = self._on_plan(np.array(solid["outline"]))
            axes.add_patch(
                Polygon(outline, facecolor=solid["colour"], edgecolor=INK, linewidth=0.8, zorder=3)
            )
        for wall in room["walls"]:
            lines([wall["ends"]], INK, 5.0, order=4)
            lines([wall["ends"]], wall["colour"], 3.6, order=5)
        titles = [
            (PLAN[0] + 8, 32, f"{room['name']}: where it is (red), where its map believes it is (blue)"),
            (STRIPS[0][0], STRIPS[0][1] - 8, "what it sees"),
            (STRIPS[1][0], STRIPS[1][1] - 8, "what its map expects there: a dream"),
            (STRIPS[2][0], STRIPS[2][1] - 8, "surprise: how both differ"),
            (CELLS[0], CELLS[1] - 14, "place cells"),
            (RING[0], CELLS[1] - 14, "heading cells"),
        ]
        for x, y, said in titles:
            axes.text(x, y, said, fontsize=9.5, color=INK, va="baseline", parse_math=False)
        canvas.draw()  # type: ignore[no-untyped-call]
        return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()  # type: ignore[no-untyped-call]


def _rgb(colour: str | np.ndarray) -> tuple[float, float, float]:
    red, green, blue = (255 * np.asarray(to_rgb(colour) if isinstance(colour, str) else colour)).tolist()
    return red, green, blue


def _disc(
    picture: np.ndarray, middle: Float[np.ndarray, "2"], radius: float, colour: str | np.ndarray, width: int
) -> None:
    x, y = np.rint(middle * 2**_SHIFT).astype(int).tolist()
    cv2.circle(picture, (x, y), round(radius * 2**_SHIFT), _rgb(colour), width, cv2.LINE_AA, _SHIFT)


def _polyline(
    picture: np.ndarray, points: Float[np.ndarray, "points 2"], colour: str | np.ndarray, width: int
) -> None:
    drawn = np.rint(points * 2**_SHIFT).astype(np.int32)
    cv2.polylines(
        picture,
        [drawn],
        isClosed=False,
        color=_rgb(colour),
        thickness=width,
        lineType=cv2.LINE_AA,
        shift=_SHIFT,
    )
