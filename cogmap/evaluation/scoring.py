"""The score of a map, where truth enters: how well its activity tells place and heading."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from sklearn.metrics import r2_score

from cogmap.cells.decoding.decoders import (
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    place_map,
    position_errors,
)
from cogmap.cells.measures.fields import place_coverage, place_fields
from cogmap.cells.measures.heading import heading_statistics
from cogmap.cells.measures.place import place_statistics
from cogmap.cells.rates.bins import bin_edges
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.inputs import check_array
from cogmap.map.activity import Activity


def score(
    activity: Activity,
    poses: Float[np.ndarray, "views 3"],
    *,
    train: tuple[Activity, Float[np.ndarray, "train 3"]],
    reachable: Float[np.ndarray, "points 2"] | None = None,
) -> dict[str, float]:
    """Every figure that activity gives, as one flat record.

    Decoder, heading frame and similarity are fitted on the training views; errors and cells are measured on
    `activity`.

    Parameters
    ----------
    activity, poses
        The views to score and where they were taken: (x, y, heading) in m and rad.
    train
        Activity and poses of the views that the map was learnt from.
    reachable
        Points in m, dense enough for every bin of 0.1 m that the body can reach to hold one or to lie between
        some that do; by default the positions of both recordings.

    Returns
    -------
    dict[str, float]
        `position_median_m`, `position_p95_m`, `heading_median_deg`, `heading_p95_deg`, `heading_resultant`,
        `place_cells_passing`, `place_coverage`, `heading_cells_passing`; cells as fractions of all columns,
        the silent ones included. Without a compass, when every phase is NaN, no heading cell passes and the
        errors of heading are left out. Where there is a metric map also `metric_map_r2`, the share of the
        variance of (x, y) that it explains after one similarity, and `metric_map_median_m`, how far it is
        off.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    activity_train, poses_train = train
    check_array("poses", poses, (len(activity.place), 3))
    check_array("training poses", poses_train, (len(activity_train.odour), 3))
    positions, headings = poses[:, :2], poses[:, 2]
    walked = np.concatenate([positions, poses_train[:, :2]])
    room = walked if reachable is None else reachable
    edges = bin_edges(np.concatenate([walked, room]))
    visited = edges.visited(walked)

    away = position_errors(activity_train.odour, poses_train[:, :2], activity.odour, positions)
    place_maps = rate_maps(activity.place, positions, edges=edges, visited=visited)
    place = place_statistics(activity.place, positions, headings, maps=place_maps)
    passing = place["passing"].to_numpy()
    return {
        "position_median_m": float(np.median(away)),
        "position_p95_m": float(np.percentile(away, 95)),
        "place_cells_passing": float(passing.mean()),
        "place_coverage": place_coverage(place_fields(place_maps), passing, edges.visited(room)),
        **_score_heading(activity, poses, (activity_train, poses_train), place_maps),
        **_score_metric_map(activity.position, positions, (activity_train.position, poses_train[:, :2])),
    }


def _score_heading(
    activity: Activity,
    poses: Float[np.ndarray, "views 3"],
    train: tuple[Activity, Float[np.ndarray, "train 3"]],
    place_maps: RateMaps,
) -> dict[str, float]:
    """Errors and cells; without a compass no cell passes, and there is no heading to be wrong."""
    if np.isnan(activity.phase).all():
        return {"heading_cells_passing": 0.0}
    positions, headings = poses[:, :2], poses[:, 2]
    frame = fit_heading_frame(train[0].phase, train[1][:, 2])
    turn = heading_errors(activity.phase, headings, frame)
    turn_deg = np.rad2deg(np.abs(turn))
    maps = rate_maps(activity.heading, positions, edges=place_maps.edges, visited=place_maps.visited)
    cells = heading_statistics(activity.heading, positions, headings, maps=maps)
    return {
        "heading_median_deg": float(np.median(turn_deg)),
        "heading_p95_deg": float(np.percentile(turn_deg, 95)),
        "heading_resultant": float(abs(np.mean(np.exp(1j * turn)))),
        "heading_cells_passing": float(cells["passing"].mean()),
    }


def _score_metric_map(
    mapped: Float[np.ndarray, "views 2"],
    positions: Float[np.ndarray, "views 2"],
    train: tuple[Float[np.ndarray, "train 2"], Float[np.ndarray, "train 2"]],
) -> dict[str, float]:
    if np.isnan(mapped).all():
        return {}
    laid = place_map(mapped, fit_map_frame(*train))
    return {
        "metric_map_r2": float(r2_score(positions, laid, multioutput="variance_weighted")),
        "metric_map_median_m": float(np.median(np.linalg.norm(laid - positions, axis=1))),
    }
