import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.imagination.places import VISIT, RememberedPlaces


def _places(position: np.ndarray) -> RememberedPlaces:
    return RememberedPlaces(None, position, np.zeros(len(position)))


def test_what_is_linear_over_places_is_right_at_the_target() -> None:
    position = np.random.default_rng(0).uniform(size=(400, 2))
    targets = np.random.default_rng(1).uniform(0.2, 0.8, (50, 2))
    found = _places(position).sources(targets, 6)
    np.testing.assert_allclose(found.affine.sum(axis=1), 1, atol=1e-6)
    read = np.einsum("ts,tsc->tc", found.affine, position[found.indices])
    nearest = np.linalg.norm(position[found.indices[:, 0]] - targets, axis=1)
    assert np.median(np.linalg.norm(read - targets, axis=1)) < 0.02 * np.median(nearest)
    assert (np.diff(found.distances, axis=1) >= 0).all()
    assert (found.near > 0).all()
    assert (np.diff(found.near, axis=1) <= 1e-6).all()


def test_views_of_one_spot_are_one_source() -> None:
    spot = np.tile([0.1, 0.0], (30, 1)) + 1e-4 * np.random.default_rng(0).normal(size=(30, 2))
    others = np.array([[-0.3, 0.0], [0.0, 0.4], [0.0, -0.5]])
    found = _places(np.concatenate([spot, others])).sources(np.zeros((1, 2)), 4)
    assert (found.indices[0] >= 30).sum() == 3


def test_what_is_missing_has_no_weight() -> None:
    found = _places(np.array([[0.0, 0.0], [1.0, 0.0]])).sources(np.array([[0.4, 0.0]]), 4)
    np.testing.assert_array_equal(np.isfinite(found.distances[0]), [True, True, False, False])
    assert not found.affine[0, 2:].any()
    assert not found.near[0, 2:].any()


def test_the_visit_of_an_imagined_view_is_left_out() -> None:
    position = np.random.default_rng(0).uniform(size=(1000, 2))
    asked = np.arange(0, 1000, 50)
    found = _places(position).sources(position[asked], 5, without=asked)
    assert (np.abs(found.indices - asked[:, None]) > VISIT).all()


def test_the_second_source_comes_first_and_the_first_stands_alone() -> None:
    found = _places(np.random.default_rng(0).uniform(size=(90, 2))).sources(np.full((2, 2), 0.5), 4)
    for before, after in zip(found, found.second_first(), strict=True):
        np.testing.assert_array_equal(after, before[:, [1, 0, 2, 3]])
    alone = found.alone()
    np.testing.assert_array_equal(alone.indices, found.indices[:, :1])
    assert (alone.near == 1).all()
    assert (alone.affine == 1).all()


def test_turning_on_the_spot_brings_places_no_closer() -> None:
    rng = np.random.default_rng(0)
    visited = rng.uniform(size=(1000, 2))
    turned = np.repeat(visited, 4, axis=0) + 1e-5 * rng.normal(size=(4000, 2))
    once, again = _places(visited).spacing, _places(turned).spacing
    assert 0.8 < again / once < 1.25
    # 1 / (2 √density) from a random place to the nearest of many
    assert 0.8 < once / (0.5 / np.sqrt(1000)) < 1.25


def test_a_single_visit_tells_no_spacing() -> None:
    with pytest.raises(CogmapError, match="90 views do not tell what is usual; remember at least 400"):
        _ = _places(np.random.default_rng(0).uniform(size=(90, 2))).spacing
