"""The registry of experiments, and how to run one by its name."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from arena import Arena
from cogmap.atomic import result_folder
from cogmap.errors import CogmapError
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.controls.acuity import acuity
from cogmap.experiments.controls.cue_rotation import cue_rotation
from cogmap.experiments.controls.darkness import darkness
from cogmap.experiments.controls.development_and_lesions import development_and_lesions
from cogmap.experiments.controls.directionality import directionality
from cogmap.experiments.controls.fusion import fusion
from cogmap.experiments.controls.homology import homology
from cogmap.experiments.controls.odour_ablation import odour_ablation
from cogmap.experiments.controls.slow_feature_comparison import slow_feature_comparison
from cogmap.experiments.paper.brownian import brownian
from cogmap.experiments.paper.cyclic import cyclic
from cogmap.experiments.paper.distinguishability import distinguishability
from cogmap.experiments.paper.goals import goals
from cogmap.experiments.paper.localisation import localisation
from cogmap.experiments.paper.roadmap import roadmap
from cogmap.experiments.paper.rotation import rotation
from cogmap.experiments.paper.similarity import similarity
from cogmap.experiments.provenance import write_provenance
from cogmap.experiments.result import Result
from cogmap.inputs import checked_count

FEWEST = 200
"""Views that every experiment can do with, if not well."""


class Experiment(NamedTuple):
    """What is done, and where and how much of it unless told."""

    run: Callable[[Conditions], Result]
    room: str
    views: int
    any_room: bool = True
    """Whether it can be done in other rooms."""
    takes: tuple[str, ...] = ()
    """Which of `nose`, `motion`, `camera` and `map` may differ from its own."""
    extra_rooms: tuple[str, ...] = ()
    """Rooms that it visits as well, unless told where to take place."""


EXPERIMENTS = {
    "rotation": Experiment(rotation, "furnished", 5_000),
    "cyclic": Experiment(cyclic, "furnished", 4_000),
    "brownian": Experiment(brownian, "furnished", 17_000),
    "similarity": Experiment(similarity, "furnished", 5_000),
    "localisation": Experiment(localisation, "furnished", 17_000),
    "roadmap": Experiment(roadmap, "obstacles", 17_000),
    "distinguishability": Experiment(distinguishability, "white_rectangle", 17_000, any_room=False),
    "fusion": Experiment(fusion, "furnished", 17_000, takes=("nose", "motion", "camera", "map")),
    "slow_features": Experiment(
        slow_feature_comparison, "furnished", 17_000, takes=("nose", "camera", "map")
    ),
    "odour_ablation": Experiment(odour_ablation, "furnished", 17_000, takes=("motion", "camera", "map")),
    "acuity": Experiment(acuity, "furnished", 17_000, takes=("nose", "motion", "map")),
    "darkness": Experiment(darkness, "furnished", 17_000, takes=("nose", "motion", "camera", "map")),
    "cue_rotation": Experiment(cue_rotation, "open_field", 17_000, takes=("nose", "motion", "camera", "map")),
    "goals": Experiment(goals, "furnished", 17_000, takes=("camera",)),
    "directionality": Experiment(directionality, "furnished", 17_000, takes=("nose", "camera", "map")),
    "development": Experiment(development_and_lesions, "furnished", 17_000, takes=("nose", "camera", "map")),
    "homology": Experiment(
        homology,
        "open_field",
        17_000,
        takes=("nose", "camera", "map"),
        extra_rooms=("furnished", "pillar", "two_pillars", "l_shape"),
    ),
}


def experiment(
    name: str,
    out: Path | None = None,
    *,
    room: Arena | None = None,
    views: int | None = None,
    seed: int = 0,
    progress: bool = False,
    library: Path | None = None,
    **overrides: Any,
) -> Result:
    """Run an experiment by its name.

    Parameters
    ----------
    name
        One of `EXPERIMENTS`.
    out
        Folder for `metrics.json`, figures and the data behind them; an earlier result there is replaced at
        the end. None writes nothing.
    room
        Where; the room or rooms that the experiment was made for when None.
    views
        To learn from; as many as the figures of the paper need when None.
    seed
        Of walks, noise and all that is drawn.
    progress
        Whether to show progress on stderr.
    library
        Folder, which must exist, in which walks are looked for and left for other runs; None leaves none.
    overrides
        `nose`, `motion`, `camera`, or parameters of `CognitiveMap` as `map`, where the experiment takes them.

    Raises
    ------
    ArenaError, CogmapError
        For an unknown name, a room or counts that cannot work, something that the experiment does not take, a
        folder that holds something else.
    """
    if name not in EXPERIMENTS:
        raise CogmapError(f"there is no experiment {name!r}; choose one of {', '.join(EXPERIMENTS)}")
    chosen = EXPERIMENTS[name]
    if room is not None and not chosen.any_room:
        raise CogmapError(f"{name} takes place in rooms of its own, not in {room.name!r}; leave the room out")
    for what in overrides:
        if what not in chosen.takes:
            takes = ", ".join(chosen.takes) or "nothing but room, views and seed"
            raise CogmapError(f"{name} does not take another {what}; it takes {takes}")
    views = chosen.views if views is None else checked_count("views", views, FEWEST)
    names = (chosen.room, *chosen.extra_rooms)
    room, *extra_rooms = [Arena.load(name) for name in names] if room is None else [room]
    with (
        nullcontext() if out is None else result_folder(out) as folder,
        TemporaryDirectory(prefix="cogmap-") as scratch,
    ):
        found = chosen.run(
            Conditions(
                room,
                views,
                seed,
                progress,
                Path(scratch),
                library,
                extra_rooms=tuple(extra_rooms),
                **overrides,
            )
        )
        about = {
            "experiment": name,
            "arena": ", ".join(item.name for item in (room, *extra_rooms)),
            "views": views,
            "seed": seed,
        }
        result = Result({**about, **found.metrics}, found.tables, found.figures)
        if folder is not None:
            result.write(folder)
            where = room if chosen.any_room else None
            write_provenance(folder, ("experiment", name), where, views=views, seed=seed, **overrides)
    return result
