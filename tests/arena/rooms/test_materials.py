import subprocess
import sys

import numpy as np
import pytest

from arena.rooms.materials import LEVELS, TEXEL, TILE, materials, mean_colour, mip_maps, texture

PLAIN = {"white", "blue"}
NAMES = tuple(materials())


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
    script = "from arena.rooms.materials import texture; print(int(texture('brick').astype(int).sum()))"
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


@pytest.mark.parametrize("level", [(0, 0), (3, 0), (0, 5), (4, 2), (10, 7)])
def test_texels_of_a_level_are_means_of_the_tile(level: tuple[int, int]) -> None:
    texels, level_starts = mip_maps(NAMES)
    (i, j), (long, high) = level, (TILE[0] >> level[0], TILE[1] >> level[1])
    start = level_starts[level]
    for material, name in enumerate(NAMES):
        found = texels[material, start : start + 4 * long * high].reshape(long, high, 4)
        wanted = texture(name).reshape(long, 1 << i, high, 1 << j, 3).mean(axis=(1, 3))
        np.testing.assert_allclose(found[..., :3], wanted, atol=0.51)
        assert (found[..., 3] == 0).all()


def test_levels_lie_end_to_end() -> None:
    texels, level_starts = mip_maps(NAMES)
    sizes = [4 * (TILE[0] >> i) * (TILE[1] >> j) for i, j in np.ndindex(LEVELS)]
    np.testing.assert_array_equal(np.diff(level_starts.ravel()), sizes[:-1])
    assert texels.shape == (len(NAMES), sum(sizes))


def test_weaves_of_fewer_materials_are_rows_of_the_whole() -> None:
    some, every = mip_maps(("brick", "oak")), mip_maps(NAMES)
    np.testing.assert_array_equal(some.texels, every.texels[[NAMES.index("brick"), NAMES.index("oak")]])
    np.testing.assert_array_equal(some.level_starts, every.level_starts)


def test_the_tint_is_the_mean_colour() -> None:
    np.testing.assert_allclose(mean_colour("oak"), texture("oak").mean(axis=(0, 1)), rtol=1e-6)
