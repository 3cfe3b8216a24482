"""A session of a map's cells: what they do on a walk, as an animal's are recorded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from arena import Recording
from cogmap.cells.sessions.recorded import Recorded, track_of
from cogmap.cells.sessions.session import Session, sampled
from cogmap.evaluation.populations import perceive, trust_report
from cogmap.map.cognitive_map import CognitiveMap


def map_session(
    recording: Recording,
    cmap: CognitiveMap,
    *,
    slowest: object = 0.0,
    between: Sequence[Any] | None = None,
) -> Session:
    """Let the cells of a map look at the views of a recording, and put their rates beside where it was.

    The populations are `place` and `heading`; a cell without a compass is silent. Only rates are known.
    The notes say whether the map is to be trusted, and why not.

    Parameters
    ----------
    recording
        With poses; the times must increase.
    cmap
        The map whose cells look.
    slowest, between
        As in `cogmap.cells.session`.

    Raises
    ------
    ArenaError, CogmapError
        Without poses, for times that do not increase, and when no view is left.
    """
    poses = recording.require("poses")
    seen = perceive(cmap, recording.views)
    rates = {name: np.nan_to_num(getattr(seen, name)).astype(float) for name in ("place", "heading")}
    kinds = [name for name, fired in rates.items() for _ in range(fired.shape[1])]
    recorded = Recorded(
        track_of(recording.times, poses[:, :2], poses[:, 2]),
        [str(index) for index in range(len(kinds))],
        kinds,
        rates=np.concatenate(list(rates.values()), axis=1),
        notes={"activity": "rates", **trust_report(cmap)},
    )
    return sampled(recorded, slowest=slowest, between=between)
