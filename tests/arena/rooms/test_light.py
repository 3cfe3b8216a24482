import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.rooms.light import Light


def test_known_answers() -> None:
    light = Light(azimuth_deg=90.0, elevation_deg=30.0, strength=0.6)
    np.testing.assert_allclose(light.direction, [0, np.sqrt(0.75), 0.5], atol=1e-12)
    normals = np.array([[0.0, 1, 0], [0, -1, 0], [1, 0, 0], [0, 0, 1], light.direction, -light.direction])
    wanted = [0.4 + 0.6 * np.sqrt(0.75), 0.4, 0.4, 0.7, 1.0, 0.4]
    np.testing.assert_allclose(light.brightness(normals), wanted)


angles = st.floats(0, 2 * np.pi)


@given(azimuth=st.floats(-360, 360), elevation=st.floats(0.1, 89.9), strength=st.floats(0, 1), facing=angles)
def test_a_wall_is_lambertian_where_it_faces_the_lamp_and_ambient_where_not(
    azimuth: float, elevation: float, strength: float, facing: float
) -> None:
    light = Light(azimuth_deg=azimuth, elevation_deg=elevation, strength=strength)
    (found,) = light.brightness(np.array([[np.cos(facing), np.sin(facing), 0.0]]))
    cosine = np.cos(np.deg2rad(elevation)) * np.cos(facing - np.deg2rad(azimuth))
    assert found == pytest.approx(1 - strength + strength * max(0.0, cosine))
    assert np.linalg.norm(light.direction) == pytest.approx(1)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"elevation_deg": 0.0}, "light.elevation_deg is 0.0: Input should be greater than 0"),
        ({"elevation_deg": 90}, "light.elevation_deg is 90: Input should be less than 90"),
        ({"strength": 1.1}, "light.strength is 1.1"),
        ({"azimuth_deg": float("nan")}, "light.azimuth_deg is nan"),
        ({"shadows": True}, "light.shadows"),
    ],
)
def test_impossible_lamps_are_refused(wrong: dict[str, object], says: str) -> None:
    light = {"azimuth_deg": 0.0, "elevation_deg": 45.0, **wrong}
    with pytest.raises(ArenaError, match=f"^{says}"):
        Arena.create(**{**Arena.load("open_field").model_dump(), "light": light})
