import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arena.materials import MATERIALS, TEXEL, TILE, texture, weave

PLAIN = {"white", "blue"}
NAMES = tuple(sorted(MATERIALS))


@pytest.mark.parametrize("name", NAMES)
def test_a_texture_is_a_read_only_tile(name: str) -> None:
    tile = texture(name)
    assert tile.shape == (1024, 128, 3) == (*TILE, 3)
    assert tile.dtype == np.uint8
    with pytest.raises(ValueError, match="read-only"):
        tile[0, 0, 0] = 1


def test_a_texture_depends_on_its_name_alone() -> None:
    before = {name: texture(name).copy() for name in NAMES}
    texture.cache_clear()
    for name in reversed(NAMES):
        np.testing.assert_array_equal(texture(name), before[name])
    script = "from arena.materials import texture; print(int(texture('brick').astype(int).sum()))"
    fresh = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert int(fresh.stdout) == before["brick"].astype(int).sum()


def test_no_two_materials_look_alike() -> None:
    for i, name in enumerate(NAMES):
        for other in NAMES[:i]:
            difference = np.abs(texture(name).astype(int) - texture(other)).mean()
            assert difference > 10, (name, other)


@pytest.mark.parametrize("name", sorted(PLAIN))
def test_plain_materials_are_of_one_colour(name: str) -> None:
    assert np.ptp(texture(name), axis=(0, 1)).tolist() == [0, 0, 0]


@pytest.mark.parametrize("name", sorted(set(NAMES) - PLAIN))
def test_other_materials_vary_on_coarse_and_fine_scales(name: str) -> None:
    tile, block = texture(name).astype(float), round(0.32 / TEXEL)
    coarse = tile.reshape(TILE[0] // block, block, TILE[1] // block, block, 3).mean(axis=(1, 3))
    assert coarse.std(axis=(0, 1)).max() > 8
    assert max(np.diff(tile, axis=axis).std() for axis in (0, 1)) > 4


@pytest.mark.parametrize("name", sorted(set(NAMES) - PLAIN))
def test_hardly_a_texel_is_clipped(name: str) -> None:
    assert np.isin(texture(name), (0, 255)).mean() < 0.03


@given(
    material=st.integers(0, len(NAMES) - 1),
    u=st.tuples(st.integers(0, 3000), st.integers(1, 2500)),
    v=st.tuples(st.integers(0, 127), st.integers(1, 128)),
)
@settings(max_examples=100, deadline=None)
def test_running_sums_give_the_mean_of_any_stretch_even_across_the_seam(
    material: int, u: tuple[int, int], v: tuple[int, int]
) -> None:
    (u0, along), (v0, up) = u, v
    v1 = min(v0 + up, TILE[1])
    sums, mean, _ = weave(NAMES)
    sums, mean = sums[material].reshape(TILE[0] + 1, -1, 3), mean[material].reshape(-1, 3)

    def below(row: int) -> np.ndarray:
        return mean[row] + (sums[(u0 + along) % TILE[0], row] - sums[u0 % TILE[0], row]) / along

    columns = np.arange(u0, u0 + along) % TILE[0]
    wanted = texture(NAMES[material])[columns, v0:v1].mean(axis=(0, 1))
    np.testing.assert_allclose((below(v1) - below(v0)) / (v1 - v0), wanted, atol=0.1)


def test_running_sums_close_upon_themselves() -> None:
    sums, mean, lid = weave(NAMES)
    assert sums.shape == (len(NAMES), 1025, 129 * 3)
    assert mean.shape == (len(NAMES), 129 * 3)
    np.testing.assert_allclose(sums[:, -1], 0, atol=0.5)
    assert (sums[:, 0] == 0).all()
    tiles = np.stack([texture(name) for name in NAMES])
    np.testing.assert_allclose(mean[:, -3:], 128 * tiles.mean(axis=(1, 2)), rtol=1e-6)
    np.testing.assert_allclose(lid, 0.8 * tiles.mean(axis=(1, 2)), rtol=1e-6)


def test_weaves_of_fewer_materials_are_rows_of_the_whole() -> None:
    some = weave(("brick", "oak"))
    for part, whole in zip(some, weave(NAMES), strict=True):
        np.testing.assert_array_equal(part, whole[[NAMES.index("brick"), NAMES.index("oak")]])
