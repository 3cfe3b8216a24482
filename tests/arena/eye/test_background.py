import numpy as np
import pytest

from arena.eye.background import backdrop
from arena.eye.camera import Camera

FLOOR, CEILING, ZENITH = (10, 20, 30), (100, 110, 120), (200, 60, 90)


@pytest.mark.parametrize("height", [8, 9])
def test_a_plain_world_is_one_column_of_floor_and_ceiling(height: int) -> None:
    sky = backdrop(Camera.perspective(12, height)._optics[0], FLOOR, CEILING, None)
    assert len(sky.columns) == 1
    column = sky.columns[0, : 4 * height].reshape(height, 4)[:, :3]
    above = (height + 1) // 2
    assert (column[:above] == CEILING).all()
    assert (column[above:] == FLOOR).all()
    assert (sky.image.reshape(height, 12, 3) == column[:, None]).all()


@pytest.mark.parametrize("camera", [Camera.perspective(12, 40, field_of_view=2.0), Camera.panoramic(12, 40)])
def test_the_ceiling_shades_with_the_sine_of_the_elevation(camera: Camera) -> None:
    sky = backdrop(camera._optics[0], FLOOR, CEILING, ZENITH)
    assert len(sky.columns) == (1 if camera.projection == "panoramic" else 12)
    rise = (20 - np.arange(20) - 0.5) / camera.focal_length
    for c in range(len(sky.columns)):
        x = c + 0.5 - 6 if camera.projection == "perspective" else 0.0
        sine = rise / np.sqrt(rise**2 + 1 + (x / camera.focal_length) ** 2)
        wanted = np.array(CEILING) + sine[:, None] * np.subtract(ZENITH, CEILING)
        np.testing.assert_allclose(sky.columns[c, :80].reshape(20, 4)[:, :3], wanted, atol=0.51)
        np.testing.assert_array_equal(
            sky.image[:20].reshape(20, 12, 3)[:, c], sky.columns[c, :80].reshape(20, 4)[:, :3]
        )
