"""Surfaces: the vertical faces of a room, which the ray caster works on."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.rooms.parts import Solid, Wall


class Surfaces(NamedTuple):
    """Every vertical face of a room, walls first, then solid by solid, counter-clockwise seen from above."""

    start: Float[np.ndarray, "faces 2"]
    end: Float[np.ndarray, "faces 2"]
    height: Float[np.ndarray, "faces"]
    material: Int[np.ndarray, "faces"]
    """Index into `materials`."""
    offset: Float[np.ndarray, "faces"]
    """Where along its material (m) the face starts: the faces of a solid share one wrapping."""
    closed: Bool[np.ndarray, "faces"]
    """Whether the face bounds a solid, so that its back is never seen."""
    solid: Int[np.ndarray, "faces"]
    """Index of that solid among the boxes, pillars and blocks; −1 for a wall."""
    materials: tuple[str, ...]
    """The names of the materials in use, sorted; the floor's is among them if it has one."""


def surfaces(walls: Sequence[Wall], solids: Sequence[Solid], floor: Sequence[str]) -> Surfaces:
    """List the faces of walls and solids, and their materials with those of the floor."""
    chains = [np.array([wall.start, wall.end]) for wall in walls]
    chains += [np.vstack([solid.outline, solid.outline[:1]]) for solid in solids]
    made_of = [(wall.material,) for wall in walls] + [solid.sides for solid in solids]
    names = tuple(sorted({*floor, *(name for sides in made_of for name in sides)}))
    faces = [len(sides) for sides in made_of]
    lengths = [np.hypot(*np.diff(chain, axis=0).T) for chain in chains]
    solid = np.repeat(np.r_[np.full(len(walls), -1), np.arange(len(solids))], faces)
    return Surfaces(
        start=np.concatenate([chain[:-1] for chain in chains]),
        end=np.concatenate([chain[1:] for chain in chains]),
        height=np.repeat([part.height for part in (*walls, *solids)], faces),
        material=np.array([names.index(name) for sides in made_of for name in sides]),
        offset=np.concatenate([np.cumsum(length) - length for length in lengths]),
        closed=solid >= 0,
        solid=solid,
        materials=names,
    )
