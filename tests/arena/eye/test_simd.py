import numpy as np
import pytest
from numba import njit

from arena.eye import simd


@njit
def between(strip: np.ndarray, up: tuple, share: int, column: np.ndarray, rows: tuple) -> None:
    simd.add_between(strip, up[0], up[1], np.uint16(0), np.uint16(share), column, rows)


@njit
def over(strip: np.ndarray, up: tuple, more: int, column: np.ndarray, rows: tuple) -> None:
    simd.add_over(strip, up[0], up[1], np.uint16(more), None, column, rows)


@njit
def mixed(texels: np.ndarray, starts: tuple, shares: tuple, strip: np.ndarray, at: int) -> None:
    weights = np.uint16(shares[0]), np.uint16(shares[1])
    simd.set_texels(texels, starts, weights, strip, at)
    simd.add_texels(texels, starts, weights, strip, at)


@njit
def coloured(colour: tuple, share: int, column: np.ndarray, row: int) -> None:
    red, green, blue = colour
    simd.add_colour(np.uint16(red), np.uint16(green), np.uint16(blue), np.uint16(share), column, row)


def strip_and_column() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    return rng.integers(0, 20_000, (20, 4)).astype(np.uint16), rng.integers(0, 9, (12, 4)).astype(np.uint16)


@pytest.mark.parametrize("more", [0, 20_000, 65_535])
def test_a_row_is_the_sum_over_a_stretch_of_texels(more: int) -> None:
    strip, column = strip_and_column()
    at, step, wanted = 2.25, 1.0 + more / 65536, column.astype(float)
    over(strip.ravel(), (int(at * 2**32), int(step * 2**32)), more, column.reshape(-1), (9, 5))
    # Integrated finely, upwards from the lowest row.
    fine = (np.arange(0, 2**14) + 0.5) / 2**14
    for k in range(5):
        where = at + k * step + fine * step
        wanted[9 - k] += strip[where.astype(int)].mean(0) * step
    np.testing.assert_allclose(column, wanted, atol=6)


def test_a_row_lies_between_two_texels() -> None:
    strip, column = strip_and_column()
    wanted = column.astype(float)
    between(strip.ravel(), (int(3.5 * 2**32), int(0.375 * 2**32)), 32768, column.reshape(-1), (7, 4))
    for k in range(4):
        whole, rest = divmod(3.5 + 0.375 * k, 1)
        wanted[7 - k] += 0.5 * ((1 - rest) * strip[int(whole)] + rest * strip[int(whole) + 1])
    np.testing.assert_allclose(column, wanted, atol=4)


def test_texels_are_mixed_and_nothing_beside_them_is_written() -> None:
    texels = np.random.default_rng(0).integers(0, 256, 200).astype(np.uint8)
    strip = np.zeros(60, np.uint16)
    mixed(texels, (3, 101), (10_000, 20_000), strip, 8)
    wanted = 2 * 256 / 65536 * (10_000.0 * texels[3:35] + 20_000.0 * texels[101:133])
    np.testing.assert_allclose(strip[8:40], wanted, atol=4)
    assert not strip[:8].any()
    assert not strip[40:].any()


def test_a_share_of_a_colour() -> None:
    column = np.zeros(12, np.uint16)
    coloured((256 * 200, 256 * 100, 256 * 3), 16384, column, 1)
    np.testing.assert_allclose(column.reshape(3, 4)[1], (12800, 6400, 192, 0), atol=1)
    assert not column[[0, 1, 2, 3, 8, 9, 10, 11]].any()
