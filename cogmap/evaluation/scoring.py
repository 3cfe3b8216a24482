"""The score of a map, where truth enters: how well its activity tells place and heading."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from sklearn.metrics import r2_score

from cogmap.cells.decoding.decoders import fit_heading_frame, fit_map_frame, heading_errors, place_map
from cogmap.evaluation.ground_truth import CellMetrics, GroundTruth
from cogmap.inputs import AnyArray, checked_array
from cogmap.map.activity import Activity


def score(
    activity: Activity,
    poses: AnyArray,
    *,
    train: tuple[Activity, AnyArray],
    reachable: AnyArray | None = None,
    cells: tuple[CellMetrics, CellMetrics] | None = None,
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
    cells
        Place cells and head-direction cells of this activity, where they have been measured already.

    Returns
    -------
    dict[str, float]
        `position_median_m`, `position_p95_m`, `heading_median_deg`, `heading_p95_deg`, `heading_resultant`,
        `place_cells_passing`, `place_coverage`, `heading_cells_passing`; cells as fractions of all columns,
        the silent ones included. Without a compass, when every phase is NaN, no heading cell passes and the
        errors of heading are left out. Where there is a metric map also `metric_map_r2`, the share of the
        variance of (x, y) that it explains after one similarity, and `metric_map_median_m`, how far it is
        off. Of a map that was refined, those of heading and metric map also as the charts alone tell them,
        with the prefix `plain_`.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    activity_train = train[0]
    poses = checked_array("poses", poses, (len(activity.place), 3))
    poses_train = checked_array("training poses", train[1], (len(activity_train.odour), 3))
    positions = poses[:, :2]
    room = np.concatenate([positions, poses_train[:, :2]])
    if reachable is not None:
        room = checked_array("reachable", reachable, (None, 2))
    truth = GroundTruth(poses_train, poses, room)
    place, heading = cells or (CellMetrics(activity.place, truth), CellMetrics(activity.heading, truth))
    figures = {
        **truth.position(activity_train.odour, activity.odour),
        "place_cells_passing": float(place.place["passing"].mean()),
        "place_coverage": place.coverage(room),
    }
    # Without a compass no cell passes, and there is no heading to be wrong.
    lost = np.isnan(activity.phase).all()
    figures["heading_cells_passing"] = 0.0 if lost else float(heading.heading["passing"].mean())
    figures |= _pose_figures(activity, poses, (activity_train, poses_train))
    if activity.plain is not None and activity_train.plain is not None:
        plain = _pose_figures(activity.plain, poses, (activity_train.plain, poses_train))
        figures |= {f"plain_{name}": value for name, value in plain.items()}
    return figures


def _pose_figures(
    activity: Activity,
    poses: Float[np.ndarray, "views 3"],
    train: tuple[Activity, Float[np.ndarray, "train 3"]],
) -> dict[str, float]:
    """Measure headings and positions on the metric map, as far as there are any."""
    figures, (activity_train, poses_train) = dict[str, float](), train
    if not np.isnan(activity.phase).all():
        frame = fit_heading_frame(activity_train.phase, poses_train[:, 2])
        turn = heading_errors(activity.phase, poses[:, 2], frame)
        turn_deg = np.rad2deg(np.abs(turn))
        figures |= {
            "heading_median_deg": float(np.median(turn_deg)),
            "heading_p95_deg": float(np.percentile(turn_deg, 95)),
            "heading_resultant": float(abs(np.mean(np.exp(1j * turn)))),
        }
    if not np.isnan(activity.position).all():
        positions = poses[:, :2]
        laid = place_map(activity.position, fit_map_frame(activity_train.position, poses_train[:, :2]))
        figures |= {
            "metric_map_r2": float(r2_score(positions, laid, multioutput="variance_weighted")),
            "metric_map_median_m": float(np.median(np.linalg.norm(laid - positions, axis=1))),
        }
    return figures
