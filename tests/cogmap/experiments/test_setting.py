from pathlib import Path

import numpy as np
import pytest

from arena import Arena, Brownian, Camera
from cogmap.experiments.setting import FRESH_SEED, Setting, poses_of

ROOM = Arena.load("furnished")
SMALL = Camera.panoramic(36, 6)


def test_the_walk_is_the_same_whatever_the_camera() -> None:
    setting = Setting(ROOM, 40, seed=3)
    around, ahead = (setting.explore(Brownian(), camera) for camera in (SMALL, Camera.perspective(32, 24)))
    np.testing.assert_array_equal(poses_of(around), poses_of(ahead))
    assert len(around) == 40


def test_a_fresh_walk_is_another() -> None:
    known, fresh = (Setting(ROOM, 40).explore(Brownian(), SMALL, views=20, fresh=x) for x in (False, True))
    assert len(fresh) == 20
    assert not np.array_equal(poses_of(known), poses_of(fresh))
    same = Setting(ROOM, 20, seed=FRESH_SEED).explore(Brownian(), SMALL)
    np.testing.assert_array_equal(poses_of(same), poses_of(fresh))


def test_views_kept_in_a_folder_are_the_same(tmp_path: Path) -> None:
    there, here = (Setting(ROOM, 30, scratch=folder) for folder in (tmp_path, None))
    for fresh in (False, True):
        kept = there.explore(Brownian(), SMALL, fresh=fresh)
        np.testing.assert_array_equal(kept.views, here.explore(Brownian(), SMALL, fresh=fresh).views)
        assert not isinstance(kept.views, np.ndarray)
    assert len(list(tmp_path.iterdir())) == 2


def test_what_has_no_truth_is_refused() -> None:
    blind = Setting(ROOM, 20).explore(Brownian(), SMALL).without_truth()
    with pytest.raises(ValueError, match="has poses"):
        poses_of(blind)
