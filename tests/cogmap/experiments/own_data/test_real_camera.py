import cv2
import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError
from cogmap.experiments.own_data.real_camera import RealCamera, crops, tilted

ROOM, POSE = Arena.load("furnished"), np.array([[0.4, -0.3, 0.7]])
PANORAMA = Camera.panoramic(1024, 250).render(ROOM, POSE)[0]
STRIPS = Camera.panoramic(180, 30).render(ROOM, np.tile(POSE, (4, 1)))


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one.astype(float) - other).mean())


@pytest.mark.parametrize(("height", "field"), [(48, np.pi / 2), (30, 2.0)])
def test_crops_are_what_a_perspective_camera_sees_there(height: int, field: float) -> None:
    yaws = np.array([0.0, 0.3, np.pi - 0.01, -3.0, 7.0])
    found = crops(PANORAMA, yaws, width=64, height=height, field_of_view=field)
    poses = np.column_stack([np.tile(POSE[:, :2], (len(yaws), 1)), POSE[0, 2] + yaws])
    seen = Camera.perspective(64, height, field_of_view=field).render(ROOM, poses)
    assert apart(found, seen) < 2
    assert apart(crops(PANORAMA, yaws + 0.03, width=64, height=height, field_of_view=field), seen) > 4


def test_views_higher_than_the_panorama_are_refused() -> None:
    with pytest.raises(CogmapError, match="cut at most 98 rows"):
        crops(PANORAMA, np.zeros(1), width=128, height=99)


def test_a_tilted_camera_sees_the_horizon_where_it_must() -> None:
    """A line on the horizon all around lies on the great circle that tilt makes of it."""
    line = np.zeros((101, 628, 3), np.uint8)
    line[50] = 255
    azimuth = np.pi - (np.arange(628) + 0.5) / 100
    for pitch, roll in ((0.1, 0.0), (0.0, 0.1), (0.08, -0.05)):
        rows = tilted(line, pitch, roll)[:, :, 0].argmax(axis=0)
        # up in front: what is ahead sinks; down on the right: what is on the right rises
        sinks = 100 * (pitch * np.cos(azimuth) + roll * np.sin(azimuth))
        assert np.abs(rows - 50 - sinks).max() < 1.5
    np.testing.assert_array_equal(tilted(PANORAMA, 0.0, 0.0), PANORAMA)


def test_each_flaw_is_what_it_says() -> None:
    rng = np.random.default_rng
    np.testing.assert_array_equal(RealCamera().photograph(STRIPS, rng(0)), STRIPS)
    grey = np.full((40, 20, 64, 3), 100, np.uint8)
    levels = RealCamera(exposure=0.2).photograph(grey, rng(0)).reshape(40, -1)
    assert (levels.std(axis=1) == 0).all()
    assert levels.min() >= 80
    assert levels.max() <= 120
    assert np.ptp(levels[:, 0]) > 25
    assert RealCamera(noise=0.02).photograph(grey, rng(0)).std() == pytest.approx(0.02 * 255, rel=0.02)
    shown = RealCamera(quality=60).photograph(STRIPS[:1], rng(0))[0]
    file = cv2.imencode(".jpg", STRIPS[0][:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, 60])[1]
    np.testing.assert_array_equal(shown[:, :, ::-1], cv2.imdecode(file, cv2.IMREAD_COLOR))


def test_lens_blur_runs_around_the_seam_of_a_panorama_only() -> None:
    dot = np.zeros((1, 21, 41, 3), np.uint8)
    dot[0, 10, 0] = 255
    around, bounded = (
        RealCamera(blur=1.5, wraps=wraps).photograph(dot, np.random.default_rng(0))[0, :, :, 0]
        for wraps in (True, False)
    )
    np.testing.assert_array_equal(around[:, 1:5], around[:, -1:-5:-1])
    assert around[10, 1] > 5
    assert not bounded[:, 20:].any()


def test_one_flaw_leaves_the_draws_of_the_others_as_they_were() -> None:
    plain, tilt = (
        RealCamera(exposure=0.2, tilt=by).photograph(np.full_like(STRIPS, 90), np.random.default_rng(3))
        for by in (0.0, 0.03)
    )
    np.testing.assert_array_equal(plain, tilt)


def test_views_that_do_not_wrap_are_not_tilted() -> None:
    with pytest.raises(CogmapError, match="do not wrap"):
        RealCamera(tilt=0.03, wraps=False).photograph(STRIPS, np.random.default_rng(0))
    with pytest.raises(CogmapError, match="uint8 images"):
        RealCamera().photograph(STRIPS / 255, np.random.default_rng(0))
