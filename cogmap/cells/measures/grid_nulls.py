"""Maps without a grid that are otherwise like those of a cell, its nulls: band noise, fields shuffled."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy import fft, ndimage, sparse

from cogmap.cells.measures.fields import PlaceFields
from cogmap.cells.rates.maps import RateMaps


def band_noise(maps: RateMaps, rng: np.random.Generator) -> Iterator[RateMaps]:
    """Draw noise in the bands of each cell, for ever: as much power at each wavelength, in any direction.

    Noise that is smooth on one scale has peaks at like distances, and some of it is hexagonal by chance.

    Source: Krupic, Burgess & O'Keefe 2012, Neural representations of location composed of spatially periodic
    bands, Science 337.
    """
    ny, nx = maps.visited.shape
    mean = maps.patterns.mean(axis=1)[:, None, None]
    spectrum = fft.fft2(np.where(maps.visited, maps.rates - mean, 0.0))
    wavelength = np.hypot(fft.fftfreq(ny)[:, None], fft.fftfreq(nx)) * max(ny, nx)
    band = np.rint(wavelength).astype(int).ravel()
    member = sparse.csr_array((np.ones(len(band)), (band, np.arange(len(band)))))
    power = (member @ np.abs(spectrum.reshape(len(maps), -1).T) ** 2).T / member.sum(axis=1)
    filters = np.sqrt(power)[:, band].reshape(spectrum.shape)
    while True:
        white = fft.fft2(rng.standard_normal((ny, nx)), norm="ortho")
        yield replace(maps, rates=np.where(maps.visited, fft.ifft2(filters * white).real, np.nan))


def shuffled_fields(maps: RateMaps, fields: PlaceFields, rng: np.random.Generator) -> Iterator[RateMaps]:
    """Move each field of each cell to a random place, for ever; where fields overlap the higher rate counts.

    A field takes with it the bins that are nearer to it than to others. Shifting spikes in time, the usual
    null, breaks up the fields too, and is passed by cells with several fields however they lie.

    Source: Barry & Burgess 2017, To be a Grid Cell: shuffling procedures for determining "gridness", bioRxiv
    230250.
    """
    ny, nx = maps.visited.shape
    places = np.argwhere(maps.visited)
    patches = [_patches(rates, labels) for rates, labels in zip(maps.rates, fields.labels, strict=True)]
    lowest = np.nanmin(maps.rates, axis=(1, 2))
    while True:
        moved = np.full(maps.rates.shape, lowest[:, None, None])
        for rates, mine in zip(moved, patches, strict=True):
            for patch, centre in mine:
                y, x = rng.choice(places) - centre
                below, left = max(-y, 0), max(-x, 0)
                inside = patch[below : ny - y, left : nx - x]
                here = rates[y + below :, x + left :][: inside.shape[0], : inside.shape[1]]
                np.fmax(here, inside, out=here)
        yield replace(maps, rates=np.where(maps.visited, moved, np.nan))


def _patches(rates: np.ndarray, labels: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Cut a map into its fields, each with the bins nearest to it: rates, NaN outside, and their peak."""
    nearest = ndimage.distance_transform_edt(labels == 0, return_distances=False, return_indices=True)
    owner = np.where(np.isnan(rates), 0, labels[tuple(nearest)])
    patches = []
    for label, box in enumerate(ndimage.find_objects(owner), start=1):
        patch = np.where(owner[box] == label, rates[box], np.nan)
        patches.append((patch, np.array(np.unravel_index(np.nanargmax(patch), patch.shape))))
    return patches
