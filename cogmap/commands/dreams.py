"""Commands about what a map imagines."""

from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter

from arena import Recording
from cogmap.commands.common import Json, read_image, tell
from cogmap.imagination import Imagination
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.pages.film import check_film, write_film


def _dream(
    cmap: Path,
    recording: Path,
    /,
    *,
    start: Annotated[Path, Parameter(name="--from")],
    goal: Annotated[Path, Parameter(name="--to")],
    out: Path,
    as_json: Json = False,
) -> None:
    """Imagine the way from one view to another, as a film.

    The map's places are relaxed first, from the views of the recording, where they are not yet.

    Example: `cogmap dream map walk.zarr --from here.png --to there.png --out film.mp4`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn` wrote.
    recording
        Whose views are remembered: those that the map was learnt from.
    start, goal
        Images of the first and the last view, of the size the map was learnt from.
    out
        Film to write, .mp4, or a folder for PNGs; it must not exist.
    """
    check_film(out)
    grown, walk = CognitiveMap.load(cmap), Recording.open(recording).without_truth()
    ends = [read_image(path, grown.view_shape_) for path in (start, goal)]
    if grown.relaxed_places_ is None:
        grown.refine(walk.views)
    dream = Imagination(grown, memory=walk.views).film(*ends)
    write_film(dream.views, out)
    tell({"film": str(out), "frames": len(dream), "spread": float(np.median(dream.spread))}, as_json=as_json)
