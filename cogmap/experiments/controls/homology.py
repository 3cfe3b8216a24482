"""Homology of everything that a map knows, room by room, beside the holes that the rooms have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd

from arena import Brownian, Camera
from cogmap.evaluation.free_space import expected_betti
from cogmap.evaluation.homology_of_map import homologies
from cogmap.evaluation.populations import grow_map, perceive
from cogmap.experiments import Conditions, Result, experiment
from cogmap.plots import plot_barcode_grid, plot_barcodes
from cogmap.shape import Betti, Nerve, population_nerve

T = TypeVar("T")
Numbers = tuple[int, ...]
"""Pieces, loops and, where they are asked for, voids."""


ASKED = {"view_manifold": 3, "fused": 2, "place": 2, "heading": 2}
"""How many Betti numbers of each cloud are compared with those of free space."""
POPULATIONS = ("place", "heading")


class Case(NamedTuple):
    """A cloud, its holes, and those that it should have."""

    room: str
    cloud: str
    expected: Numbers
    found: Betti | None
    """None for headings without a compass."""
    nerve: Nerve | None
    """Of a population."""
    reason: str = ""
    """Why the map is not to be trusted."""

    @property
    def right(self) -> bool:
        """Whether the numbers that are asked for are as expected."""
        return self.found is not None and self.found.numbers[: len(self.expected)] == self.expected

    @property
    def resolved(self) -> bool:
        """Whether all the numbers that are asked for are sure."""
        return self.found is not None and all(self.found.resolved[: len(self.expected)])

    @property
    def nerve_right(self) -> bool:
        """Whether those of the nerve are."""
        return self.nerve is not None and self.nerve.numbers == self.expected

    @property
    def margin(self) -> float | None:
        """Least factor by which a bar that is asked for would have to change to be judged otherwise."""
        margins = self.found.margins[1 : len(self.expected)] if self.found else ()
        factors = [last for last, _ in margins if last] + [1 / first for _, first in margins if first]
        return min(factors, default=None)


@experiment(
    room="open_field",
    views=17_000,
    takes=("nose", "camera", "map"),
    extra_rooms=("furnished", "pillar", "two_pillars", "l_shape"),
)
def homology(conditions: Conditions) -> Result:
    """Count pieces, loops and voids of the view manifold, the fused map and both populations in every room.

    A room with h pillars on its platform leaves the body a plane with h holes, of Betti numbers [1, h], times
    the circle of its headings: [1, 1 + h, h] by Künneth's formula. The view manifold should have these
    numbers, the fused map the same pieces and loops, place cells those of the plane and head-direction cells
    those of the circle (`cogmap.evaluation.free_space`). `right` of the `cases` do, by the calibrated rule of
    `betti`; each that does not is drawn by itself. `margin` is the least factor by which a bar would have to
    change to be judged otherwise. `resolved` of them are sure (`betti`, `homologies`), and
    `wrong_and_resolved` should be none. Beside it the nerve of each population, which knows only who is
    active with whom: `nerve_right` of `nerve_cases`.
    """
    cases = [
        case
        for room in (conditions.room, *conditions.extra_rooms)
        for case in _visit(replace(conditions, room=room))
    ]
    populations = [case for case in cases if case.cloud in POPULATIONS]
    misses = {f"miss_{case.room}_{case.cloud}": case for case in cases if case.found and not case.right}
    return Result(
        metrics={
            "cases": len(cases),
            "right": sum(case.right for case in cases),
            "resolved": sum(case.resolved for case in cases),
            "wrong_and_resolved": sum(case.resolved and not case.right for case in cases),
            "nerve_cases": len(populations),
            "nerve_right": sum(case.nerve_right for case in populations),
            "rooms": _by_room(cases, _figures),
        },
        tables={"bars": pd.concat([_bars(case) for case in cases], ignore_index=True)},
        figures={
            "barcodes": plot_barcode_grid(
                _by_room(cases, lambda case: case.found),
                _by_room(cases, lambda case: case.expected),
            ),
            **{
                name: plot_barcodes({f"{case.room}, {case.cloud}": case.found})
                for name, case in misses.items()
                if case.found
            },
        },
        captions={
            "barcodes": "Bars of loops and voids of all that a map knows, room by room",
            **{
                name: f"Bars of a case that came out wrong: {case.cloud} in {case.room}"
                for name, case in misses.items()
            },
        },
    )


def _visit(conditions: Conditions) -> list[Case]:
    """Learn a map of one room and look at all that it knows."""
    walk = conditions.explore(Brownian(), Camera.panoramic())
    cmap = grow_map(walk, conditions.map, seed=conditions.seed)
    activity = perceive(cmap, walk.views)
    smells = np.log(walk.require("odours"))
    found = homologies(cmap.encode(walk.views), activity, smells, seed=conditions.seed)
    nerves = {name: population_nerve(getattr(activity, name)) for name in POPULATIONS if name in found}
    room = conditions.room
    expected = expected_betti(room, walk.require("poses")[0, :2])
    return [
        Case(room.name, name, expected[name][:asked], found.get(name), nerves.get(name), cmap.reason_)
        for name, asked in ASKED.items()
    ]


def _by_room(cases: list[Case], figure_of: Callable[[Case], T]) -> dict[str, dict[str, T]]:
    """Give what is told of every case, by room and cloud."""
    rooms: dict[str, dict[str, T]] = {}
    for case in cases:
        rooms.setdefault(case.room, {})[case.cloud] = figure_of(case)
    return rooms


def _figures(case: Case) -> dict[str, Any]:
    found = case.found
    told = {"betti": "numbers", "votes": "votes", "resolved": "resolved", "unresolved_because": "reasons"}
    return {
        "expected": list(case.expected),
        "right": case.right,
        **({} if found is None else {key: list(getattr(found, name)) for key, name in told.items()}),
        "margin": case.margin,
        **({} if case.nerve is None else {"nerve": list(case.nerve.numbers)}),
        **({"reason": case.reason} if case.reason else {}),
    }


def _bars(case: Case) -> pd.DataFrame:
    """Every bar of a case, those that stand out most first."""
    if case.found is None:
        return pd.DataFrame()
    found = case.found
    parts = [
        pd.DataFrame(
            {
                "arena": case.room,
                "cloud": case.cloud,
                "dimension": dimension,
                "birth": bars[:, 0],
                "death": bars[:, 1],
                "ratio": ratios,
                "threshold": threshold,
                "counts": np.arange(len(bars)) < number,
            }
        )
        for dimension, (bars, ratios, threshold, number) in enumerate(
            zip(found.bars, found.ratios, found.thresholds, found.numbers, strict=True)
        )
    ]
    return pd.concat(parts, ignore_index=True)
