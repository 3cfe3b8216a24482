import pytest
import shapely

from arena import Arena
from cogmap.errors import CogmapError
from cogmap.experiments.rooms.new_wall import with_a_wall


def test_a_wall_stands_in_the_middle_and_parts_nothing() -> None:
    room = Arena.load("open_field")
    walled = with_a_wall(room)
    assert len(walled.boxes) == len(room.boxes) + 1
    assert walled.free_space(0.18).geom_type == "Polygon"
    assert not walled.free_space(0.18).contains(shapely.Point(0, 0.3))
    assert room.free_space(0.18).contains(shapely.Point(0, 0.3))


def test_a_room_that_a_wall_would_part_is_refused() -> None:
    narrow = Arena.load("open_field").model_copy(
        update={"platform": [[[-2.0, -0.6], [2.0, -0.6], [2.0, 0.6], [-2.0, 0.6]]]}
    )
    with pytest.raises(CogmapError, match="a wall across 'open_field' parts it"):
        with_a_wall(narrow)
