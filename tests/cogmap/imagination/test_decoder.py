from dataclasses import replace

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression

from cogmap import CogmapError, Imagination
from cogmap.evaluation.image_quality import psnr
from cogmap.imagination import decoder as module
from cogmap.imagination.alignment import coarse
from cogmap.imagination.decoder import ChartDecoder
from tests.cogmap.conftest import Refined

SHAPE = (15, 90, 3)


def blank(count: int = 1) -> ChartDecoder:
    """Charts in a row of one code, which face where they lie."""
    row = np.arange(count, dtype=np.float32)
    values = np.zeros((count, 4, 15 * 90 * 3), np.float32)
    return ChartDecoder(10 * row[:, None], 2 * row + 3, SHAPE, np.zeros((count, 4, 4)), values)


def test_a_chart_regresses_pixels_on_pose(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "RIDGE", 0.0)
    rng = np.random.default_rng(0)
    views = rng.integers(0, 256, (30, *SHAPE), np.uint8)
    poses = np.column_stack([rng.normal([40, -7], 1, (30, 2)), 3 + rng.normal(0, 0.1, 30)])
    wrapped = poses - 2 * np.pi * np.array([0, 0, 1]) * (poses[:, 2:] > np.pi)
    decoder = blank()
    decoder._add(np.zeros((30, 1), np.float32), views, wrapped)
    asked = np.array([[40.5, -7.5, 3.2], [39.5, -6.0, 3.1]])
    expected = LinearRegression().fit(poses, [coarse(view) for view in views]).predict(asked)
    found = [painted.view.ravel() for painted in decoder.paint(asked - [[0, 0, 2 * np.pi], [0, 0, 0]])]
    np.testing.assert_allclose(found, expected, atol=0.05)


def test_what_two_learnt_is_added() -> None:
    rng = np.random.default_rng(1)
    views, codes = (
        rng.integers(0, 256, (20, *SHAPE), np.uint8),
        rng.uniform(0, 20, (20, 1)).astype(np.float32),
    )
    poses = rng.normal(size=(20, 3))
    one, other, both = blank(3), blank(3), blank(3)
    one._add(codes[:8], views[:8], poses[:8])
    other._add(codes[8:], views[8:], poses[8:])
    both._add(codes, views, poses)
    merged = one.merge(other)
    np.testing.assert_allclose(merged.gram, both.gram)
    np.testing.assert_allclose(merged.cross, both.cross, rtol=1e-4, atol=1e-2)
    with pytest.raises(CogmapError, match="different maps or cameras"):
        both.merge(blank(2))


def test_charts_that_disagree_are_mixed_by_nearness(monkeypatch: pytest.MonkeyPatch) -> None:
    decoder = blank(2)
    views = np.full((40, *SHAPE), 100, np.uint8)
    views[20:] = 140
    rng = np.random.default_rng(2)
    poses = rng.normal(0, 0.1, (40, 3)) + np.repeat([[0, 0, 3], [0.3, 0, 3.1]], 20, axis=0)
    decoder.phases[:] = 3
    with monkeypatch.context() as patch:
        patch.setattr(module, "WINNERS", 1)
        decoder._add(np.repeat([[0.0], [10.0]], 20, axis=0).astype(np.float32), views, poses)
    near, between, far = decoder.paint(np.array([[-0.2, 0, 2.9], [0.15, 0, 3.05], [9, 0, 3.1]]))
    assert near.view.mean() < between.view.mean() < far.view.mean()
    assert far.view.mean() == pytest.approx(140, abs=0.1)
    assert between.spread.mean() > 10 > far.spread.mean()


def test_a_map_decodes_better_than_the_mean_view(refined: Refined) -> None:
    views = np.asarray(refined.walk.views[:600])
    dream = Imagination(refined.cmap, memory=views)
    position, phase = dream.perceive(views[::60])
    made = dream.at(position, phase, method="decoder")
    mean = np.broadcast_to(views.mean(axis=0).astype(np.uint8), made.views.shape)
    assert np.median(psnr(made.views, views[::60])) > np.median(psnr(mean, views[::60])) + 5
    assert (made.spread > 0).all()
    assert made.distance == pytest.approx(0, abs=1e-6)
    again = replace(dream.decoder, view_shape=(30, 180, 3))
    with pytest.raises(CogmapError, match="merge those of one map"):
        dream.decoder.merge(again)
