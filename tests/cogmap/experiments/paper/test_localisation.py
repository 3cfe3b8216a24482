import numpy as np
import pandas as pd
from hypothesis import given
from hypothesis import strategies as st

from cogmap.experiments.paper.localisation import _summary, _table_3, interpolated_poses
from cogmap.navigation import Location

ANGLES = st.floats(-np.pi, np.pi)


def test_headings_are_interpolated_across_the_cut() -> None:
    poses = np.array([[0.0, 0, np.pi - 0.1], [1, 2, 0.1 - np.pi]])
    location = Location(np.array([[0, 1]]), np.array([[0.25, 0.75]]))
    np.testing.assert_allclose(interpolated_poses(location, poses), [[0.75, 1.5, 0.05 - np.pi]])


@given(ANGLES, st.integers(0, 100))
def test_poses_are_the_weighted_sums_whatever_the_north(north: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    poses = np.column_stack([rng.normal(size=(20, 2)), rng.uniform(-0.5, 0.5, 20)])
    indices, weights = rng.integers(0, 20, (3, 5)), rng.normal(0.2, 0.1, (3, 5))
    weights += (1 - weights.sum(axis=1, keepdims=True)) / 5
    plain = np.array(
        [
            sum(weight * poses[view] for view, weight in zip(*row, strict=True))
            for row in zip(indices, weights, strict=True)
        ]
    )
    turned = poses + np.array([0, 0, north])
    turned[:, 2] = np.angle(np.exp(1j * turned[:, 2]))
    read = interpolated_poses(Location(indices, weights), turned)
    np.testing.assert_allclose(read[:, :2], plain[:, :2], atol=1e-12)
    assert np.abs(read[:, 2]).max() <= np.pi
    np.testing.assert_allclose(np.exp(1j * read[:, 2]), np.exp(1j * (plain[:, 2] + north)), atol=1e-12)


def test_missing_neighbours_do_not_count_and_without_any_there_is_no_pose() -> None:
    poses = np.array([[1.0, 2, 3], [9, 9, 0.5]])
    location = Location(np.array([[0, -1], [-1, -1]]), np.array([[1.0, 0], [np.nan, np.nan]]))
    read = interpolated_poses(location, poses)
    np.testing.assert_allclose(read[0], poses[0])
    assert np.isnan(read[1]).all()


def test_the_summary_leaves_out_views_without_a_place() -> None:
    errors = np.append(np.arange(101.0), np.nan)
    names = ["position_error_m", "heading_error_deg", "nearest_position_error_m", "nearest_heading_error_deg"]
    table = pd.DataFrame({name: scale * errors for scale, name in enumerate(names, start=1)})
    assert _summary(table) == {
        "position_median_m": 50,
        "position_p95_m": 95,
        "heading_median_deg": 100,
        "heading_p95_deg": 190,
        "nearest_position_median_m": 150,
        "nearest_position_p95_m": 285,
        "nearest_heading_median_deg": 200,
        "nearest_heading_p95_deg": 380,
    }


def test_table_3_has_a_row_for_each_neighbour_of_each_query() -> None:
    truth = np.array([[0.0, 0, 0], [7, 7, 7], [1, 0, 1]])
    known = np.array([[0.0, 1, 0], [1, 0, 1], [3, 0, 1.5]])
    table = _table_3(np.array([0, 2]), np.array([[1, 0], [1, 2]]), truth, known)
    assert table["query"].tolist() == [0, 0, 2, 2]
    assert table["rank"].tolist() == [1, 2, 1, 2]
    assert table["view"].tolist() == [1, 0, 1, 2]
    np.testing.assert_array_equal(table[["query_x_m", "query_y_m", "query_heading_rad"]], truth[[0, 0, 2, 2]])
    np.testing.assert_array_equal(table[["x_m", "y_m", "heading_rad"]], known[[1, 0, 1, 2]])
    np.testing.assert_allclose(table["position_error_m"], [1, 1, 0, 2])
    np.testing.assert_allclose(table["heading_error_deg"], np.rad2deg([1, 0, 0, 0.5]))
