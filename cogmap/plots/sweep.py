"""Trends of a sweep: a statistic against each parameter that was varied."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator
from pandas.api.types import is_bool_dtype, is_numeric_dtype
from scipy.stats import t

from cogmap.plots.style import BAD, GOOD, INK, SMALL, TINY, new_panels, plain_ticks, tidy, tidy_legend

MOST_LINES = 6
"""A second parameter with at most so many values gives each a line of its own."""
_UNITS = {
    "_m": "m",
    "_m2": "m²",
    "_deg": "°",
    "_rad": "rad",
    "_hz": "Hz",
    "arena.decay_length": "m",
    "motion.speed": "m/s",
    "camera.width": "pixels",
    "camera.height": "pixels",
    "camera.eye_height": "m",
    "camera.field_of_view": "rad",
    "nose.noise": "s.d. of log concentration",
    "nose.correlation_time": "s",
}
"""By ends of names."""


class _Axis(NamedTuple):
    """Where the values of a parameter lie."""

    name: str
    levels: list[Any]
    is_category: bool
    is_log: bool

    def at(self, value: Any) -> float:
        return float(self.levels.index(value)) if self.is_category else float(value)


def statistics_of(table: pd.DataFrame, varied: Sequence[str]) -> list[str]:
    """Name the columns of a sweep's table that are numbers and not all the same."""
    beside = {*varied, "seed", "views"}
    return [
        str(name)
        for name, column in table.items()
        if name not in beside and is_numeric_dtype(column.dtype) and len(column.dropna().unique()) > 1
    ]


def summarise(table: pd.DataFrame, statistic: str, by: Sequence[str]) -> pd.DataFrame:
    r"""Average a statistic over seeds, with the interval in which the mean lies with 95 % confidence.

    .. math:: \bar s \pm t_{.975, n - 1} \sqrt{\mathrm{var}(s) / n}

    where s are the means of each of n seeds over whatever else was varied. Rows that failed or are not
    trusted are left out.

    Returns
    -------
    pd.DataFrame
        The columns of `by`, `mean`, `half` (the interval's half length, NaN for one seed) and `seeds`.
    """
    sound = table[_is_sound(table) & table[statistic].notna()]
    each = sound.assign(_=sound[statistic].astype(float)).groupby([*by, "seed"], sort=True)["_"].mean()
    groups = each.groupby(level=list(range(len(by))))
    count = groups.count()
    factor = t.ppf((1 + 0.95) / 2, np.maximum(count - 1, 1))
    half = groups.std() / np.sqrt(count) * factor
    return pd.DataFrame({"mean": groups.mean(), "half": half, "seeds": count}).reset_index()


def plot_trend(
    table: pd.DataFrame,
    statistic: str,
    varied: Sequence[str],
    *,
    logarithmic: Collection[str] = (),
    labels: Mapping[str, str] | None = None,
    joined: bool = True,
) -> Figure:
    """Draw a statistic against each parameter in a panel of its own.

    Dots are means over seeds and bars their 95 % confidence intervals; what else was varied is averaged
    over, but for a parameter of few values, which has a line for each. Crosses are rows that are not trusted.

    Parameters
    ----------
    table
        Of a sweep.
    statistic
        Its column.
    varied
        Columns of the parameters.
    logarithmic
        Which of these lie on a log scale.
    labels
        What to call a column, instead of its name and unit.
    joined
        Whether values stand on a grid, and lines join them; else every point of a sample stands alone.
    """
    called = labels or {}
    columns = min(3, len(varied))
    rows = math.ceil(len(varied) / columns)
    figure, panels = new_panels(4.0 * columns, 3.1 * rows, rows, columns, squeeze=False, sharey=True)
    for axes in panels.flat[len(varied) :]:
        axes.set_axis_off()
    for name, axes in zip(varied, panels.flat, strict=False):
        first = axes in panels[:, 0]
        tidy(axes, x=_called(name, called), y=_called(statistic, called) if first else "")
        axis = _axis(table, name, is_log=name in logarithmic)
        other = _second(table, name, varied) if joined else None
        line = "-" if joined and not axis.is_category else "none"
        if other is None:
            _draw(axes, summarise(table, statistic, [name] if joined else varied), axis, line=line)
        else:
            every = summarise(table, statistic, [name, other])
            for mark, (value, batch) in enumerate(every.groupby(other, sort=True)):
                _draw(axes, batch, axis, line=line, label=_short(value), mark=mark)
            if len(every):
                tidy_legend(axes, title=_called(other, called), loc="beside")
        _draw_doubted(axes, table, statistic, axis)
        _scale(axes, axis)
    seeds = table["seed"].nunique()
    lost = int((~_is_sound(table)).sum())
    label = f"mean of {seeds} seeds with 95 % confidence intervals" if seeds > 1 else "one seed"
    doubt = f"; {lost} of {len(table)} rows failed or are not trusted (×) and left out" if lost else ""
    figure.suptitle(label + doubt, fontsize=SMALL, color=INK)
    return figure


def _is_sound(table: pd.DataFrame) -> pd.Series:
    return (table["error"].fillna("") == "") & table["trusted"].fillna(value=True).astype(bool)


def _axis(table: pd.DataFrame, name: str, *, is_log: bool) -> _Axis:
    column = table[name]
    is_category = not is_numeric_dtype(column.dtype) or is_bool_dtype(column.dtype)
    return _Axis(name, sorted(column.unique().tolist()), is_category, is_log and not is_category)


def _second(table: pd.DataFrame, name: str, varied: Sequence[str]) -> str | None:
    """Choose the other parameter whose values have lines of their own."""
    few = [other for other in varied if other != name and 1 < table[other].nunique() <= MOST_LINES]
    return min(few, key=lambda other: table[other].nunique(), default=None)


def _draw(axes: Axes, means: pd.DataFrame, axis: _Axis, *, line: str, label: str = "", mark: int = 0) -> None:
    markers = "osD^vP"
    colour = colormaps["tab10"](mark) if label else GOOD
    # The dots of two lines at the same category stand a little apart.
    aside = 0.07 * mark if axis.is_category else 0.0
    xs = [axis.at(value) + aside for value in means[axis.name]]
    half, marker = means["half"].fillna(0.0), markers[mark % len(markers)]
    look: dict[str, Any] = {"markersize": 4, "linewidth": 1.2, "elinewidth": 0.9, "capsize": 2}
    axes.errorbar(xs, means["mean"], half, fmt=marker, linestyle=line, color=colour, label=label, **look)


def _draw_doubted(axes: Axes, table: pd.DataFrame, statistic: str, axis: _Axis) -> None:
    doubted = table[~_is_sound(table) & table[statistic].notna()]
    xs = [axis.at(value) for value in doubted[axis.name]]
    axes.plot(xs, doubted[statistic].astype(float), "x", color=BAD, markersize=4)


def _scale(axes: Axes, axis: _Axis) -> None:
    if axis.is_log:
        axes.set_xscale("log")
    if axis.is_category:
        axes.set_xticks(range(len(axis.levels)), [_short(value) for value in axis.levels], fontsize=TINY)
        axes.set_xlim(-0.5, len(axis.levels) - 0.5)
    elif len(axis.levels) <= MOST_LINES:
        axes.set_xticks([float(value) for value in axis.levels], [_short(value) for value in axis.levels])
        axes.xaxis.set_minor_locator(NullLocator())
    elif axis.is_log:
        plain_ticks(axes.xaxis, LogLocator(subs=(1, 2, 5)))


def _called(name: str, labels: Mapping[str, str]) -> str:
    if name in labels:
        return labels[name]
    end, unit = next(((end, unit) for end, unit in _UNITS.items() if name.endswith(end)), ("", ""))
    plain = (name.removesuffix(end) if end.startswith("_") else name).replace("_", " ")
    return f"{plain} ({unit})" if unit else plain


def _short(value: object) -> str:
    text = f"{value:g}" if isinstance(value, int | float) else str(value)
    return text if len(text) <= 18 else f"{text[:17]}…"
