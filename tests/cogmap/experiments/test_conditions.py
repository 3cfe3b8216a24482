from pathlib import Path

import numpy as np

from arena import Arena, Brownian, Camera, Nose, Rotation
from cogmap.experiments.conditions import FRESH_SEED, Conditions

ROOM = Arena.load("furnished")
SMALL = Camera.panoramic(36, 6)


def test_the_walk_is_the_same_whatever_the_camera() -> None:
    conditions = Conditions(ROOM, 40, seed=3)
    around, ahead = (conditions.explore(Brownian(), camera) for camera in (SMALL, Camera.perspective(32, 24)))
    np.testing.assert_array_equal(around.require("poses"), ahead.require("poses"))
    assert len(around) == 40


def test_a_fresh_walk_is_another() -> None:
    known, fresh = (Conditions(ROOM, 40).explore(Brownian(), SMALL, views=20, fresh=x) for x in (False, True))
    assert len(fresh) == 20
    assert not np.array_equal(known.require("poses"), fresh.require("poses"))
    same = Conditions(ROOM, 20, seed=FRESH_SEED).explore(Brownian(), SMALL)
    np.testing.assert_array_equal(same.require("poses"), fresh.require("poses"))


def test_views_kept_in_a_folder_are_the_same(tmp_path: Path) -> None:
    there, here = (Conditions(ROOM, 30, scratch=folder) for folder in (tmp_path, None))
    for fresh in (False, True):
        kept = there.explore(Brownian(), SMALL, fresh=fresh)
        np.testing.assert_array_equal(kept.views, here.explore(Brownian(), SMALL, fresh=fresh).views)
        assert not isinstance(kept.views, np.ndarray)
    assert len(list(tmp_path.iterdir())) == 2


def test_what_the_setting_has_goes_before_what_the_experiment_has() -> None:
    usual = Conditions(ROOM, 30).explore(Brownian(), SMALL)
    keen = Conditions(ROOM, 30, nose=Nose(noise=0.0)).explore(Brownian(), SMALL)
    clean = ROOM.odours.concentration(keen.require("poses")[:, :2])
    np.testing.assert_allclose(keen.odours, clean, rtol=1e-5)
    assert np.abs(np.log(usual.odours / clean)).max() > 0.1
    spun = Conditions(ROOM, 30, motion=Rotation(), camera=Camera.panoramic(72, 12)).explore(Brownian(), SMALL)
    assert spun.views.shape[1:] == (12, 72, 3)
    assert np.ptp(spun.require("poses")[:, :2]) < np.ptp(usual.require("poses")[:, :2])
