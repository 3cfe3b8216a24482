from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import procrustes

from cogmap.cells.decoding.decoders import (
    HeadingFrame,
    MapFrame,
    decode_positions,
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    likeliest,
    place_map,
    position_errors,
)
from cogmap.errors import CogmapError

SOURCES = np.array([[-1.5, -1.0], [1.6, 0.9], [1.2, -1.1]])


def smell(positions: np.ndarray) -> np.ndarray:
    return -np.linalg.norm(positions[:, None] - SOURCES, axis=2).astype(np.float32)


def test_positions_agree_with_all_distances(wander: Callable) -> None:
    train, query = wander(300)[0], wander(50, seed=1)[0]
    far = np.linalg.norm(smell(query)[:, None].astype(float) - smell(train)[None].astype(float), axis=2)
    near = np.argsort(far, axis=1)[:, :4]
    weight = 1 / np.take_along_axis(far, near, axis=1)
    expected = np.sum(train[near] * weight[..., None], axis=1) / weight.sum(axis=1)[:, None]
    np.testing.assert_allclose(decode_positions(smell(train), train, smell(query)), expected, atol=1e-9)


def test_one_neighbour_is_the_nearest(wander: Callable) -> None:
    train, query = wander(3)[0], wander(50, seed=1)[0]
    nearest = np.linalg.norm(smell(query)[:, None] - smell(train), axis=2).argmin(axis=1)
    found = decode_positions(smell(train), train, smell(query), neighbours=1)
    np.testing.assert_allclose(found, train[nearest])
    with pytest.raises(CogmapError, match="3 training views; give at least 4"):
        decode_positions(smell(train), train, smell(query))


def test_a_training_view_decodes_to_itself(wander: Callable) -> None:
    train, _ = wander(100)
    np.testing.assert_allclose(position_errors(smell(train), train, smell(train), train), 0, atol=1e-9)


def test_errors_are_distances_and_shrink_with_more_views(wander: Callable) -> None:
    query, _ = wander(200, seed=1)
    few, many = wander(100)[0], wander(10_000)[0]
    decoded = decode_positions(smell(few), few, smell(query))
    coarse = position_errors(smell(few), few, smell(query), query)
    np.testing.assert_allclose(coarse, np.hypot(*(decoded - query).T))
    assert np.median(position_errors(smell(many), many, smell(query), query)) < 0.02 < np.median(coarse)


angles = st.floats(-np.pi, np.pi)


@settings(deadline=None)
@given(angles, st.booleans())
def test_rotation_and_mirror_are_recovered(rotation: float, mirror: bool) -> None:  # noqa: FBT001
    heading = np.random.default_rng(0).uniform(-np.pi, np.pi, 500)
    phase = (-1 if mirror else 1) * (heading - rotation)
    frame = fit_heading_frame(phase, heading)
    assert frame.mirror == mirror
    np.testing.assert_allclose(np.exp(1j * (frame.rotation - rotation)), 1, atol=1e-9)
    np.testing.assert_allclose(heading_errors(phase, heading, frame), 0, atol=1e-9)


def test_frame_is_the_best_of_a_search() -> None:
    rng = np.random.default_rng(0)
    heading = rng.uniform(-np.pi, np.pi, 400)
    phase = (1.3 - heading + rng.vonmises(0, 2, 400)).astype(np.float32)
    frame = fit_heading_frame(phase, heading)

    def closeness(candidate: HeadingFrame) -> float:
        return float(np.mean(np.cos(heading_errors(phase, heading, candidate))))

    grid = [HeadingFrame(r, m) for r in np.linspace(-np.pi, np.pi, 361) for m in (False, True)]
    best = max(grid, key=closeness)
    assert best.mirror is frame.mirror is True
    assert frame.rotation == pytest.approx(best.rotation, abs=np.deg2rad(0.5))
    assert closeness(frame) >= closeness(best)


def test_errors_are_signed_and_wrapped() -> None:
    errors = heading_errors(np.array([3.0, -3.0]), np.array([-3.0, 3.0]), HeadingFrame(0.0, mirror=False))
    np.testing.assert_allclose(errors, [6 - 2 * np.pi, 2 * np.pi - 6])


def test_likeliest_bin_of_each_view() -> None:
    scores = np.array([[0.1, 0.7, 0.2], [np.nan, -3.0, np.nan], [np.nan] * 3, [5.0, np.nan, -np.inf]])
    places = np.array([[0.0, 1], [2, 3], [4, 5]])
    expected = [[2, 3], [2, 3], [np.nan, np.nan], [0, 1]]
    np.testing.assert_array_equal(likeliest(scores, places), expected)
    np.testing.assert_array_equal(likeliest(scores, places[:, 0]), np.array(expected)[:, 0])


def test_bad_input_is_refused(wander: Callable) -> None:
    train, headings = wander(10)
    with pytest.raises(CogmapError, match="odours is not finite in 10"):
        decode_positions(smell(train), train, smell(train) * np.float32(np.nan))
    with pytest.raises(CogmapError, match="odours is not finite in 10"):
        decode_positions(smell(train) * np.float32(np.nan), train, smell(train))
    with pytest.raises(CogmapError, match="3 training views; give at least 4"):
        decode_positions(smell(train)[:3], train[:3], smell(train))
    with pytest.raises(CogmapError, match="centres is not finite"):
        likeliest(np.ones((2, 3)), np.full(3, np.nan))
    with pytest.raises(CogmapError, match="phase is not finite"):
        fit_heading_frame(headings * np.nan, headings)
    with pytest.raises(CogmapError, match="headings is not finite"):
        heading_errors(headings, headings * np.nan, HeadingFrame(0.0, mirror=False))


@settings(deadline=None)
@given(angles, st.floats(0.1, 10), st.complex_numbers(max_magnitude=10), st.booleans())
def test_a_similarity_is_recovered(turn: float, size: float, shift: complex, mirror: bool) -> None:  # noqa: FBT001
    true = np.random.default_rng(0).uniform(-2, 2, (300, 2))
    z = (true @ [1, 1j] - shift) / (size * np.exp(1j * turn))
    z = z.conj() if mirror else z
    mapped = np.stack([z.real, z.imag], axis=1)
    frame = fit_map_frame(mapped, true)
    assert frame.mirror == mirror
    np.testing.assert_allclose([frame.scale, frame.shift], [size * np.exp(1j * turn), shift], atol=1e-6)
    np.testing.assert_allclose(place_map(mapped, frame), true, atol=1e-6)


def test_the_similarity_is_that_of_procrustes() -> None:
    rng = np.random.default_rng(1)
    true = rng.uniform(-2, 2, (300, 2))
    mapped = true @ [[0.2, 0.5], [0.5, -0.2]] + rng.normal(0, 0.1, true.shape)
    *_, disparity = procrustes(true, mapped)
    left = place_map(mapped, fit_map_frame(mapped, true)) - true
    assert np.sum(left**2) / np.sum((true - true.mean(axis=0)) ** 2) == pytest.approx(disparity)


def test_bad_maps_are_refused() -> None:
    points = np.zeros((5, 2))
    assert fit_map_frame(points, points) == MapFrame(0, 0, mirror=False)
    with pytest.raises(CogmapError, match="mapped is not finite"):
        fit_map_frame(points * np.nan, points)
    with pytest.raises(CogmapError, match="positions is not finite"):
        fit_map_frame(points, points * np.nan)
    with pytest.raises(CogmapError, match="mapped is not finite"):
        place_map(points + np.inf, MapFrame(1, 0, mirror=False))
