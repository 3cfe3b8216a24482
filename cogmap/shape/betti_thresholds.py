"""Thresholds of Betti numbers: how much a bar stands out by chance, calibrated on clouds without holes.

`python -m cogmap.shape.betti_thresholds` makes the table of thresholds anew.
"""

import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Literal

import cyclopts
import numpy as np
from jaxtyping import Float
from scipy.interpolate import RegularGridInterpolator
from tqdm import tqdm

from cogmap.atomic import atomic_write
from cogmap.shape.rips import euclidean, farthest_points, geodesic, ratios, rips_bars

Metric = Literal["geodesic", "euclidean"]

TABLE = Path(__file__).with_name("betti_thresholds.json")
LANDMARKS = {0: (25, 50, 100, 200, 400), 1: (25, 50, 100, 200, 400), 2: (25, 50, 100, 200)}
CROWDS = (1, 2, 4, 8, 16, 32)
"""Points per landmark; beyond the last the thresholds hardly fall."""
NEIGHBOURS = (15, 25)
"""Of the neighbour graphs."""
CLOUDS = 100


def threshold(
    metric: Metric, dimension: int, *, points: int, landmarks: int, neighbours: int = NEIGHBOURS[0]
) -> float:
    """Largest π = death / birth that chance alone explains, for this many landmarks of this many points.

    The largest over uniform d-cubes, d = 1..4, of the 99 % quantile of the largest π in a cube seen in
    the same way: as many points, the same neighbour graph, landmarks by farthest points in the same metric.
    Looked up in a table by log-linear interpolation. What is outside it is simulated, the same every time,
    and kept for the process: quick for fewer than 25 landmarks, minutes for more than 400 (H2: 200) or for
    fewer than 15 neighbours. Numbers of neighbours between those of the table are judged as the next lower
    one, and more than 32 points per landmark as 32 (8 when simulated), which errs on the strict side.

    Parameters
    ----------
    metric
        "geodesic" through the neighbour graph or "euclidean".
    dimension
        Of homology: 0, 1 or 2.
    points, landmarks
        Sizes of the cloud and of the sample that the bars are computed on.
    neighbours
        Of the graph; without effect on the Euclidean metric.

    Returns
    -------
    The threshold; infinite for pieces (dimension 0) in the geodesic metric, where distances say it all.

    References
    ----------
    Bobrowski & Skraba (2023), A universal null-distribution for topological data analysis: the statistic.
    """
    if metric == "geodesic" and dimension == 0:
        return float("inf")
    crowd = min(max(points / landmarks, 1.0), float(CROWDS[-1]))
    grid = LANDMARKS[dimension]
    judged = max((known for known in NEIGHBOURS if known <= neighbours), default=neighbours)
    if not grid[0] <= landmarks <= grid[-1] or (metric == "geodesic" and judged not in NEIGHBOURS):
        # Of eight points per landmark thresholds are a little strict, but take minutes instead of an hour.
        crowd = min(crowd, 8)
        return _simulated(metric, dimension, round(crowd * landmarks), landmarks, judged)
    rows = _table()[metric if metric == "euclidean" else f"{metric}_{judged}"][dimension]
    table = RegularGridInterpolator((np.log(grid), np.log(CROWDS)), rows)
    return float(table((np.log(landmarks), np.log(crowd))))


def largest_ratios(
    metric: Metric,
    cube: int,
    points: int,
    sizes: Sequence[tuple[int, int]],
    *,
    rng: np.random.Generator,
    neighbours: int = NEIGHBOURS[0],
) -> Float[np.ndarray, "sizes"]:
    """Draw points uniformly from a cube of `cube` dimensions and find its most deceptive bars.

    Returns
    -------
    The largest finite π for each (dimension of homology, landmarks) in `sizes`; 1 where there is no bar.
    """
    X = rng.uniform(size=(points, cube))
    seen = geodesic(X, neighbours) if metric == "geodesic" else euclidean(X)
    spread = seen.among(farthest_points(seen, max(count for _, count in sizes), start=0).indices)
    found = []
    for dimension, count in sizes:
        (bars,) = rips_bars(spread[:count, :count], [dimension])
        found.append(ratios(bars)[np.isfinite(bars[:, 1])].max(initial=1.0))
    return np.array(found)


def simulate_table(clouds: int = CLOUDS) -> dict[str, dict[str, list[list[float]]]]:
    """Simulate every threshold of the table: metric, dimension, then rows of landmarks by columns of crowds.

    About two hours for 100 clouds on one core.
    """
    tables: dict[str, dict[str, list[list[float]]]] = {}
    totals = sorted({count * crowd for count in LANDMARKS[1] for crowd in CROWDS})
    kinds: list[tuple[str, Metric, int]] = [(f"geodesic_{k}", "geodesic", k) for k in NEIGHBOURS]
    kinds.append(("euclidean", "euclidean", 0))
    with tqdm(total=len(kinds) * len(totals), desc="null", unit="size") as progress:
        for name, metric, neighbours in kinds:
            wanted = (1, 2) if metric == "geodesic" else (0, 1, 2)
            found: dict[tuple[int, int, int], float] = {}
            for points in totals:
                sizes = [(d, count) for d in wanted for count in LANDMARKS[d] if points / count in CROWDS]
                # No point has more neighbours than there are others.
                worst = _worst_quantiles(metric, max(points, neighbours + 1), sizes, clouds, neighbours)
                found |= {(d, count, points): value for (d, count), value in zip(sizes, worst, strict=True)}
                progress.update()
            for d in wanted:
                values = [[found[d, count, count * crowd] for crowd in CROWDS] for count in LANDMARKS[d]]
                tables.setdefault(name, {})[str(d)] = np.round(values, 4).tolist()
    return tables


def _worst_quantiles(
    metric: Metric, points: int, sizes: Sequence[tuple[int, int]], clouds: int, neighbours: int
) -> Float[np.ndarray, "sizes"]:
    worst = np.ones(len(sizes))
    # The null is the cube whose dimension deceives most.
    for cube in (1, 2, 3, 4):
        rngs = (np.random.default_rng([cube, points, cloud]) for cloud in range(clouds))
        drawn = np.stack(
            [largest_ratios(metric, cube, points, sizes, rng=rng, neighbours=neighbours) for rng in rngs]
        )
        # At the quantile 0.95 one disc in twenty would have a loop.
        worst = np.maximum(worst, np.quantile(drawn, 0.99, axis=0))
    return worst


@cache
def _simulated(metric: Metric, dimension: int, points: int, landmarks: int, neighbours: int) -> float:
    return float(_worst_quantiles(metric, points, [(dimension, landmarks)], CLOUDS, neighbours)[0])


@cache
def _table() -> dict[str, dict[int, Float[np.ndarray, "landmarks crowds"]]]:
    return {
        name: {int(dimension): np.array(rows) for dimension, rows in tables.items()}
        for name, tables in json.loads(TABLE.read_text(encoding="utf-8")).items()
    }


def main(out: Path = TABLE, clouds: int = CLOUDS) -> None:
    """Simulate the table, from so many cubes per dimension and size, and write it."""
    text = json.dumps(simulate_table(clouds), indent=1)
    with atomic_write(out) as fresh:
        fresh.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    cyclopts.run(main)
