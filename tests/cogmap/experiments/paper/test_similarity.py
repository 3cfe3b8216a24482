import numpy as np

from cogmap.experiments.paper.similarity import _nearest_table


def test_a_row_tells_how_far_in_pose_the_view_is_that_a_measure_finds() -> None:
    asked = np.array([[0.0, 0, 3.1], [1, 1, 0]])
    poses = np.array([[0.0, 0, 3.1], [3, 4, -3.1], [1, 1.5, 0.5]])
    table = _nearest_table({"one": np.array([1, 2]), "two": np.array([0, 0])}, asked, poses)
    assert table["measure"].tolist() == ["one", "one", "two", "two"]
    assert table["query"].tolist() == [0, 1, 0, 1]
    assert table["view"].tolist() == [1, 2, 0, 0]
    np.testing.assert_allclose(table["position_error_m"], [5, 0.5, 0, np.sqrt(2)])
    np.testing.assert_allclose(table["heading_error_deg"], np.rad2deg([2 * np.pi - 6.2, 0.5, 0, 3.1]))
    assert table.index.is_unique
