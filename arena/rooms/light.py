"""Light: how bright it makes a surface."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from jaxtyping import Float
from pydantic import Field

from arena.rooms.parts import Angle, FrozenModel


class Light(FrozenModel):
    r"""A far lamp over ambient light; it casts no shadows.

    .. math:: (1 - s) + s \max(0, n \cdot l)

    is the brightness of a surface of unit normal n, with s the strength and l the direction to the lamp.
    """

    azimuth_deg: Angle
    """Where the light comes from, counter-clockwise from +x."""
    elevation_deg: Annotated[float, Field(strict=True, gt=0, lt=90)]
    """How high the lamp stands above the horizon."""
    strength: Annotated[float, Field(strict=True, ge=0, le=1)] = 0.5
    """The lamp's share of the light; the rest is ambient."""

    @property
    def direction(self) -> Float[np.ndarray, "3"]:
        """The unit vector from a surface to the lamp."""
        azimuth, elevation = np.deg2rad([self.azimuth_deg, self.elevation_deg])
        level = np.cos(elevation)
        return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])

    def brightness(self, normals: Float[np.ndarray, "faces 3"]) -> Float[np.ndarray, " faces"]:
        """Give the share of its colour, in [0, 1], that a surface of each unit normal shows."""
        # no matrix product, which is rounded as the processor likes
        towards = (normals * self.direction).sum(axis=1)
        lit: np.ndarray = (1 - self.strength) + self.strength * np.maximum(0, towards)
        return lit
