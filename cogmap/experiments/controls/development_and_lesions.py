"""Development and lesions of cells: how weights from charts grow, what is left when charts fall silent."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import torch
from jaxtyping import Float
from sklearn.linear_model import Ridge
from sklearn.metrics import pairwise_distances_argmin

from cogmap.cells.measures.correlations import correlations
from cogmap.evaluation.ground_truth import CellMetrics, GroundTruth, as_one_table
from cogmap.evaluation.populations import grow_map, perceive, trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment, pose_columns
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.lesions import afferent_weights, lesioned, weights_of, with_blank_afferents
from cogmap.plots import plot_afferents, plot_courses
from neurons.layers.heading_cells import HeadDirectionCells

POPULATIONS = ("place", "heading")


class Seen(NamedTuple):
    """What a map makes of some training views and of fresh ones."""

    train: tuple[Float[np.ndarray, "train place_cells"], Float[np.ndarray, "train heading_cells"]]
    """Rates of both populations, Hz."""
    place: CellMetrics
    """Of the fresh views, as are those of heading."""
    heading: CellMetrics

    @property
    def figures(self) -> dict[str, float]:
        """How many cells pass, and how well place and heading can be read from them."""
        truth = self.place.truth
        train, test = (np.nan_to_num(rates).astype(float) for rates in (self.train[1], self.heading.rates))
        headings = truth.train[:, 2]
        circle = np.column_stack([np.cos(headings), np.sin(headings)])
        cosine, sine = Ridge(alpha=1.0).fit(train, circle).predict(test).T
        turned = np.angle(np.exp(1j * (np.arctan2(sine, cosine) - truth.poses[:, 2])))
        return {
            "place_cells_passing": self.place.place_figures["place_cells_passing"],
            "place_coverage": self.place.place_figures["place_coverage"],
            "heading_cells_passing": self.heading.heading_figures["heading_cells_passing"],
            **truth.position(self.train[0], self.place.rates),
            "heading_median_deg": float(np.rad2deg(np.median(np.abs(turned)))),
        }


@experiment(room="furnished", views=17_000, takes=("nose", "camera", "body", "map"))
def development(
    conditions: Conditions,
    *,
    after: tuple[int, ...] = (30, 100, 300, 1000, 3000, 10_000),
    silent: tuple[float, ...] = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5),
) -> Result:
    """Look at the weights from which place cells and head-direction cells fire.

    `growth`: the afferents of a grown map are blanked, and learn from the same walk once more while smell and
    compass instruct them; both populations are measured on a fresh walk after ever more views.
    `views_to_mature` is when nine tenths of the cells pass that pass in the end. In this order both senses
    begin at once, and place cells share out what sight recalls of smell. `smell_first` is the other order, an
    infant's: place cells learn from smell alone, its `dark` course, before anything is seen; once charts and
    compass have formed, its `growth` is measured as above. `silencing`: shares of the charts, drawn at
    random, never win again. `driven` cells fire from sight through their weights, `direct` ones as their
    tuning demands for the recalled smell and phase; `agreement` is the median over cells of the correlation
    of the two.

    Positions are read from the rates of place cells by the decoder of `score`, headings from those of heading
    cells by linear regression of their cosine and sine, off by 90° like any guess where these are silent,
    as in the dark; both know some 4,000 of the training views. Cells are measured `after` so many views and
    after the last; the `silent` are shares of charts.
    """
    trial = Trial.of(conditions)
    walk, cmap = trial.walk, trial.cmap
    step = max(1, len(walk) // 4000)
    truth = trial.truth._replace(train=trial.truth.train[::step])
    views = np.asarray(walk.views[::step]), trial.fresh.views
    odours = walk.require("odours")[::step], trial.fresh.require("odours")

    def course(infant: CognitiveMap, look: Callable[[CognitiveMap], Seen]) -> pd.DataFrame:
        rows, begun = [], 0
        for met in [*(count for count in after if count < len(walk)), len(walk)]:
            infant.partial_fit(walk.views[begun:met], walk.require("odours")[begun:met])
            begun = met
            rows.append({"views": met, **look(infant).figures})
        return pd.DataFrame(rows)

    by_sight = partial(_driven, views=views, truth=truth)
    parameters = {**conditions.map, "smell_first": True}
    later = grow_map(walk, parameters, seed=conditions.seed)
    newborn = CognitiveMap(**{"seed": conditions.seed, **parameters, "charts": 1, "epoch": len(walk)})
    growth = course(with_blank_afferents(cmap), by_sight)
    dark = course(newborn, partial(_smelling, odours=odours, truth=truth))
    opened = course(with_blank_afferents(later), by_sight)
    order = np.random.default_rng(conditions.seed).permutation(cmap.charts)
    lesions = (lesioned(cmap, order[: round(share * len(order))]) for share in silent)
    silencing = [
        {"silent": share, **_driven(left, views, truth).figures}
        for share, left in zip(silent, lesions, strict=True)
    ]
    driven, direct = _driven(cmap, views, truth), _direct(cmap, views, truth)
    weights = {cells: afferent_weights(cmap, cells) for cells in POPULATIONS}
    centres = weights_of(cmap)["charts.centres"].numpy()
    preferred = trial.truth.train[pairwise_distances_argmin(centres, cmap.encode(walk.views))]
    tables = {"growth": growth, "silencing": pd.DataFrame(silencing)}
    return Result(
        metrics={
            **trust_report(cmap),
            "driven": driven.figures,
            "direct": direct.figures,
            "agreement": {
                cells: _agreement(getattr(driven, cells).rates, getattr(direct, cells).rates)
                for cells in POPULATIONS
            },
            "views_to_mature": _mature_by_population(growth),
            "smell_first": {
                **trust_report(later),
                "views_to_mature_in_the_dark": _mature(dark, "place_cells_passing"),
                "views_to_mature": _mature_by_population(opened),
                "dark": dark.to_dict("records"),
                "growth": opened.to_dict("records"),
            },
            **{name: table.to_dict("records") for name, table in tables.items()},
        },
        tables={
            **tables,
            "smell_first": pd.concat([dark.assign(sensed="smell"), opened.assign(sensed="sight")]),
            "cells": as_one_table(
                {
                    f"{name}, {cells}": getattr(seen, cells)
                    for name, seen in (("driven", driven), ("direct", direct))
                    for cells in POPULATIONS
                }
            ),
            "afferents": pd.concat(
                [_listed(cells, found, preferred) for cells, found in weights.items()], ignore_index=True
            ),
        },
        figures={
            "afferents": plot_afferents(weights["place"], weights["heading"], preferred),
            "courses": plot_courses(
                {
                    "both senses at once: cells by sight": growth,
                    "smell first: place cells in the dark": dark,
                    "sight later: the same cells by sight": opened,
                },
                tables["silencing"],
            ),
        },
        captions={
            "afferents": "Where the charts lie that a cell fires from, by the strength of their weights",
            "courses": "How the cells come with views, in two orders of the senses, and go with charts",
        },
    )


def _driven(cmap: CognitiveMap, views: tuple[Any, Any], truth: GroundTruth) -> Seen:
    """Rates from sight, through the weights."""
    train, test = (perceive(cmap, batch) for batch in views)
    return Seen((train.place, train.heading), truth.measure(test.place), truth.measure(test.heading))


def _smelling(
    cmap: CognitiveMap, odours: tuple[Float[np.ndarray, "_ odorants"], ...], truth: GroundTruth
) -> Seen:
    """Rates in the dark, by smell."""
    train, test = (cmap.perceive(odours=batch) for batch in odours)
    return Seen((train.place, train.heading), truth.measure(test.place), truth.measure(test.heading))


def _direct(cmap: CognitiveMap, views: tuple[Any, Any], truth: GroundTruth) -> Seen:
    """Rates that the tuning demands for what is recalled from sight."""
    preferred = weights_of(cmap)["heading.preferred"]
    cells = HeadDirectionCells(len(preferred), 1, generator=torch.Generator())
    cells.preferred = preferred
    train, test = (
        (cmap.perceive(odours=np.exp(seen.odour)).place, cells.tuning(torch.from_numpy(seen.phase)).numpy())
        for seen in (perceive(cmap, batch) for batch in views)
    )
    return Seen(train, *(truth.measure(rates) for rates in test))


def _agreement(one: Float[np.ndarray, "views cells"], other: Float[np.ndarray, "views cells"]) -> float:
    """Median over cells of the correlation of their rates, NaN without a cell that ever fires."""
    return float(np.nanmedian(correlations(one.T, other.T)))


def _mature_by_population(growth: pd.DataFrame) -> dict[str, int]:
    return {cells: _mature(growth, f"{cells}_cells_passing") for cells in POPULATIONS}


def _mature(growth: pd.DataFrame, passing: str) -> int:
    """Count the views after which enough cells pass, and do so from then on."""
    # Nine tenths of the cells that pass in the end.
    enough = (growth[passing] >= 0.9 * growth[passing].iloc[-1]).to_numpy()
    return int(growth["views"].iloc[len(enough) - int(np.logical_and.accumulate(enough[::-1]).sum())])


def _listed(
    cells: str, weights: Float[np.ndarray, "charts cells"], preferred: Float[np.ndarray, "charts 3"]
) -> pd.DataFrame:
    # Weights below 1 Hz are left out: nearly all of a table of every pair would be such.
    chart, cell = np.nonzero(weights >= 1.0)
    return pd.DataFrame(
        {
            "population": cells,
            "cell": cell,
            "chart": chart,
            **pose_columns(preferred[chart]),
            "weight_hz": weights[chart, cell],
        }
    )
