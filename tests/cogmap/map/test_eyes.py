import warnings

import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError, OpenSeamWarning
from cogmap.map.eyes import RETINAS, found_eye
from neurons.layers.retina import Retina

ROOM = Arena.load("furnished")
POSES = np.column_stack(
    [
        np.random.default_rng(0).uniform(-1, 1, size=(120, 2)),
        np.random.default_rng(1).uniform(-np.pi, np.pi, size=120),
    ]
)
AROUND = Camera.panoramic(90, 15).render(ROOM, POSES)
AHEAD = Camera.perspective(64, 48).render(ROOM, POSES)


def test_views_tell_by_which_eye_they_were_taken() -> None:
    assert found_eye(None, AROUND) == "panorama"
    assert found_eye(None, AHEAD) == "perspective"


def test_what_tells_nothing_is_taken_for_a_panorama() -> None:
    noise = np.random.default_rng(0).integers(0, 256, size=(30, 15, 90, 3)).astype(np.uint8)
    for views in (noise, np.full((30, 15, 90, 3), 9, np.uint8), AHEAD[:1]):
        assert found_eye(None, views) == "panorama"


def test_what_is_told_goes_before_and_a_seam_that_is_open_is_noticed() -> None:
    with pytest.warns(OpenSeamWarning, match="give eye='perspective'"):
        assert found_eye("panorama", AHEAD) == "panorama"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert found_eye("panorama", AROUND) == "panorama"
        assert found_eye("perspective", AROUND) == "perspective"


def test_there_are_no_others() -> None:
    with pytest.raises(CogmapError, match="choose one of panorama, perspective"):
        found_eye("fisheye", AHEAD)


@pytest.mark.parametrize("eye", RETINAS)
def test_each_has_a_retina(eye: str) -> None:
    assert Retina(48, 120, **RETINAS[eye]).features > 0
