from typing import Any

import cv2
import numpy as np
import pytest
from scipy import ndimage

from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.recordings.lens import Lens
from arena.rooms.arena import Arena

TILE = np.random.default_rng(0).integers(0, 256, (40, 60, 3), dtype=np.uint8)


def painted(elevation: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    """Colours that tell the elevation (rad) and the azimuth (rad, to the left) of a pixel."""
    red, green, blue = elevation / np.pi + 0.5, (1 + np.sin(azimuth)) / 2, (1 + np.cos(azimuth)) / 2
    return np.stack(np.broadcast_arrays(red, green, blue), axis=2) * 255


def off(seen: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.abs(seen.astype(float) - wanted).max())


def cylinder(height: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    """Elevation and azimuth of its pixels, by the conventions of the eye."""
    focal = width / (2 * np.pi)
    elevation = np.arctan((height / 2 - (np.arange(height) + 0.5)) / focal)
    return elevation[:, None], np.pi - (np.arange(width) + 0.5)[None] / focal


@pytest.mark.parametrize("size", [(90, 180), (640, 1280), (500, 1280)], ids=str)
@pytest.mark.parametrize(
    ("ahead", "clockwise"), [(0.0, True), (0.0, False), (90.0, True), (-37.5, True), (170.0, False)]
)
def test_a_sphere_becomes_a_cylinder(size: tuple[int, int], ahead: float, *, clockwise: bool) -> None:
    height, width = size
    step = 2 * np.pi / width
    elevation = ((height / 2 - (np.arange(height) + 0.5)) * step)[:, None]
    right = (np.arange(width) + 0.5)[None] * step - np.pi - np.deg2rad(ahead)
    picture = np.rint(painted(elevation, -right if clockwise else right)).astype(np.uint8)
    lens = Lens(kind="equirectangular", width=180, height=60, ahead=ahead, clockwise=clockwise)
    view = lens.fitted(height, width)(picture)
    assert view.dtype == np.uint8
    # A pixel is 2° wide, along which a sine changes by 4.5 grey levels.
    assert off(view, painted(*cylinder(60, 180))) < 1.5


def test_a_sphere_of_a_room_becomes_what_the_eye_sees_in_it() -> None:
    room, pose = Arena.load("furnished"), np.array([[0.4, -0.3, 0.7]])
    fine = Camera.panoramic(1440, 1440).render(room, pose)[0]
    step = 2 * np.pi / 1440
    elevation = (240 - (np.arange(480) + 0.5)) * step  # up to 60°
    rows = np.broadcast_to(720 - np.tan(elevation)[:, None] / step - 0.5, (480, 1440))
    columns = np.broadcast_to(np.arange(1440.0), (480, 1440))
    sphere = [ndimage.map_coordinates(fine[..., c].astype(float), [rows, columns], order=1) for c in range(3)]
    view = Lens(kind="equirectangular", width=360, height=60).fitted(480, 1440)(
        np.rint(np.stack(sphere, axis=2)).astype(np.uint8)
    )
    seen = Camera.panoramic(360, 60).render(room, pose)[0].astype(float)
    assert np.abs(view - seen).mean() < 1
    # By least squares: by what share of a pixel it is moved against what is seen.
    slopes = np.stack([slope.ravel() for slope in np.gradient(seen, axis=(0, 1))], axis=1)
    moved, *_ = np.linalg.lstsq(slopes, (view - seen).ravel())
    assert np.abs(moved).max() < 0.02


@pytest.mark.parametrize(
    ("ring", "ahead", "clockwise"),
    [
        ((200.3, 190.8, 60.0, 180.0), 0.0, True),
        ((200.3, 190.8, 180.0, 60.0), 0.0, True),
        ((200.3, 190.8, 60.0, 180.0), 90.0, True),
        ((200.3, 190.8, 60.0, 180.0), -20.0, False),
    ],
)
def test_the_ring_of_a_mirror_is_unrolled(
    ring: tuple[float, float, float, float], ahead: float, *, clockwise: bool
) -> None:
    x, y, low, high = ring
    down, right = np.mgrid[:400, :420] + 0.5
    radius = np.hypot(right - x, down - y)
    turn = np.arctan2(right - x, y - down) - np.deg2rad(ahead)  # clockwise from the top of the picture
    elevation = ((radius - low) / (high - low) - 0.5) * np.pi
    picture = np.clip(painted(elevation, -turn if clockwise else turn), 0, 255).astype(np.uint8)
    lens = Lens(kind="mirror", mirror=ring, width=180, height=40, ahead=ahead, clockwise=clockwise)
    view = lens.fitted(400, 420)(picture)
    wanted = painted((0.5 - (np.arange(40) + 0.5)[:, None] / 40) * np.pi, cylinder(40, 180)[1])
    assert off(view, wanted) < 4
    assert np.abs(view - wanted).mean() < 1
    beside = cv2.warpPolar(picture, (180, 1130), (x - 0.5, y - 0.5), 180, cv2.WARP_POLAR_LINEAR)
    assert view.mean() == pytest.approx(beside[:, 60:].mean(), abs=1)


def test_sizes_of_what_is_unrolled() -> None:
    ring = (50.0, 50.0, 20.0, 40.0)
    assert Lens(kind="mirror", mirror=ring).fitted(100, 100)(np.zeros((100, 100, 3), np.uint8)).shape == (
        20,
        188,
        3,
    )
    flat = Lens(kind="equirectangular").fitted(180, 360)(np.zeros((180, 360, 3), np.uint8))
    assert flat.shape == (60, 360, 3)


def test_a_ring_that_leaves_the_picture_is_black_there() -> None:
    white = np.full((100, 100, 3), 255, np.uint8)
    view = Lens(kind="mirror", mirror=(50, 20, 10, 40), width=36, height=6).fitted(100, 100)(white)
    assert view[0, 18].max() == 0  # 35 to 40 above the centre, which is 20 below the edge
    assert view[0, 0].min() == 255
    assert view[-1].min() == 255


@pytest.mark.parametrize("kind", [None, "perspective", "cylindrical"])
def test_as_they_are(kind: Any) -> None:
    np.testing.assert_array_equal(Lens(kind=kind).fitted(40, 60)(TILE), TILE)


def test_a_cylinder_is_turned_and_mirrored() -> None:
    look = Lens(kind="cylindrical", ahead=90).fitted(40, 60)
    np.testing.assert_array_equal(look(TILE), np.roll(TILE, -15, axis=1))
    look = Lens(kind="cylindrical", clockwise=False).fitted(40, 60)
    np.testing.assert_array_equal(look(TILE), TILE[:, ::-1])
    # What is 90° to the right of the middle stands in the middle again, where the world is mirrored, too.
    look = Lens(kind="cylindrical", ahead=90, clockwise=False).fitted(40, 60)
    np.testing.assert_array_equal(look(TILE)[:, 29:31], TILE[:, [45, 44]])


@pytest.mark.parametrize(
    ("told", "size"),
    [({"width": 15}, (10, 15)), ({"height": 20}, (20, 30)), ({"width": 30, "height": 10}, (10, 30))],
)
def test_smaller_by_area(told: dict[str, int], size: tuple[int, int]) -> None:
    view = Lens(**told).fitted(40, 60)(TILE)
    rows, columns = size
    means = TILE.reshape(rows, 40 // rows, columns, 60 // columns, 3).mean(axis=(1, 3))
    assert off(view, means) <= 0.5


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        (
            {"kind": "fisheye"},
            "no kind of picture 'fisheye'; choose one of equirectangular, cylindrical, mirror",
        ),
        ({"kind": "mirror"}, "a mirror needs both"),
        ({"mirror": (1, 1, 2, 3)}, "a mirror needs both"),
        ({"kind": "mirror", "mirror": (1, 1, 2, 2)}, "give two that differ"),
        ({"kind": "mirror", "mirror": (1, 1, -2, 2)}, "give two that differ"),
        ({"kind": "perspective", "ahead": 5}, "ahead and clockwise are of panoramas"),
        ({"clockwise": False}, "ahead and clockwise are of panoramas"),
        ({"width": 0}, "width"),
        ({"kind": "cylindrical", "ahead": 500}, "ahead"),
    ],
)
def test_lenses_that_cannot_be(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(ArenaError, match=words):
        Lens(**fields)


def test_pictures_that_a_lens_cannot_have_taken() -> None:
    with pytest.raises(ArenaError, match="100×100 pixels; equirectangular ones are at most half as high"):
        Lens(kind="equirectangular").fitted(100, 100)
    with pytest.raises(ArenaError, match=r"would see 45\.0° up and down and the pictures see 18\.0°"):
        Lens(kind="equirectangular", width=314, height=100).fitted(100, 1000)
    with pytest.raises(ArenaError, match=r"centre \(500, 5\) is not in pictures of 100×100"):
        Lens(kind="mirror", mirror=(500, 5, 2, 3)).fitted(100, 100)


def test_what_camera_takes_such_views() -> None:
    assert Lens(kind="mirror", mirror=(5, 5, 2, 3)).camera(6, 36)["field_of_view"] == 2 * np.pi
    assert Lens(kind="perspective").camera(6, 36)["projection"] == "perspective"
    assert "projection" not in Lens().camera(6, 36)
