from collections.abc import Callable
from dataclasses import replace
from itertools import repeat

import numpy as np
import pandas as pd
import pytest

from cogmap.cells.measures import grid
from cogmap.cells.measures.grid import grid_statistics
from cogmap.cells.rates.maps import rate_maps
from cogmap.errors import CogmapError


def test_only_grids_pass(wander: Callable, hexagonal: Callable) -> None:
    positions, _ = wander(8000)
    rng = np.random.default_rng(0)
    far = np.hypot(*(positions - 0.1).T)
    waves = 2 * np.pi / 0.8 * positions
    apart = np.linalg.norm(positions[:, None] - rng.uniform([-1.8, -1.3], [1.8, 1.3], (8, 2)), axis=2)
    rates = {
        "grid": hexagonal(positions, 0.7, 0.2),
        "dense": 0.5 + hexagonal(positions, 0.7, 0.4, (0.1, 0.3)),
        "blob and ring": np.exp(-(far**2) / 0.08) + 0.7 * np.exp(-((far - 0.9) ** 2) / 0.08),
        "square": 2 + np.cos(waves).sum(axis=1),
        "scattered": np.exp(-(apart**2) / 0.06).sum(axis=1),
        "noise": rng.poisson(2, len(positions)).astype(float),
        "silent": np.zeros(len(positions)),
    }
    maps = rate_maps(np.stack(list(rates.values()), axis=1), positions, smoothing=0.08)
    table = grid_statistics(maps, shuffles=20).set_axis(list(rates))
    assert table.index[table["passing"]].tolist() == ["grid", "dense"]
    grids = table.loc[["grid", "dense"]]
    assert grids["gridness"].min() > 1
    np.testing.assert_allclose(grids["spacing_m"], 0.7, rtol=0.02)
    np.testing.assert_allclose(grids["orientation_rad"], [0.2, 0.4], atol=0.02)
    # 3.6×2.6 m over the area of a cell of the lattice, without those that the walls cut small.
    assert grids["fields"].between(14, 26).all()
    assert table.loc["blob and ring", "fields"] <= 2
    assert table.loc["silent"].drop(["passing", "fields"]).isna().all()
    chances = table[["band_noise_p", "field_shuffle_p"]]
    np.testing.assert_allclose(chances.loc["grid"], 1 / 21)
    assert chances.loc["square"].min() > 0.9
    assert chances.loc["noise"].max() > 0.05


@pytest.mark.parametrize("null", ["band_noise", "shuffled_fields"])
def test_what_one_of_the_nulls_reaches_does_not_pass(
    wander: Callable, hexagonal: Callable, monkeypatch: pytest.MonkeyPatch, null: str
) -> None:
    positions, _ = wander(3000)
    pure = rate_maps(hexagonal(positions, 0.8)[:, None], positions, smoothing=0.08)
    noise = np.random.default_rng(0).gamma(1, 0.05, pure.rates.shape)
    cell = replace(pure, rates=pure.rates + noise)
    assert grid_statistics(cell, shuffles=20)["passing"].all()
    monkeypatch.setattr(grid, null, lambda *_: repeat(pure))
    assert not grid_statistics(cell, shuffles=20)["passing"].any()


def test_three_fields_are_no_grid_however_regular(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(3000)
    corners = 0.46 * np.exp(2j * np.pi * np.arange(3) / 3)
    rates = sum(bump(positions, (corner.real, corner.imag), 0.15) for corner in corners)
    maps = rate_maps(rates[:, None], positions, smoothing=0.08)
    table = grid_statistics(maps, shuffles=20)
    assert table["fields"][0] == 3
    assert table[["band_noise_p", "field_shuffle_p"]].max(axis=None) < 0.05
    assert not table["passing"][0]
    assert grid_statistics(maps, shuffles=20, least_fields=3)["passing"][0]


def test_same_seed_same_table_and_no_shuffle_is_refused(wander: Callable, hexagonal: Callable) -> None:
    positions, _ = wander(3000)
    maps = rate_maps(hexagonal(positions, 1.0)[:, None], positions)
    pd.testing.assert_frame_equal(grid_statistics(maps, shuffles=3), grid_statistics(maps, shuffles=3))
    with pytest.raises(CogmapError, match="shuffles is 0"):
        grid_statistics(maps, shuffles=0)
