"""How far a map stands from the bounds that decide whether it is trusted.

It stands clear of a bound when its figure is farther from it than half of the bound's own distance from 1,
or a quarter where that is far; a vote of many charts, when a few could not turn it. It is soundly trusted
when it stands clear above all, and soundly refused when it stands clear below one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

BOUNDS = {"signs": 0.995, "phases": 0.999, "metric": 0.8, "vote": 0.4}
CLEAR = {"signs": 0.5, "phases": 0.5, "metric": 0.25, "vote": 0.05}


def figures(network: Any) -> dict[str, float]:
    """What the guards judge by."""
    signs, phases = network.agreement.tolist()
    metric, vote = float(network.metric_map.cross_validated_r2.min()), float(network.votes.max())
    return {"signs": signs, "phases": phases, "metric": metric, "vote": vote}


def margin(name: str, figure: float) -> float:
    """How far a figure stands from its bound, in units of the bound's own distance from 1."""
    return (figure - BOUNDS[name]) / (1 - BOUNDS[name])


def too_near(network: Any, names: Iterable[str]) -> bool:
    """Whether rounding might carry the verdict of these guards over a bound; NaN is soundly refused."""
    asked = {n: figure for n, figure in figures(network).items() if n in names}
    # charts are judged by themselves where no walk is there to confirm them, or they have not voted
    for absent in ("metric", "vote"):
        if len(asked) > 1 and math.isnan(asked.get(absent, 0.0)):
            del asked[absent]
    margins = [margin(n, figure) / CLEAR[n] for n, figure in asked.items()]
    trusted = all(one >= 1 for one in margins)
    refused = any(not one > -1 for one in margins)
    return not (trusted or refused)


def described(network: Any, names: Iterable[str]) -> str:
    """One line of a map, its figures, and their margins in brackets."""
    told = [f"{n} {x:.5f} ({margin(n, x):+.2f})" for n, x in figures(network).items() if n in names]
    return f"{network.epoch} views, {len(network.charts)} charts: {', '.join(told)}"
