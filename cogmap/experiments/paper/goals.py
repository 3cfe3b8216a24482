"""Goals, as in the paper: rings of views at them are place cells, rings compared tell the heading."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import scipy.sparse as sp
from jaxtyping import Float

from arena import Arena, Brownian, Camera, Chemotaxis, Disc, Recording
from cogmap.cells import fit_heading_frame, heading_errors
from cogmap.evaluation.ground_truth import GroundTruth
from cogmap.evaluation.populations import reachable_places
from cogmap.experiments import Conditions, Result, experiment, pose_columns, show_cells
from cogmap.experiments.paper.distinguishability import retina_codes
from cogmap.graph import nearest_points, neighbour_graph
from cogmap.plots import plot_goals
from cogmap.shape import betti, circular_coordinate

PEAK = 20.0
"""Rate on the ring itself, Hz."""


@experiment(room="furnished", views=17_000, takes=("camera",))
def goals(conditions: Conditions) -> Result:
    """Fig. 8: climb an odour to its maximum, look around there, be pushed away, come back; move the goal.

    The views gathered at a maximum are a ring in the manifold. The ring is a place cell: it fires with how
    near a view is to the nearest of its own, 20 Hz exp(−d² / 2 h²), h half the distance between neighbouring
    rings. Orientation is defined by the ring nearest to the middle of the room: each of its views is an
    orientation, which views of other rings take over from their nearest neighbours on the ring next towards
    it, and orientation cells fire with the views of all rings that have the same one. `ring_betti` is the
    shape of the views of that ring.

    Place takes few views, orientation many: with 17,000, some 330 at each goal, it was 2.8° off, with 12,000
    3.1°; with 6,000, some 110, nearest neighbours on the next ring look elsewhere too often, and it was 40°.
    """
    camera = Camera.panoramic()
    # As many views a goal as if all of the grid could be reached.
    count = max(100, conditions.views // 12)
    visits = [_visit(conditions, goal, camera, count) for goal in goal_grid(conditions.room)]
    fresh = conditions.explore(Brownian(), camera, fresh=True)
    seen = np.concatenate([np.asarray(visit.views) for visit in visits])
    poses = np.concatenate([visit.require("poses") for visit in visits])
    ring = np.repeat(np.arange(len(visits)), [len(visit) for visit in visits])
    codes, test = retina_codes(seen, np.asarray(fresh.views), conditions.seed)
    place = ring_distances(test, codes, ring)
    between = ring_distances(codes, codes, ring)
    between[np.arange(len(ring)), ring] = np.inf
    width = np.median(between.min(axis=1)) / 2
    centres = np.array([poses[ring == item, :2].mean(axis=0) for item in range(len(visits))])
    order = np.argsort(np.linalg.norm(centres - centres.mean(axis=0), axis=1), kind="stable")
    orientation = spread_orientation(codes, ring, order)
    nearest = nearest_points(codes, 1, queries=test).indices[:, 0]
    turn = _aligned(orientation, poses[:, 2])
    read = _aligned(orientation[nearest], fresh.require("poses")[:, 2])
    truth = GroundTruth(poses, fresh.require("poses"), reachable_places(conditions.room, Disc()))
    cells = {
        "rings, place": truth.measure(PEAK * np.exp(-0.5 * (place / width) ** 2)),
        "rings, heading": truth.measure(orientation_rates(orientation[nearest])),
    }
    tables, figures = show_cells(cells)
    views = pd.DataFrame({**pose_columns(poses), "ring": ring, "orientation_rad": poses[:, 2] + turn})
    middle = ring_graph(codes[ring == order[0]])
    shape = betti(middle, "precomputed", max_dimension=1, landmarks=(100, 50), seed=conditions.seed)
    return Result(
        metrics={
            "goals": len(visits),
            "views_at_goals": len(seen),
            "ring_betti": list(shape.numbers),
            "ring_spread_m": float(np.median(np.linalg.norm(poses[:, :2] - centres[ring], axis=1))),
            **cells["rings, place"].place_figures,
            **cells["rings, heading"].heading_figures,
            "ring_heading_median_deg": float(np.rad2deg(np.median(abs(turn)))),
            "heading_median_deg": float(np.rad2deg(np.median(abs(read)))),
            "heading_p95_deg": float(np.rad2deg(np.percentile(abs(read), 95))),
            "heading_resultant": float(abs(np.exp(1j * read).mean())),
        },
        tables={"views": views, **tables},
        figures={"goals": plot_goals(conditions.room, views), **figures},
        captions={"goals": "The views at each goal, as strokes that point where the body looks"},
    )


def goal_grid(room: Arena, across: int = 4, along: int = 3) -> Float[np.ndarray, "goals 2"]:
    """Lay goals evenly over the bounds of the platform, without those that the body cannot reach."""
    x0, y0, x1, y1 = room.walkable.bounds
    x, y = ((np.arange(count) + 0.5) / count for count in (across, along))
    grid = np.stack(np.meshgrid(x0 + (x1 - x0) * x, y0 + (y1 - y0) * y), axis=2).reshape(-1, 2)
    free: np.ndarray = grid[room.is_free(grid, Disc().radius)]
    return free


def ring_distances(
    test: Float[np.ndarray, "views components"],
    codes: Float[np.ndarray, "seen components"],
    ring: np.ndarray,
) -> Float[np.ndarray, "views rings"]:
    """Distance of each view to the nearest view of each ring."""
    found = [nearest_points(codes[ring == item], 1, queries=test).distances[:, 0] for item in np.unique(ring)]
    return np.stack(found, axis=1)


def ring_graph(codes: Float[np.ndarray, "views components"], share: float = 0.125) -> sp.csr_array:
    """Join the views of a ring with a share of it, those nearest to each.

    The views of one stay are far apart, those of several stays alike, and fewer neighbours would leave gaps.
    """
    return neighbour_graph(codes, max(1, round(share * len(codes))))


def spread_orientation(
    codes: Float[np.ndarray, "seen components"], ring: np.ndarray, order: np.ndarray
) -> Float[np.ndarray, "seen"]:
    """Give every view an orientation, rad, from the ring that comes first in an order to the last.

    On the first it is the circular coordinate of the ring. A view of a later ring takes that of its nearest
    neighbour on the earlier ring that is nearest to its own.
    """
    orientation = np.full(len(codes), np.nan)
    first = ring == order[0]
    orientation[first] = circular_coordinate(ring_graph(codes[first])).phase
    known = first & np.isfinite(orientation)
    for item in order[1:]:
        mine = ring == item
        near = nearest_points(codes[known], 1, queries=codes[mine])
        chosen = ring[known][near.indices[:, 0]]
        usual = np.bincount(chosen).argmax()
        source = known & (ring == usual)
        found = nearest_points(codes[source], 1, queries=codes[mine]).indices[:, 0]
        orientation[mine] = orientation[source][found]
        known |= mine
    return orientation


def orientation_rates(
    orientation: Float[np.ndarray, "views"], cells: int = 36, concentration: float = 5.0
) -> Float[np.ndarray, "views cells"]:
    """Fire with how near the orientation (rad) of a view is to that of each cell; NaN is silence.

    The concentration κ of the von Mises tuning is that of the map's heading cells.
    """
    preferred = 2 * np.pi * np.arange(cells) / cells
    return PEAK * np.exp(concentration * (np.cos(orientation[:, None] - preferred) - 1))


def _visit(conditions: Conditions, goal: Float[np.ndarray, "2"], camera: Camera, count: int) -> Recording:
    """Climb the only odour of the room, from a goal, and keep the views at its maximum."""
    x, y = goal.tolist()
    scented = conditions.room.model_copy(update={"sources": [{"position": (x, y)}]})
    here = replace(conditions, room=scented)
    walk = here.explore(Chemotaxis(), camera, views=count)
    stays = walk.attributes["walk"]["at_maximum"]
    rows = np.concatenate([np.arange(first, last) for first, last in stays])
    return walk[rows]


def _aligned(
    orientation: Float[np.ndarray, "views"], headings: Float[np.ndarray, "views"]
) -> Float[np.ndarray, "views"]:
    """Signed errors in rad of orientations that are turned, and mirrored if need be, to fit the headings."""
    return heading_errors(orientation, headings, fit_heading_frame(orientation, headings))
