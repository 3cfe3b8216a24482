"""Novelty: whether views are of places that a refined map remembers."""

import numpy as np

from cogmap.errors import CogmapError
from cogmap.map.activity import Activity

KNOWN = 4.0
"""Novelty (`Activity.novelty`) up to which a view is of a place that is remembered."""


def check_known(seen: Activity, what: str) -> None:
    """Refuse views of nowhere that is remembered; a map that was not refined cannot tell.

    Parameters
    ----------
    seen
        What the map perceives.
    what
        How such a view is called in the sentence, as "goal".

    Raises
    ------
    CogmapError
        Which of them looks least like anything, and how unlike it is.
    """
    novelty = np.zeros(len(seen)) if seen.novelty is None else seen.novelty
    if novelty.max() > KNOWN:
        raise CogmapError(
            f"{what} {novelty.argmax()} is nothing that this map remembers: what looks most like it is "
            f"{novelty.max():.1f} times as unlike as usual; give a view from the room that was learnt"
        )
