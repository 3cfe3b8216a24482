import numpy as np
import pandas as pd

from cogmap.plots import plot_quasi_metric

RNG = np.random.default_rng(0)
MOTION = RNG.uniform(0.1, 2, 3000)
PAIRS = pd.DataFrame({"motion_m": MOTION, "geodesic": 3 * MOTION})


def places(extent: float) -> pd.DataFrame:
    xy = RNG.uniform(-extent, extent, (100, 2))
    heading = RNG.uniform(-np.pi, np.pi, 100)
    return pd.DataFrame(
        {"x_m": xy[:, 0], "y_m": xy[:, 1], "heading_rad": heading, "distortion": np.exp(0.3 * xy[:, 0])}
    )


def test_the_median_follows_the_geodesics_and_the_map_shows_the_distortion(tmp_path) -> None:
    views = places(2.0)
    figure = plot_quasi_metric(PAIRS, views)
    x, y = figure.axes[0].lines[0].get_data()
    np.testing.assert_allclose(y, 3 * x, rtol=1e-6)
    room = next(axes for axes in figure.axes if axes.get_title() == "distortion by place")
    np.testing.assert_allclose(room.collections[0].get_array(), views["distortion"])
    norm = room.collections[0].norm
    np.testing.assert_allclose(norm.vmin * norm.vmax, 1)
    figure.savefig(tmp_path / "distances.png")


def test_of_a_single_place_there_is_no_map() -> None:
    titles = [axes.get_title() for axes in plot_quasi_metric(PAIRS, places(0.1)).axes]
    assert "distortion by heading" in titles
    assert "distortion by place" not in titles
