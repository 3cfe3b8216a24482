from pathlib import Path

import numpy as np
import pandas as pd

from arena import Arena, Camera
from cogmap.cells import fit_heading_frame, heading_errors
from cogmap.experiments.paper.goals import goal_grid, ring_distances, spread_orientation
from cogmap.experiments.registry import run_experiment
from cogmap.plots import plot_goals


def rings() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Codes (x, y, cos θ, sin θ) of the views on three rings in a row, their headings and their rings."""
    heading = np.tile(np.linspace(-np.pi, np.pi, 60, endpoint=False), 3)
    ring = np.repeat([0, 1, 2], 60)
    codes = np.column_stack([0.5 * ring, 0 * ring, np.cos(heading), np.sin(heading)])
    return codes, heading, ring


def test_orientation_is_passed_on_from_ring_to_ring() -> None:
    codes, heading, ring = rings()
    found = spread_orientation(codes, ring, np.array([1, 0, 2]))
    missed = heading_errors(found, heading, fit_heading_frame(found, heading))
    assert np.rad2deg(np.abs(missed)).max() < 10
    np.testing.assert_allclose(found[ring == 0], found[ring == 1])


def test_distances_are_to_the_nearest_view_of_a_ring() -> None:
    codes, _, ring = rings()
    np.testing.assert_allclose(
        ring_distances(codes[:60], codes, ring), np.tile([0, 0.5, 1], (60, 1)), atol=1e-6
    )


def test_goals_lie_where_the_body_can_go() -> None:
    assert len(goal_grid(Arena.load("open_field"))) == 12
    assert 0 < len(goal_grid(Arena.load("pillar"))) <= 12


def test_rings_at_goals_are_place_cells(tmp_path: Path) -> None:
    result = run_experiment("goals", tmp_path / "out", views=3000, camera=Camera.panoramic(90, 15))
    metrics = result.metrics
    assert metrics["goals"] == 12
    assert metrics["ring_betti"] == [1, 1]
    assert metrics["place_cells_passing"] > 0.9
    assert metrics["in_field_direction_vector"] < 0.1
    assert metrics["ring_spread_m"] < 0.05
    assert set(result.tables["views"]["ring"]) == set(range(12))
    assert {file.stem for file in (tmp_path / "out").glob("*.png")} == result.figures.keys()
    assert metrics["heading_cells_passing"] > 0.9


def test_the_figure_has_a_stroke_a_view() -> None:
    _, heading, ring = rings()
    views = pd.DataFrame(
        {
            "x_m": 0.5 * ring,
            "y_m": 0.0 * ring,
            "heading_rad": heading,
            "orientation_rad": heading,
            "ring": ring,
        }
    )
    figure = plot_goals(Arena.load("open_field"), views)
    left, right, *_ = figure.axes
    assert left.get_title() == "3 goals, 180 views at them"
    dots = right.collections[0].get_offsets()
    np.testing.assert_allclose(dots[:, 0], dots[:, 1], atol=1e-9)
