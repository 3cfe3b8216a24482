"""Sessions side by side: the cells of animals and of maps, by the same tables and sheets."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.figure import Figure

from cogmap.cells import MeasuredSession, Tuning, decode_session
from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types, plot_decoding, plot_examples, plot_rate_maps, plot_tuning_curves

CELLS = "cells"
"""What the result is called in its metrics, as an experiment is by its name."""
SIGNIFICANT = 0.01
"""p of a cell that is tuned to more than chance."""
_MEDIANS = (
    "mean_rate_hz", "peak_rate_hz", "field_area_m2", "spatial_information", "sparsity", "coherence",
    "stability", "in_field_direction_vector", "mean_vector_length", "drift_deg",
)  # fmt: skip


def compare_sessions(measured: Mapping[str, MeasuredSession], *, window: float = 0.5) -> Result:
    """Measure, decode and draw the cells of sessions, population by population, beside each other.

    Parameters
    ----------
    measured
        Sessions by name.
    window
        s over which spikes are added up to be decoded.

    Returns
    -------
    Result
        Metrics by session: how it was read, errors of decoding, and, by population, how many cells pass as
        place cells and as head-direction cells, how many are tuned with p < .01 by shuffling, and medians.
        The table `cells` has a row a cell; `by_population` has the metrics of populations in columns.

    Raises
    ------
    CogmapError
        Without a session.
    """
    if not measured:
        raise CogmapError("there are no sessions to compare; give one at least")
    metrics, tables = dict[str, Any](), list[pd.DataFrame]()
    parts, figures = dict[str, _Population](), dict[str, Figure]()
    captions = dict[str, str]()
    for name, found in measured.items():
        decoded = decode_session(found.session, window=window, bin=found.bin, smoothing=found.smoothing)
        mine = _populations(name if len(measured) > 1 else "", found)
        metrics[name] = {
            "views": len(found.session),
            "view_seconds": found.session.seconds,
            **found.session.notes,
            "decoding": {} if decoded is None else decoded.figures,
            "populations": {part.kind: part.figures for part in mine.values()},
        }
        tables.append(found.table.assign(session=name))
        parts |= mine
        if decoded is not None:
            drawn = f"decoding_{_word(name)}" if len(measured) > 1 else "decoding"
            figures[drawn] = plot_decoding(decoded)
            captions[drawn] = f"Position and heading decoded from all cells of {name}, beside the true ones"
    for label, part in parts.items():
        for kind, figure in part.sheets().items():
            figures[f"{kind}_{_word(label)}"] = figure
            captions[f"{kind}_{_word(label)}"] = f"{_TOLD[kind]}: {label}"
    table = pd.concat(tables, ignore_index=True)
    table = table[["session", *(column for column in table if column != "session")]]
    labels = table["population"] if len(measured) == 1 else table["session"] + ", " + table["population"]
    figures["cells"] = plot_cell_types(table.assign(population=labels))
    shown = {name: Tuning(part.maps, part.curves) for name, part in parts.items() if part.curves is not None}
    if shown:
        figures["examples"] = plot_examples(shown)
    beside = pd.DataFrame({label: part.figures for label, part in parts.items()})
    return Result(
        {"experiment": CELLS, "sessions": metrics},
        {"cells": table, "by_population": beside.rename_axis("figure").reset_index()},
        figures,
        captions,
    ).described({})


_TOLD = {
    "rate_maps": "Rate maps, rate against position",
    "tuning_curves": "Tuning curves, rate against heading",
}


class _Population(NamedTuple):
    """The cells of one population in a session."""

    kind: str
    maps: RateMaps
    curves: Float[np.ndarray, "cells bins"] | None
    place: pd.DataFrame
    heading: pd.DataFrame | None
    table: pd.DataFrame

    @property
    def figures(self) -> dict[str, float]:
        """How many pass and are tuned, as fractions of all, and medians; what nobody knows is left out."""
        chances = {"place": "spatial_information_p", "heading": "mean_vector_length_p"}
        judged = chances if self.heading is not None else {"place": chances["place"]}
        medians = self.table[list(_MEDIANS)].median().dropna()
        return {
            "cells": float(len(self.table)),
            **{f"{name}_cells_passing": float(self.table[f"{name}_passing"].mean()) for name in judged},
            **{
                f"{name}_cells_tuned": float((self.table[p] < SIGNIFICANT).mean())
                for name, p in judged.items()
            },
            **{f"median_{name}": float(value) for name, value in medians.items()},
        }

    def sheets(self) -> dict[str, Figure]:
        """Draw rate maps, and tuning curves where there are headings."""
        drawn = {"rate_maps": plot_rate_maps(self.maps, self.place, what="cells")}
        if self.curves is not None and self.heading is not None:
            drawn["tuning_curves"] = plot_tuning_curves(self.curves, self.heading, what="cells")
        return drawn


def _populations(session: str, found: MeasuredSession) -> dict[str, _Population]:
    """Part the cells of a session into its populations, by names that tell them from those of others."""
    parts = {}
    for kind in dict.fromkeys(found.session.populations):
        mine = np.array([each == kind for each in found.session.populations])
        parts[f"{session}, {kind}" if session else kind] = _Population(
            kind,
            replace(found.maps, rates=found.maps.rates[mine]),
            None if found.curves is None else found.curves[mine],
            found.place[mine].reset_index(drop=True),
            None if found.heading is None else found.heading[mine].reset_index(drop=True),
            found.table[mine],
        )
    return parts


def _word(label: str) -> str:
    """Make a name of a file of any label."""
    return re.sub(r"\W+", "_", label).strip("_") or "cells"
