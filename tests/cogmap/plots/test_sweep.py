import numpy as np
import pandas as pd
import pytest
from scipy.stats import t, ttest_1samp

from cogmap.plots import plot_trend
from cogmap.plots.sweep import statistics_of, summarise


@pytest.fixture
def table() -> pd.DataFrame:
    rng = np.random.default_rng(0)
    rows = [
        {"arena": arena, "nose.noise": noise, "seed": seed, "error_deg": noise * 10 + rng.normal(), "same": 1}
        for arena in ("pillar", "open")
        for noise in (0.1, 0.2, 0.4)
        for seed in range(4)
    ]
    return pd.DataFrame(rows).assign(trusted=pd.array([True] * 23 + [False], dtype="boolean"), error="")


def test_the_interval_is_that_of_a_t_test(table: pd.DataFrame) -> None:
    found = summarise(table, "error_deg", ["arena", "nose.noise"])
    for row in found.itertuples(index=False):
        sample = table[(table["arena"] == row[0]) & (table["nose.noise"] == row[1]) & table["trusted"]][
            "error_deg"
        ]
        low, high = ttest_1samp(sample, 0).confidence_interval(0.95)
        np.testing.assert_allclose([row[2] - row[3], row[2] + row[3]], [low, high])
    assert found["seeds"].tolist() == [4, 4, 3, 4, 4, 4]


def test_what_else_varied_is_averaged_within_a_seed(table: pd.DataFrame) -> None:
    found = summarise(table[table["nose.noise"] < 0.3], "error_deg", ["nose.noise"])
    wide = table.pivot_table("error_deg", ["seed"], ["nose.noise"])[0.1]
    assert found["mean"][0] == pytest.approx(wide.mean())
    assert found["half"][0] == pytest.approx(t.ppf(0.975, 3) * wide.std() / 2)


def test_one_seed_has_no_interval_and_failures_no_mean(table: pd.DataFrame) -> None:
    one = summarise(table[table["seed"] == 0], "error_deg", ["arena", "nose.noise"])
    assert one["half"].isna().all()
    lost = table.assign(error=["no"] * 12 + [""] * 12)
    assert summarise(lost, "error_deg", ["arena"])["arena"].tolist() == ["open"]


def test_numbers_that_differ_are_statistics(table: pd.DataFrame) -> None:
    assert statistics_of(table, ["arena", "nose.noise"]) == ["error_deg", "trusted"]


def test_each_parameter_has_a_panel_with_its_scale(table: pd.DataFrame) -> None:
    figure = plot_trend(
        table, "error_deg", ["arena", "nose.noise"], logarithmic={"nose.noise"}, labels={"arena": "the room"}
    )
    rooms, noise = figure.axes
    assert (rooms.get_xlabel(), rooms.get_ylabel()) == ("the room", "error (°)")
    assert [tick.get_text() for tick in rooms.get_xticklabels()] == ["open", "pillar"]
    assert noise.get_xscale() == "log"
    assert noise.get_xlabel() == "nose.noise (s.d. of log concentration)"
    assert [tick.get_text() for tick in noise.get_xticklabels()] == ["0.1", "0.2", "0.4"]
    lines = [container[0].get_ydata() for container in noise.containers]
    assert len(lines) == 2
    means = summarise(table, "error_deg", ["arena", "nose.noise"])["mean"].to_numpy()
    np.testing.assert_allclose(np.concatenate(lines).astype(float), means)
    assert "mean of 4 seeds" in figure.get_suptitle()
    assert "1 of 24 rows" in figure.get_suptitle()


def test_points_of_a_sample_stand_alone(table: pd.DataFrame) -> None:
    figure = plot_trend(
        table.assign(arena=np.arange(24.0)), "error_deg", ["arena", "nose.noise"], joined=False
    )
    for axes in figure.axes:
        assert len(axes.containers[0][0].get_xdata()) == 23
        assert axes.containers[0][0].get_linestyle() == "None"
    doubted = figure.axes[0].lines[-1]
    np.testing.assert_array_equal(doubted.get_xdata(), [23.0])


def test_a_sheet_of_many_parameters(table: pd.DataFrame) -> None:
    wide = table.assign(**{f"p{number}": table["nose.noise"] + number for number in range(3)})
    figure = plot_trend(wide, "error_deg", ["arena", "nose.noise", "p0", "p1", "p2"])
    assert sum(axes.axison for axes in figure.axes) == 5


def test_a_log_scale_of_many_values_has_plain_ticks(table: pd.DataFrame) -> None:
    many = table.assign(area_m2=table["error_deg"], **{"nose.noise": np.geomspace(0.02, 0.5, 24)})
    figure = plot_trend(many, "area_m2", ["nose.noise"], logarithmic={"nose.noise"}, joined=False)
    figure.draw_without_rendering()
    (axes,) = figure.axes
    shown = {tick.get_text() for tick in axes.get_xticklabels()}
    assert {"0.02", "0.05", "0.1", "0.2", "0.5"} <= shown
    assert not axes.get_xticks(minor=True).size
    assert axes.get_ylabel() == "area (m²)"
