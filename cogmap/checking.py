"""Check whether what was written is still what it was: recordings, maps, results, sweeps, rooms."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from arena import Arena, ArenaError, Recording
from arena.recordings import storage
from arena.recordings.begun import BEGUN, unfinished
from arena.recordings.rescue import examine
from cogmap.atomic import METRICS, user_path
from cogmap.control import MotorModel
from cogmap.coordinates import GeneralisedCoordinates
from cogmap.digests import SUMS, compare_sums
from cogmap.errors import CogmapError
from cogmap.experiments.provenance import PROVENANCE
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.even_memory import EvenMemory
from cogmap.map.storage import VERSIONS, Kind, read_state
from cogmap.sweeps import Plan
from cogmap.sweeps.ledger import LAYOUT, MARK, all_of, read_mark, read_record

_LOADERS: dict[Kind, Callable[[Path], object]] = {
    "map": CognitiveMap.load,
    "memory": EvenMemory.load,
    "motor": MotorModel.load,
    "coordinates": GeneralisedCoordinates.load,
}


@dataclass(frozen=True)
class Checked:
    """What a file or folder is, and what of it is whole."""

    path: Path
    kind: str
    """recording, map, memory, motor, coordinates, result, sweep, plan or room."""
    version: int | None = None
    """Of its layout; None for what has none, and where it cannot be told."""
    parts: dict[str, str] = field(default_factory=dict)
    """What is whole, by its name."""
    damage: tuple[str, ...] = ()
    """What is not, each in a clause."""
    advice: str = ""
    """What can be saved, and how."""

    @property
    def whole(self) -> bool:
        """Whether all of it is what was written."""
        return not self.damage

    @property
    def sentence(self) -> str:
        """What is damaged and what can be saved; empty when it is whole."""
        said = "; ".join(filter(None, (*self.damage, self.advice)))
        return said and (said if str(self.path) in said else f"{self.path} is damaged: {said}")


def check(path: str | Path) -> Checked:
    """Read all of a file or folder of ours, every image and every weight, and compare it with its checksums.

    Parameters
    ----------
    path
        A recording, what a `CognitiveMap`, `EvenMemory`, `MotorModel` or `GeneralisedCoordinates` has saved,
        the result of an experiment, a sweep, or a TOML file, of a room or a plan: these have no checksums.

    Raises
    ------
    CogmapError
        When there is nothing, or nothing of ours.
    """
    path = user_path(path)
    if path.suffix == ".toml" and path.is_file():
        return _toml(path)
    checks: dict[str, Callable[[Path], Checked]] = {
        "zarr.json": _recording,
        BEGUN: _recording,
        **{f"{kind}.json": partial(_state, kind=kind) for kind in _LOADERS},
        METRICS: _result,
        MARK: _sweep,
    }
    for mark, checked in checks.items():
        if (path / mark).is_file():
            return checked(path)
    if not path.exists():
        raise CogmapError(f"there is nothing at {path}; check the path")
    raise CogmapError(
        f"{path} is nothing of ours: a folder of ours has one of {', '.join(checks)}, a file ends in .toml"
    )


def _recording(path: Path) -> Checked:
    try:
        there = unfinished(path)
        if there is not None:
            said = f"{path} is half-written: {there} views are there"
            advice = "the same `import` command goes on where it stopped"
            return Checked(path, "recording", None, {"views": f"{there}"}, (said,), advice)
        found = examine(path)
        if not found.damage and not found.unwritten:
            Recording.open(path)
    except ArenaError as error:
        return Checked(path, "recording", damage=(str(error),))
    count, whole = len(found.whole), int(found.whole.sum())
    parts = {"views": f"{whole} of {count}"} | {
        name: "×".join(map(str, values.shape)) for name, values in found.columns.items()
    }
    damage, advice = found.damage, ""
    if damage and whole and "times" in found.columns:
        advice = (
            f"{whole} of {count} views are whole, and `--rescue` saves them; or remove files of views that "
            "are damaged, and the same command as before makes them again"
        )
    elif damage:
        advice = "record it again"
    elif found.unwritten:
        damage = (f"{path} is half-written: {whole} of its {count} views are there",)
        advice = "the same command goes on where it stopped"
    return Checked(path, "recording", storage.VERSION, parts, damage, advice)


def _state(path: Path, kind: Kind) -> Checked:
    try:
        weights, settings, learnt = read_state(path, kind=kind)
        _LOADERS[kind](path)
    except CogmapError as error:
        return Checked(path, kind, damage=(str(error),))
    numbers = {"weights": weights, "settings": settings, "learnt": learnt}
    parts = {name: f"{len(values)}" for name, values in numbers.items()}
    return Checked(path, kind, VERSIONS[kind], parts)


def _result(path: Path) -> Checked:
    whole, damage = compare_sums(path)
    if not damage and METRICS not in whole:
        damage = [f"{SUMS} says nothing of {METRICS}"]
    parts = {"files": f"{len(whole)} of {len(whole) + len(damage)}"}
    advice = "do it again" if damage else ""
    if damage and PROVENANCE in whole:
        command = json.loads((path / PROVENANCE).read_text(encoding="utf-8"))["command"]
        advice = f"`{command}` does it again"
    return Checked(path, "result", parts=parts, damage=tuple(damage), advice=advice)


def _sweep(path: Path) -> Checked:
    damage, advice, names = list[str](), "", None
    try:
        names = read_mark(path / MARK)["points"]
    except CogmapError as error:
        damage.append(str(error))
    # names that begin with a dot are of those that are being written
    points, sound = sorted((path / "points").glob("[!.]*.json")), 0
    for point in points:
        try:
            read_record(point)
            sound += 1
        except CogmapError as error:
            damage.append(str(error))
    parts = {"points": f"{sound} of {len(points)}"}
    if names is not None and all_of(point.stem for point in points) != names:
        damage.append(f"{path} lacks points")
        advice = "the same command does them"
    elif (path / "table.csv").exists():
        whole, lost = compare_sums(path)
        parts["files"] = f"{len(whole)} of {len(whole) + len(lost)}"
        damage += lost
        advice = "the same command writes the table and its figures again" if lost else ""
    return Checked(path, "sweep", LAYOUT, parts, tuple(damage), advice)


def _toml(path: Path) -> Checked:
    try:
        is_plan = "experiment" in tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        is_plan = False
    try:
        if is_plan:
            plan = Plan.load(path)
            return Checked(path, "plan", parts={"experiment": plan.experiment})
        room = Arena.load(path)
    except (ArenaError, CogmapError) as error:
        return Checked(path, "plan" if is_plan else "room", damage=(str(error),))
    solids = ("walls", "boxes", "pillars", "blocks", "sources")
    parts = {"name": room.name} | {name: str(len(getattr(room, name))) for name in solids}
    return Checked(path, "room", parts=parts)
