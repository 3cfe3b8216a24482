"""Eyes of a map: which retina suits its views, told or found."""

import warnings
from collections.abc import Mapping
from typing import Any

from cogmap.errors import OpenSeamWarning
from cogmap.inputs import check_choice

RETINAS: Mapping[str, Mapping[str, Any]] = {
    "panorama": {},
    "perspective": {"wrap": False, "columns": 45, "acuity": 5.0, "surround": 15.0, "pool": 4.0},
}
"""What `neurons.layers.retina.Retina` is told for each eye."""


def found_eye(told: str | None, views: Any) -> str:
    """Take the eye that is told, or tell it from views: "panorama" unless their seam is clearly open.

    Raises
    ------
    CogmapError
        For an eye that is none of these.
    """
    # what compares features of views is heavy, and who perceives by a saved map waits for none of it
    from cogmap.features.seam import seam_is_open  # noqa: PLC0415

    open_seam = seam_is_open(views)
    if told is None:
        return "perspective" if open_seam else "panorama"
    check_choice("eye", told, tuple(RETINAS))
    if told == "panorama" and open_seam:
        warnings.warn(
            "views are said to be panoramas, but their last column does not continue in the first; "
            "look at one, or give eye='perspective'",
            OpenSeamWarning,
            stacklevel=3,
        )
    return told
