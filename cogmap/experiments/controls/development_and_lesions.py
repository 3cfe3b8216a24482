"""Development and lesions of cells: how weights from charts grow, what is left when charts fall silent."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import torch
from jaxtyping import Float
from sklearn.linear_model import Ridge
from sklearn.metrics import pairwise_distances_argmin

from arena import Brownian, Camera
from cogmap.cells.measures.correlations import correlations
from cogmap.evaluation.populations import GroundTruth, as_one_table, grow_map, perceive, trust_report
from cogmap.experiments.conditions import Conditions, poses_of
from cogmap.experiments.result import Result
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.lesions import afferent_weights, lesioned, weights_of, with_blank_afferents
from cogmap.plots import plot_afferents, plot_courses
from neurons.layers.heading_cells import HeadDirectionCells

SEEN = (30, 100, 300, 1000, 3000, 10_000)
"""Views after which the cells are measured, and after the last one."""
SILENT = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
"""Shares of charts."""
REMEMBERED = 4000
"""Views, or a few more, that positions and headings are read by."""
MATURE = 0.9
"""Share of the cells that pass in the end, at which a population counts as mature."""
LEAST = 1.0
"""Weights below this (Hz) are left out of the table."""


class Rates(NamedTuple):
    """Of both populations, Hz."""

    place: Float[np.ndarray, "views place_cells"]
    heading: Float[np.ndarray, "views heading_cells"]


class Seen(NamedTuple):
    """What a map makes of some training views and of fresh ones."""

    train: Rates
    test: Rates


def development_and_lesions(conditions: Conditions) -> Result:
    """Look at the weights from which place cells and head-direction cells fire.

    `growth`: the afferents of a grown map are blanked, and learn from the same walk once more while smell and
    compass instruct them; both populations are measured on a fresh walk after ever more views.
    `views_to_mature` is when nine tenths of the cells pass that pass in the end. `silencing`: shares of the
    charts, drawn at random, never win again. `driven` cells fire from sight through their weights, `direct`
    ones as their tuning demands for the recalled smell and phase; `agreement` is the median over cells of the
    correlation of the two.

    Positions are read from the rates of place cells by the decoder of `score`, headings from those of heading
    cells by linear regression of their cosine and sine; both know some 4,000 of the training views.
    """
    camera = Camera.panoramic()
    walk = conditions.explore(Brownian(), camera)
    fresh = conditions.explore(Brownian(), camera, fresh=True)
    cmap = grow_map(walk, conditions.map, seed=conditions.seed)
    step = max(1, len(walk) // REMEMBERED)
    truth = GroundTruth.of(conditions.room, poses_of(walk)[::step], poses_of(fresh))
    views = np.asarray(walk.views[::step]), fresh.views

    growing, growth, begun = with_blank_afferents(cmap), [], 0
    for seen in [*(count for count in SEEN if count < len(walk)), len(walk)]:
        growing.partial_fit(walk.views[begun:seen], walk.require("odours")[begun:seen])
        begun = seen
        growth.append({"views": seen, **_figures(truth, _driven(growing, views))})
    order = np.random.default_rng(conditions.seed).permutation(cmap.charts)
    silencing = [
        {
            "silent": share,
            **_figures(truth, _driven(lesioned(cmap, order[: round(share * len(order))]), views)),
        }
        for share in SILENT
    ]
    driven, direct = _driven(cmap, views), _direct(cmap, views)
    weights = {cells: afferent_weights(cmap, cells) for cells in Rates._fields}
    centres = weights_of(cmap)["charts.centres"].numpy()
    preferred = poses_of(walk)[pairwise_distances_argmin(centres, cmap.encode(walk.views))]
    tables = {"growth": pd.DataFrame(growth), "silencing": pd.DataFrame(silencing)}
    return Result(
        metrics={
            **trust_report(cmap),
            "driven": _figures(truth, driven),
            "direct": _figures(truth, direct),
            "agreement": {
                cells: _agreement(getattr(driven.test, cells), getattr(direct.test, cells))
                for cells in Rates._fields
            },
            "views_to_mature": {
                cells: _mature(tables["growth"], f"{cells}_cells_passing") for cells in Rates._fields
            },
            **{name: table.to_dict("records") for name, table in tables.items()},
        },
        tables={
            **tables,
            "cells": as_one_table(
                {
                    f"{name}, {cells}": truth.measure(getattr(seen.test, cells))
                    for name, seen in (("driven", driven), ("direct", direct))
                    for cells in Rates._fields
                }
            ),
            "afferents": pd.concat(
                [_listed(cells, found, preferred) for cells, found in weights.items()], ignore_index=True
            ),
        },
        figures={
            "afferents": plot_afferents(weights["place"], weights["heading"], preferred),
            "courses": plot_courses(tables["growth"], tables["silencing"]),
        },
    )


def _driven(cmap: CognitiveMap, views: tuple[Any, Any]) -> Seen:
    """Rates from sight, through the weights."""
    train, test = (perceive(cmap, batch) for batch in views)
    return Seen(Rates(train.place, train.heading), Rates(test.place, test.heading))


def _direct(cmap: CognitiveMap, views: tuple[Any, Any]) -> Seen:
    """Rates that the tuning demands for what is recalled from sight."""
    preferred = weights_of(cmap)["heading.preferred"]
    cells = HeadDirectionCells(len(preferred), 1, generator=torch.Generator())
    cells.preferred = preferred
    found = []
    for activity in (perceive(cmap, batch) for batch in views):
        place = cmap.perceive(odours=np.exp(activity.odour)).place
        found.append(Rates(place, cells.tuning(torch.from_numpy(activity.phase)).numpy()))
    return Seen(*found)


def _figures(truth: GroundTruth, seen: Seen) -> dict[str, float]:
    place, heading = (truth.measure(rates) for rates in seen.test)
    train, test = (np.nan_to_num(batch.heading).astype(float) for batch in seen)
    cosine, sine = Ridge(alpha=1.0).fit(train, _on_circle(truth.train[:, 2])).predict(test).T
    turned = np.angle(np.exp(1j * (np.arctan2(sine, cosine) - truth.poses[:, 2])))
    return {
        "place_cells_passing": place.place_figures["place_cells_passing"],
        "place_coverage": place.place_coverage,
        "heading_cells_passing": heading.heading_figures["heading_cells_passing"],
        **truth.position(seen.train.place, seen.test.place),
        "heading_median_deg": float(np.rad2deg(np.median(np.abs(turned)))),
    }


def _on_circle(headings: Float[np.ndarray, "views"]) -> Float[np.ndarray, "views 2"]:
    return np.column_stack([np.cos(headings), np.sin(headings)])


def _agreement(one: Float[np.ndarray, "views cells"], other: Float[np.ndarray, "views cells"]) -> float:
    """Median over cells of the correlation of their rates, NaN without a cell that ever fires."""
    return float(np.nanmedian(correlations(one.T, other.T)))


def _mature(growth: pd.DataFrame, passing: str) -> int:
    """Count the views after which enough cells pass, and do so from then on."""
    enough = (growth[passing] >= MATURE * growth[passing].iloc[-1]).to_numpy()
    return int(growth["views"].iloc[len(enough) - int(np.logical_and.accumulate(enough[::-1]).sum())])


def _listed(
    cells: str, weights: Float[np.ndarray, "charts cells"], preferred: Float[np.ndarray, "charts 3"]
) -> pd.DataFrame:
    chart, cell = np.nonzero(weights >= LEAST)
    x, y, heading = preferred[chart].T
    return pd.DataFrame(
        {
            "population": cells,
            "cell": cell,
            "chart": chart,
            "x_m": x,
            "y_m": y,
            "heading_rad": heading,
            "weight_hz": weights[chart, cell],
        }
    )
