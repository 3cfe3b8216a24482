from pathlib import Path

import pytest

from cogmap import Plan
from cogmap.sweeps.points import points_of

FILES = sorted((Path(__file__).parents[3] / "examples" / "sweeps").glob("*.toml"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_example_can_be_begun(file: Path) -> None:
    plan = Plan.load(file)
    points = points_of(plan)
    assert len(points) == len(plan.assignments()) * len(plan.seeds) >= 15
    assert file.read_text(encoding="utf-8").startswith("# ")


def test_the_corridor_grows() -> None:
    points = points_of(Plan.load(next(file for file in FILES if file.stem == "corridor_width")))
    for point in points:
        assert point.room.walkable.area == pytest.approx(5 * float(point.varied["arena.platform"]))


def test_sources_are_as_many_as_their_names_say() -> None:
    points = points_of(Plan.load(next(file for file in FILES if file.stem == "sources_and_noise")))
    assert [len(point.room.sources) for point in points] == [
        point.varied["arena.sources"] for point in points
    ]
