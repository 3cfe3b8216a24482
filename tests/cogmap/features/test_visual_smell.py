import numpy as np
import pytest
from sklearn.neighbors import KNeighborsRegressor

from arena import Arena, Brownian, Camera, explore
from cogmap.errors import CogmapError
from cogmap.features import VisualSmell

ROOM, CAMERA = Arena.load("furnished"), Camera.panoramic(120, 20)


def test_it_knows_place_and_not_heading() -> None:
    walk = explore(ROOM, Brownian(), CAMERA, views=1500, seed=0)
    fresh = explore(ROOM, Brownian(), CAMERA, views=200, seed=1)
    smell = VisualSmell()
    known, asked = smell.fit_transform(walk.views), smell.transform(fresh.views)
    assert known.shape == (1500, 4)
    assert known.dtype == np.float32
    assert known.min() > 0
    read = KNeighborsRegressor(4).fit(np.log(known), walk.poses[:, :2]).predict(np.log(asked))
    assert np.median(np.linalg.norm(read - fresh.poses[:, :2], axis=1)) < 0.15
    np.testing.assert_allclose(np.log(known).var(axis=0).sum(), 1, rtol=1e-3)
    np.testing.assert_array_equal(smell.transform(walk.views), known)


def test_a_turn_changes_it_by_a_hundredth_of_what_a_walk_does() -> None:
    walk = explore(ROOM, Brownian(), CAMERA, views=400, seed=0)
    smell = VisualSmell().fit(walk.views)
    turns = np.column_stack([np.full((50, 2), 0.3), np.linspace(-np.pi, np.pi, 50)])
    assert np.log(smell.transform(CAMERA.render(ROOM, turns))).var(axis=0).sum() < 0.01


def test_what_cannot_smell() -> None:
    walk = explore(ROOM, Brownian(), Camera.perspective(80, 60), views=200, seed=0)
    with pytest.raises(CogmapError, match="do not look all around"):
        VisualSmell().fit(walk.views)
    with pytest.raises(CogmapError, match="all alike"):
        VisualSmell().fit(np.full((30, 15, 90, 3), 9, np.uint8))
    with pytest.raises(CogmapError, match="components"):
        VisualSmell(0).fit(walk.views)
