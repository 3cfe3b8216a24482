import numpy as np

from cogmap.experiments.poses import pose_columns, pose_errors


def test_columns_are_named_and_in_order() -> None:
    poses = np.array([[1.0, 2, 3], [4, 5, 6]])
    found = pose_columns(poses, "read_")
    assert list(found) == ["read_x_m", "read_y_m", "read_heading_rad"]
    np.testing.assert_array_equal(np.column_stack(list(found.values())), poses)
    assert list(pose_columns(poses)) == ["x_m", "y_m", "heading_rad"]


def test_errors_are_metres_and_degrees_the_short_way() -> None:
    read, truth = np.array([[3.0, 4, 3.1], [0, 0, 0.5]]), np.array([[0.0, 0, -3.1], [0, 0, 0.25]])
    found = pose_errors(read, truth, "nearest_")
    np.testing.assert_allclose(found["nearest_position_error_m"], [5, 0])
    np.testing.assert_allclose(found["nearest_heading_error_deg"], np.rad2deg([2 * np.pi - 6.2, 0.25]))
