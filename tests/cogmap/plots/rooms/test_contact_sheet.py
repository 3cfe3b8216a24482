import numpy as np
import pytest

from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from cogmap.plots.rooms.contact_sheet import plot_sheet


def poses(titles: list[str]) -> np.ndarray:
    """Read the poses back from the titles."""
    words = [title.replace("−", "-").replace(",", "").replace("°", "").split() for title in titles]
    return np.array([(float(w[1]), float(w[4]), np.deg2rad(float(w[7]))) for w in words])


@pytest.mark.parametrize("name", ["pillar", "linear_track"])
def test_views_are_those_from_the_poses_in_their_titles(name: str) -> None:
    room = Arena.load(name)
    panels = plot_sheet(room).axes
    assert len(panels) == 12
    found = poses([panel.get_title() for panel in panels])
    np.testing.assert_array_equal(found[:6], found[6:])
    assert room.is_free(found[:, :2], 0.17).all()
    for shown, camera in (
        (panels[:6], Camera.perspective()),
        (panels[6:], Camera.panoramic(720, 120)),
    ):
        views = np.stack([np.asarray(panel.images[0].get_array()) for panel in shown])
        # Titles are rounded to centimetres and degrees.
        wanted = camera.render(room, found[:6])
        assert np.median(np.abs(views.astype(int) - wanted)) < 5


def test_places_are_far_from_each_other_and_headings_differ() -> None:
    found = poses([panel.get_title() for panel in plot_sheet(Arena.load("open_field")).axes[:6]])
    apart = np.linalg.norm(found[:, None, :2] - found[:, :2], axis=2) + 9 * np.eye(6)
    assert apart.min() > 1
    assert len(plot_sheet(Arena.load("open_field"), views=2).axes) == 2 * 2
    turn = np.abs(np.angle(np.exp(1j * (found[:, None, 2] - found[:, 2])))) + 9 * np.eye(6)
    assert turn.min() > np.deg2rad(25)


def test_the_same_room_gives_the_same_sheet_with_its_name() -> None:
    one, other = (plot_sheet(Arena.load("two_rooms")) for _ in range(2))
    for a, b in zip(one.axes, other.axes, strict=True):
        np.testing.assert_array_equal(a.images[0].get_array(), b.images[0].get_array())
        assert a.get_title() == b.get_title()
    assert one.get_suptitle() == "two_rooms"


def test_a_room_that_holds_no_body_is_refused() -> None:
    room = Arena.load("open_field").model_copy(update={"platform": (((0, 0), (0.3, 0), (0.3, 1)),)})
    with pytest.raises(ArenaError, match="no free space"):
        plot_sheet(room)
