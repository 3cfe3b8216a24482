"""Betti numbers of a cloud: how many pieces, loops and voids it has, and by how much."""

from collections import Counter
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from joblib import Parallel, cpu_count, delayed
from scipy.sparse.csgraph import connected_components

from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import checked_graph
from cogmap.graph.points import AnyCloud, checked_cloud
from cogmap.inputs import Whole, as_array, check_choice
from cogmap.shape import betti_thresholds, rips
from cogmap.shape.resolution import Over, doubt

Metric = Literal["geodesic", "euclidean", "precomputed"]

ROUNDING = 1e-3
"""Share of the largest distance by which others may be off: the root of float32's rounding, three times."""
FEWEST = 10
"""Fewer points than this have no shape to speak of."""


@dataclass(frozen=True, eq=False)
class Betti:
    """Betti numbers with what they rest on; each tuple has one entry per dimension of homology.

    A bar counts when its π (`ratios`: death / birth) exceeds the threshold.
    """

    numbers: tuple[int, ...]
    """Pieces, loops, voids: the majority over the draws."""
    bars: tuple[rips.Bars, ...]
    """(birth, death) in the unit of the metric, those that stand out most first; from the first draw that
    agrees with the majority."""
    thresholds: tuple[float, ...]
    """What π must exceed; infinite for the pieces of a neighbour graph, where only infinite bars count."""
    votes: tuple[int, ...]
    """How many draws agree with the majority."""
    draws: int
    landmarks: tuple[int, ...]
    """How many landmarks the bars were computed on."""
    points: int
    """How many distinct points the landmarks were taken from."""
    metric: Metric
    reasons: tuple[str, ...]
    """Why a number is not resolved, in words; empty where it is."""

    @property
    def resolved(self) -> tuple[bool, ...]:
        """Whether each number is sure as far as the cloud can tell (`resolution.doubt`)."""
        return tuple(not reason for reason in self.reasons)

    @property
    def ratios(self) -> tuple[Float[np.ndarray, "_"], ...]:
        """π of every bar, in falling order."""
        return tuple(rips.ratios(bars) for bars in self.bars)

    @property
    def margins(self) -> tuple[tuple[float | None, float | None], ...]:
        """π over threshold of the last bar that counts and of the first that does not.

        None without such a bar and where the threshold is infinite.
        """
        return tuple(
            (_over(found[:count], threshold, -1), _over(found[count:], threshold, 0))
            for found, count, threshold in zip(self.ratios, self.numbers, self.thresholds, strict=True)
        )

    def __str__(self) -> str:
        lines = [f"Betti numbers {list(self.numbers)} ({self.metric}, {self.points} points)"]
        for dimension, (number, found) in enumerate(zip(self.numbers, self.ratios, strict=True)):
            largest = ", ".join(f"{value:.2f}" for value in found[: number + 4]) or "none"
            lines.append(
                f"H{dimension}: {number} bars with π = death/birth over {self.thresholds[dimension]:.2f} "
                f"({self.votes[dimension]} of {self.draws} draws, {self.landmarks[dimension]} landmarks); "
                f"largest π: {largest}"
                + (f"; unresolved: {reason}" if (reason := self.reasons[dimension]) else "")
            )
        return "\n".join(lines)


class _Found(NamedTuple):
    """What one draw says about one dimension."""

    bars: rips.Bars
    threshold: float
    landmarks: int

    @property
    def over(self) -> Over:
        """π over the threshold; of an infinite one only infinite bars count."""
        found = rips.ratios(self.bars)
        endless = np.full_like(found, np.inf)
        return np.asarray(np.divide(found, self.threshold, out=endless, where=np.isfinite(found)))

    @property
    def number(self) -> int:
        return int(np.count_nonzero(self.over > 1))


def betti(
    X: AnyCloud,
    metric: Metric = "geodesic",
    *,
    max_dimension: int = 2,
    seed: Whole = 0,
    neighbours: int = 15,
    check: int | None = 25,
    one_sided: int | None = None,
    landmarks: tuple[int, int] = (400, 150),
    draws: int = 3,
) -> Betti:
    """Count the pieces, loops and voids of a cloud of points.

    Landmarks are spread over the cloud by farthest points in the metric itself; the Rips filtration on them
    gives bars; a bar counts when π = death / birth exceeds what clouds without holes reach by chance when
    seen in the same way (`betti_thresholds.threshold`). This is repeated from `draws` random first landmarks,
    and each Betti number is the majority's, the smallest of a tie.

    A number is `resolved` when in the median draw the bars that count stand well over the threshold and the
    next well under it, and a graph of `check` neighbours counts as many (`resolution.doubt`). None of this
    can expose a real short cut: where two places look alike the cloud itself has another shape. A second
    sense can (`cogmap.evaluation.homology_of_map`).

    In the geodesic metric the pieces are those of the neighbour graph. In the others a piece is what a gap
    wider than the threshold sets apart, if it holds at least 1 % of the points; else it is left out. Those of
    a neighbour graph are resolved if this tells as many.

    Parameters
    ----------
    X
        The points; or with "precomputed" their distances (points, points), symmetric but for rounding and
        infinite between pieces, or as a sparse array their neighbour graph. Repeated points count once, and
        in the first two metrics their order changes nothing.
    metric
        "geodesic": shortest paths in the neighbour graph; "euclidean"; "precomputed": distances are judged
        as Euclidean ones, a graph by its shortest paths as "geodesic".
    max_dimension
        Highest dimension of homology, 0 to 2.
    seed
        Chooses the first landmark of every draw.
    neighbours
        Of every point in the neighbour graph; 15, because fewer make false loops.
    check
        Neighbours of every point in a second graph, which is looked at once and must tell the same; None
        looks at no other. Without effect where no neighbours are sought, or there are not so many points.
    one_sided
        How many of its neighbours a point is joined to even when they do not count it among theirs; all when
        None. Points at corners of a cloud look farther for their last neighbours than others do, and where
        it bends towards another part of itself, as that of all postures does of an arm whose joints have
        limits, or has few points, they find false ones in every graph. For clouds as even as those of an
        `EvenMemory`: in others it makes weak loops of noise.
    landmarks
        How many for pieces and loops, and how many of these for voids.
    draws
        How often to repeat.

    Raises
    ------
    CogmapError
        For NaN, wrong shapes, asymmetric or negative distances, an unknown metric, too few points.
    """
    _check_options(metric, max_dimension, landmarks, draws)
    counts = (neighbours,) if check is None else (neighbours, check)
    space, *others = _metric_spaces(X, metric, counts, one_sided)
    judged: betti_thresholds.Metric = "geodesic" if metric == "geodesic" or sp.issparse(X) else "euclidean"
    wanted = [landmarks[dimension == 2] for dimension in range(max_dimension + 1)]
    starts = np.random.default_rng(seed).integers(len(space), size=draws)
    looks = [(space, neighbours, int(start)) for start in starts]
    looks += [(other, check, int(starts[0])) for other in others if check is not None]
    # Draws and dimensions know nothing of each other; of paths all cores take care for each draw.
    on_all_cores = Parallel(cpu_count(), backend="threading")
    spreads = on_all_cores(
        delayed(rips.farthest_points)(seen, max(wanted), start) for seen, _, start in looks
    )
    apart = [seen.among(spread.indices) for (seen, *_), spread in zip(looks, spreads, strict=True)]
    tasks = []
    for (_, around, _), spread, distances in zip(looks, spreads, apart, strict=True):
        for dimension, count in enumerate(wanted):
            # Here, because a threshold that must be simulated is kept for the draws that follow.
            limit = betti_thresholds.threshold(
                judged,
                dimension,
                points=len(space),
                landmarks=min(count, len(distances)),
                neighbours=around,
            )
            held = spread.held if judged == "euclidean" and dimension == 0 else None
            tasks.append(delayed(_find)(distances[:count, :count], dimension, limit, held))
    checks = [f"with {around} neighbours" for _, around, _ in looks[draws:]]
    if judged == "geodesic":
        # A few strays join pieces of a neighbour graph. The last of the tasks is one of dimension 0.
        checks.append("without outliers")
        known = min(len(apart[0]), betti_thresholds.LANDMARKS[0][-1])
        limit = betti_thresholds.threshold("euclidean", 0, points=len(space), landmarks=known)
        tasks.append(delayed(_find)(apart[0], 0, limit, spreads[0].held))
    found = on_all_cores(tasks)
    by_dimension = [tuple(found[dimension :: len(wanted)]) for dimension in range(len(wanted))]
    chosen, votes = zip(*(_majority(items[:draws]) for items in by_dimension), strict=True)
    reasons = tuple(
        doubt(
            dimension,
            item.number,
            [draw.over for draw in items[:draws]],
            [(check, other.over) for other, check in zip(items[draws:], checks, strict=False)],
        )
        for dimension, (item, items) in enumerate(zip(chosen, by_dimension, strict=True))
    )
    return Betti(
        numbers=tuple(found.number for found in chosen),
        bars=tuple(found.bars for found in chosen),
        thresholds=tuple(found.threshold for found in chosen),
        votes=votes,
        draws=draws,
        landmarks=tuple(found.landmarks for found in chosen),
        points=len(space),
        metric=metric,
        reasons=reasons,
    )


def _find(
    distances: Float[np.ndarray, "landmarks landmarks"],
    dimension: int,
    limit: float,
    held: Int[np.ndarray, "landmarks"] | None,
) -> _Found:
    """Compute the bars; given how many points each landmark holds, leave out those that are outliers."""
    landmarks = len(distances)
    if held is not None:
        distances = _without_outliers(distances, held / held.sum(), limit)
    (bars,) = rips.rips_bars(distances, [dimension])
    return _Found(bars, limit, landmarks)


def _without_outliers(
    distances: Float[np.ndarray, "landmarks landmarks"], share: Float[np.ndarray, "landmarks"], limit: float
) -> Float[np.ndarray, "kept kept"]:
    while True:
        (bars,) = rips.rips_bars(distances, [0])
        closed = bars[rips.ratios(bars) <= limit, 1].max(initial=0.0)
        _, piece = connected_components(distances <= closed, directed=False)
        # Less than 1 % of the points are not a piece of a Euclidean cloud but a handful of outliers.
        kept = np.bincount(piece, weights=share)[piece] >= 0.01
        if kept.all():
            return distances
        # Without its outliers the typical gap is smaller, which can reveal more of them.
        distances, share = distances[np.ix_(kept, kept)], share[kept]


def _majority(found: tuple[_Found, ...]) -> tuple[_Found, int]:
    tally = Counter(item.number for item in found)
    number, votes = min(tally.items(), key=lambda entry: (-entry[1], entry[0]))
    return next(item for item in found if item.number == number), votes


def _over(found: Float[np.ndarray, "bars"], threshold: float, which: int) -> float | None:
    return float(found[which] / threshold) if len(found) and np.isfinite(threshold) else None


def _metric_spaces(
    X: AnyCloud,
    metric: Metric,
    counts: tuple[int, ...],
    one_sided: int | None,
) -> list[rips.Space]:
    """Give the cloud its metric, and with numbers of neighbours to choose from, one by each."""
    if sp.issparse(X):
        if metric != "precomputed":
            raise CogmapError(
                f"X is sparse with the metric {metric!r}; "
                "give its `neighbour_graph` and the metric 'precomputed'"
            )
        graph = checked_graph(X)
        _check_enough(graph.shape[0])
        return [rips.along(graph, counts[0])]
    if metric == "precomputed":
        return [rips.Given(_checked_distances(X))]
    X = np.unique(np.asarray(checked_cloud(X)), axis=0)
    _check_enough(len(X))
    # What has enough points for the first number and too few for the second is looked at once.
    counts = (counts[0], *(count for count in counts[1:] if count < len(X)))
    return [*rips.geodesics(X, counts, one_sided)] if metric == "geodesic" else [rips.euclidean(X)]


def _checked_distances(given: object) -> Float[np.ndarray, "points points"]:
    X = as_array("precomputed distances", given)
    if X.ndim != 2 or X.shape[0] != X.shape[1]:
        raise CogmapError(f"precomputed distances have shape {X.shape}; expected a square, (points, points)")
    _check_enough(len(X))
    X = X.astype(np.float64)
    slack = ROUNDING * np.max(np.abs(X), where=np.isfinite(X), initial=0)
    if not (-slack <= X).all():
        raise CogmapError(
            f"precomputed distances hold NaN or negative values, the least is {np.min(X):g}; "
            "distances are at least 0: of similarities give 1 - X, or the like"
        )
    own = np.abs(np.diagonal(X)).max()
    if own > slack:
        raise CogmapError(
            f"precomputed distances have no zero diagonal, it goes up to {own:g}; "
            "of similarities give 1 - X, or the like"
        )
    # infinite on both sides or on none
    skew = np.abs(np.subtract(X, X.T, out=np.zeros_like(X), where=X != X.T)).max()
    if skew > slack:
        raise CogmapError(
            f"precomputed distances are not symmetric, there and back differ by up to {skew:g}; "
            "average X and X.T, or of an upper triangle give X + X.T"
        )
    mean: np.ndarray = np.maximum((X + X.T) / 2, 0)
    np.fill_diagonal(mean, 0)
    return mean


def _check_enough(points: int) -> None:
    if points < FEWEST:
        raise CogmapError(f"{points} distinct points are too few for a shape; give at least {FEWEST}")


def _check_options(metric: str, max_dimension: int, landmarks: tuple[int, int], draws: int) -> None:
    check_choice("metric", metric, get_args(Metric))
    if not 0 <= max_dimension <= 2:
        raise CogmapError(f"max_dimension is {max_dimension}; expected 0, 1 or 2")
    if min(landmarks) < FEWEST or draws < 1:
        raise CogmapError(
            f"landmarks {landmarks} and {draws} draws; expected at least {FEWEST} landmarks and one draw"
        )
