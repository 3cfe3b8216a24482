from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cogmap import CogmapError, Plan

TOML = """
experiment = "toy"
views = 400
seeds = [0, 1]
[set]
"map.charts" = 130
[grid]
arena = ["furnished", "pillar"]
"nose.noise" = [0.05, 0.1, 0.2]
"""

EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "sweeps").glob("*.toml"))


def shown(plan: Plan) -> list[dict[str, Any]]:
    return [{name: choice.shown for name, choice in point.items()} for point in plan.assignments()]


def test_a_grid_is_every_combination_in_order(tmp_path: Path) -> None:
    (tmp_path / "sweep.toml").write_text(TOML, encoding="utf-8")
    plan = Plan.load(tmp_path / "sweep.toml")
    assert (plan.experiment, plan.views, plan.seeds, plan.fixed) == ("toy", 400, (0, 1), {"map.charts": 130})
    assert plan.varied == ("arena", "nose.noise")
    assert shown(plan)[:4] == [
        {"arena": "furnished", "nose.noise": 0.05},
        {"arena": "furnished", "nose.noise": 0.1},
        {"arena": "furnished", "nose.noise": 0.2},
        {"arena": "pillar", "nose.noise": 0.05},
    ]
    assert plan.logarithmic == {"nose.noise"}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_written_and_read_it_is_the_same_plan(path: Path) -> None:
    plan = Plan.load(path)
    assert Plan.parse(plan.to_toml()) == plan


def test_named_values_are_told_by_their_names() -> None:
    grid = {"arena.sources": {"1": ["a"], "2": ["a", "b"]}, "arena.floor": {"red": [255, 0, 0], "7": "brick"}}
    points = Plan.create(experiment="toy", grid=grid).assignments()
    assert [(point["arena.sources"].shown, point["arena.floor"].shown) for point in points] == [
        (1, "red"), (1, "7"), (2, "red"), (2, "7")
    ]  # fmt: skip
    assert points[0]["arena.sources"].value == ["a"]
    assert points[3]["arena.floor"].value == "brick"
    assert shown(Plan.create(experiment="toy", grid={"x": {"0.5": 1, "1e1": 2}})) == [{"x": 0.5}, {"x": 10.0}]


def test_points_one_by_one_and_drawn() -> None:
    points = [{"arena": "pillar", "views": 300}, {"arena": "furnished", "views": 500}]
    assert shown(Plan.create(experiment="toy", points=points)) == points
    assert shown(Plan.create(experiment="toy", points=[{"floor": [1, 2]}])) == [{"floor": "[1,2]"}]
    sample = {"points": 8, "ranges": {"nose.noise": {"low": 0.01, "high": 1, "log": True}}}
    drawn = Plan.create(experiment="toy", sample=sample)
    assert len(shown(drawn)) == 8
    assert drawn.varied == ("nose.noise",)
    assert drawn.logarithmic == {"nose.noise"}


def test_only_equal_ratios_are_logarithmic() -> None:
    grid = {"a": [1, 2, 3], "b": [1, 10], "c": [0.0, 1.0, 10.0], "d": [40, 10, 20], "e": ["x", "y", "z"]}
    assert Plan.create(experiment="toy", grid=grid).logarithmic == {"d"}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "the TOML is empty"),
        ("experiment = ", "this is not TOML"),
        ('experiment = "toy"', "exactly one way"),
        ('experiment = "toy"\n[grid]', "no points"),
        ('experiment = "toy"\npoints = []', "no points"),
        ('experiment = "toy"\n[grid]\n"nose.noise" = []', "no values for 'nose.noise'"),
        ('experiment = "toy"\n[grid]\nviews = [1]\n[[points]]\nviews = 1', "exactly one way"),
        ('experiment = "toy"\nviews = 1\n[grid]\nviews = [1]', "both fixed and varied"),
        ('experiment = "toy"\n[set]\narena = "x"\n[grid]\narena = ["y"]', "both fixed and varied"),
        ('experiment = "toy"\nseeds = [1, 1]\n[grid]\nviews = [1]', "repeat themselves"),
        ('experiment = "toy"\nseeds = []\n[grid]\nviews = [1]', "seeds"),
        ('experiment = "toy"\nseeds = [-1]\n[grid]\nviews = [1]', r"seeds\.0 is -1"),
        ('experiment = "toy"\nseed = 3\n[grid]\nviews = [1]', "seed: Extra"),
        ('experiment = "toy"\nviews = "many"\n[grid]\narena = ["x"]', "views is 'many'"),
        ('experiment = "toy"\n[[points]]\nviews = 1\n[[points]]\narena = "x"', "point 1 has 'arena'"),
        (
            'experiment = "toy"\n[sample]\npoints = 0\nranges.views = {low = 1, high = 2}',
            "sample.points is 0",
        ),
        ('experiment = "toy"\n[sample]\npoints = 4\nranges = {}', "sample.ranges"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "sweep.toml").write_text(text, encoding="utf-8")
    with pytest.raises(CogmapError, match=says) as caught:
        Plan.load(tmp_path / "sweep.toml")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there() -> None:
    with pytest.raises(CogmapError, match=r"cannot read the sweep nowhere\.toml"):
        Plan.load("nowhere.toml")


def test_numbers_may_be_numpys() -> None:
    plan = Plan.create(
        experiment="toy",
        views=np.int64(400),
        seeds=np.arange(2),
        grid={"map.charts": list(np.array([50, 60])), "nose.noise": np.linspace(0.25, 0.5, 2)},
    )
    plain = {"map.charts": [50, 60], "nose.noise": [0.25, 0.5]}
    assert plan == Plan.create(experiment="toy", views=400, seeds=(0, 1), grid=plain)
    assert Plan.parse(plan.to_toml()) == plan


def test_a_byte_order_mark_is_no_text_and_a_tilde_is_the_home(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "sweep.toml").write_text(TOML, encoding="utf-8-sig")
    assert Plan.load("~/sweep.toml") == Plan.parse(TOML)
