"""Betti numbers of the free space of a room, and those that a map of it should have."""

from __future__ import annotations

import numpy as np
import shapely
from jaxtyping import Float

from arena import Arena, Disc
from cogmap.errors import CogmapError


def free_space_betti(
    room: Arena, *, body: Disc | None = None, start: Float[np.ndarray, "2"] | None = None
) -> tuple[int, int]:
    """Count the pieces and the holes of the free space of a room: its Betti numbers, exactly.

    Free is where the centre of a body can be: the platform without a margin of the body's radius along its
    border and around all that stands in the room. A passage that is too narrow for the body parts the space,
    and pillars between which it does not fit are one hole.

    Parameters
    ----------
    room
        The room.
    body
        Whose radius is taken off; a `Disc` unless told.
    start
        Where the body begins (m): only the piece that it can reach counts. All pieces when None.

    Raises
    ------
    CogmapError
        For a room without any free space.
    """
    region = room.free_space((body or Disc()).radius)
    if region.is_empty:
        raise CogmapError(f"arena {room.name!r} has no free space for this body; use a smaller one")
    pieces = shapely.get_parts(region)
    if start is not None:
        pieces = pieces[[int(shapely.distance(pieces, shapely.Point(start)).argmin())]]
    return len(pieces), int(shapely.get_num_interior_rings(pieces).sum())


def expected_betti(room: Arena, start: Float[np.ndarray, "2"]) -> dict[str, tuple[int, int, int]]:
    """Tell the pieces, loops and voids of all that a body knows that starts there (m), exactly.

    Its place is in a plane with h holes, [1, h, 0]; its heading on a circle, [1, 1, 0]; what it sees, alone
    or with what it smells, and what it recalls tell both, [1, 1 + h, h] by Künneth's formula. The keys are
    those of `cogmap.evaluation.homology_of_map.homologies`.
    """
    pieces, holes = free_space_betti(room, start=start)
    pose = (pieces, pieces + holes, holes)
    return {
        "view_manifold": pose,
        "seen_and_smelt": pose,
        "fused": pose,
        "place": (pieces, holes, 0),
        "heading": (1, 1, 0),
    }
