from collections.abc import Callable

import numpy as np
import pytest
from neurospatial.encoding.grid import grid_scale, grid_score

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.measures.gridness import gridness, lattice
from cogmap.cells.rates.maps import rate_maps


@pytest.fixture
def positions(wander: Callable) -> np.ndarray:
    return wander(12_000)[0]


def scored(rates: list[np.ndarray], positions: np.ndarray) -> np.ndarray:
    return autocorrelograms(rate_maps(np.stack(rates, axis=1), positions, smoothing=0.08))


@pytest.mark.parametrize("spacing", [0.6, 0.85, 1.1])
def test_ideal_grids_have_their_spacing_and_orientation(
    positions: np.ndarray, hexagonal: Callable, spacing: float
) -> None:
    turns = np.deg2rad(np.linspace(-29, 29, 9))
    phases = np.random.default_rng(0).uniform(-1, 1, (9, 2))
    cells = [hexagonal(positions, spacing, turn, phase) for turn, phase in zip(turns, phases, strict=True)]
    correlograms = scored(cells, positions)
    assert gridness(correlograms).min() > 1
    found = lattice(correlograms)
    np.testing.assert_allclose(found.spacing * 0.1, spacing, rtol=0.02)
    assert np.abs(np.angle(np.exp(6j * (found.orientation - turns)))).max() / 6 < np.deg2rad(1.5)


def test_a_rim_of_the_central_peak_is_no_ring() -> None:
    y, x = np.mgrid[-30:31, -30:31]
    radius, direction = np.hypot(y, x), np.arctan2(y, x)
    # six-fold next to the peak and square from twice its radius on
    rim = np.where(radius < 7, 0.1 * np.cos(6 * direction), np.cos(4 * direction))
    (score,) = gridness(np.where(radius < 5, 1 - radius / 5, rim)[None])
    assert score < -1


def test_what_is_not_hexagonal_scores_low(positions: np.ndarray) -> None:
    waves = 2 * np.pi / 0.8 * positions
    far = np.hypot(*positions.T)
    square = 2 + np.cos(waves).sum(axis=1)
    stripes = 1 + np.cos(waves[:, 0] * np.cos(0.4) + waves[:, 1] * np.sin(0.4))
    blob, ring = np.exp(-(far**2) / 0.2), np.exp(-((far - 0.7) ** 2) / 0.06)
    noise = np.random.default_rng(0).poisson(5, len(positions))
    scores = gridness(scored([square, stripes, blob, ring, noise.astype(float)], positions))
    assert scores[0] < -0.5
    assert scores[1:].max() < 0.6


def test_agrees_with_neurospatial_at_its_best_ring(positions: np.ndarray, hexagonal: Callable) -> None:
    rng = np.random.default_rng(1)
    noise = rng.normal(1.5, 0.5, (2, len(positions))).clip(0)
    noisy = [hexagonal(positions, 0.9, turn) + noise[k] for k, turn in enumerate((0.1, 0.5))]
    correlograms = scored(noisy, positions)
    for correlogram, score, bins in zip(
        correlograms, gridness(correlograms), lattice(correlograms).spacing, strict=True
    ):
        known = np.nan_to_num(correlogram)
        half = min(known.shape) / 2
        # The central peak of a sum of waves ends at a third of the spacing.
        trusted = max(
            grid_score(known, inner_radius_fraction=bins / 3 / half, outer_radius_fraction=outer / half)
            for outer in np.arange(bins, 0.8 * half)
        )
        assert score == pytest.approx(trusted, abs=0.1)
        middle = known[10:-10, 20:-20]
        assert bins == pytest.approx(grid_scale(middle, 1.0, min_distance=3), rel=0.06)


def test_constant_maps_and_single_peaks_have_no_lattice(positions: np.ndarray, bump: Callable) -> None:
    correlograms = scored([np.ones(len(positions)), bump(positions)], positions)
    assert np.isnan(gridness(correlograms)[0])
    assert np.isnan(lattice(correlograms).spacing).all()
    assert np.isnan(lattice(correlograms).orientation).all()
