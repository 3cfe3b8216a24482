from itertools import pairwise

import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.features import strips as module
from cogmap.features.strips import FREQUENCIES, strips

VIEWS = np.random.default_rng(0).integers(0, 256, (7, 20, 64, 3), dtype=np.uint8)


def series(picture: np.ndarray) -> np.ndarray:
    """The coefficients written out as sums over the columns."""
    columns = picture.shape[-1]
    waves = np.exp(-2j * np.pi * np.outer(np.arange(columns), np.arange(FREQUENCIES)) / columns)
    return picture @ waves / columns


def test_series_are_those_of_the_mean_rows() -> None:
    rows = VIEWS.reshape(7, 10, 2, 64, 3).mean(axis=2)
    found = strips(VIEWS)
    np.testing.assert_allclose(found.grey, series(rows.mean(axis=3)), atol=1e-3)
    magnitudes = np.abs(series(np.moveaxis(rows, 3, 2))).transpose(0, 1, 3, 2)
    np.testing.assert_allclose(found.turn_invariant, magnitudes.reshape(7, -1), atol=1e-3)


def test_a_turn_of_whole_columns_multiplies_frequencies_and_changes_no_magnitude() -> None:
    # Turned to the left by Δ, what was in the middle is to the right of it.
    turn_invariant, turned = strips(VIEWS), strips(np.roll(VIEWS, 5, axis=2))
    phase = np.exp(-1j * np.arange(FREQUENCIES) * 5 * 2 * np.pi / 64)
    np.testing.assert_allclose(turned.grey, turn_invariant.grey * phase, atol=1e-3)
    np.testing.assert_allclose(turned.turn_invariant, turn_invariant.turn_invariant, atol=1e-3)


@pytest.mark.parametrize(("height", "rows"), [(1, 1), (6, 6), (13, 10)])
def test_rows_are_ten_at_most_and_of_any_height(height: int, rows: int) -> None:
    flat = np.repeat(np.arange(height, dtype=np.uint8)[None, :, None, None], 62, axis=2).repeat(3, axis=3)
    found = strips(flat).grey[0, :, 0].real
    edges = np.linspace(0, height, rows + 1).astype(int)
    np.testing.assert_allclose(found, [np.arange(a, b).mean() for a, b in pairwise(edges)])


def test_blocks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = strips(VIEWS)
    monkeypatch.setattr(module, "BLOCK", 3)
    for one, same in zip(strips(VIEWS), whole, strict=True):
        np.testing.assert_array_equal(one, same)


def test_narrow_panoramas_are_refused() -> None:
    with pytest.raises(CogmapError, match="61 columns wide; give at least 62"):
        strips(VIEWS[:, :, :61])
