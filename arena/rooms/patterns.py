"""Patterns that recipes of materials are made of: clouds, strips, palettes, stains and bricks."""

import numpy as np
from jaxtyping import Float, Int

from arena.rooms.materials import TEXEL, TILE

Tint = tuple[int, int, int]
"""Red, green and blue, 0..255."""


def cloud(rng: np.random.Generator, along: float, up: float) -> Float[np.ndarray, "along up"]:
    """Smooth periodic noise of unit variance with correlation lengths `along` and `up` (m)."""
    white = np.fft.rfft2(rng.standard_normal(TILE))
    kx, ky = np.fft.fftfreq(TILE[0], TEXEL)[:, None], np.fft.rfftfreq(TILE[1], TEXEL)[None]
    blur = np.exp(-2 * (np.pi * along * kx) ** 2 - 2 * (np.pi * up * ky) ** 2)
    field: np.ndarray = np.fft.irfft2(white * blur, TILE)
    field -= field.mean()
    field /= field.std()
    return field


def strips(rng: np.random.Generator, count: int, narrow: float, wide: float) -> Int[np.ndarray, "count"]:
    """Label `count` texels by strips of random widths between `narrow` and `wide` (m)."""
    edges = np.cumsum(rng.uniform(narrow, wide, int(count * TEXEL / narrow) + 2)) / TEXEL
    return np.searchsorted(edges, np.arange(count), side="right")


def palette(rng: np.random.Generator, colours: list[Tint], count: int, spread: float) -> np.ndarray:
    """Draw `count` of some colours, of a brightness that varies by `spread` (log)."""
    picked: np.ndarray = np.array(colours, float)[rng.integers(len(colours), size=count)]
    picked *= np.exp(spread * rng.standard_normal((count, 1)))
    return picked


def stained(
    rng: np.random.Generator, colour: np.ndarray, stain: Tint, depth: float, scale: float = 0.3
) -> np.ndarray:
    """Blend a coarse stain of correlation length `scale` (m) into a coloured tile."""
    amount = depth / (1 + np.exp(-2 * cloud(rng, scale, scale)))
    stained: np.ndarray = colour + amount[..., None] * (np.array(stain) - colour)
    return stained


def bricks(
    rng: np.random.Generator, size: tuple[float, float], colours: list[Tint], joint: Tint, spread: float
) -> np.ndarray:
    """Courses of bricks of `size` (m), every second one shifted by half a brick, with joints of 1 cm."""
    u, v = np.arange(TILE[0])[:, None], np.arange(TILE[1])[None]
    length, rise = (round(side / TEXEL) for side in size)
    course = v // rise
    shifted = u + (course % 2) * (length // 2)
    brick = shifted // length
    columns = TILE[0] // length + 2
    colour = palette(rng, colours, columns * (TILE[1] // rise + 1), spread)[course * columns + brick]
    seam = (shifted % length == 0) | (v % rise == 0)
    return np.where(seam[..., None], np.array(joint), colour)


def stone(rng: np.random.Generator, base: Tint, tint: tuple[float, float, float]) -> np.ndarray:
    """Grey veins on several scales over a base colour, with clouds of a tint."""
    veins = cloud(rng, 0.25, 0.2) + 0.6 * cloud(rng, 0.06, 0.05) + 0.35 * cloud(rng, 0.012, 0.012)
    colour: np.ndarray = np.array(base) + 34 * veins[..., None]
    colour += 22 * cloud(rng, 0.4, 0.3)[..., None] * np.array(tint)
    return colour
