"""The command about cells: an animal's or a map's, measured alike."""

import inspect
import sys
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from arena import Recording
from arena.recordings.track_format import TrackFormat
from cogmap.atomic import result_folder
from cogmap.cells import MeasuredSession, Session, session
from cogmap.cells.sessions.units import positive
from cogmap.commands.common import Json, MaybePath, Seed, Told, UserPath, tell
from cogmap.errors import CogmapError
from cogmap.evaluation.map_session import map_session
from cogmap.experiments.parameters import parse, unknown
from cogmap.experiments.provenance import write_provenance
from cogmap.experiments.sessions import compare_sessions
from cogmap.inputs import checked_count
from cogmap.map.cognitive_map import CognitiveMap

_OF_BOTH = ("slowest", "between")
_OF_MEASURES = ("bin", "smoothing", "window")


def _cells(
    *sources: UserPath,
    out: UserPath,
    cmap: Annotated[MaybePath, Parameter(name="--map")] = None,
    track: MaybePath = None,
    told: Told = None,
    shuffles: int = 200,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Measure the cells of animals and of maps alike: a table, rate maps, tuning curves, decoding.

    Examples: `cogmap cells rat.nwb --out rat --set slowest=0.03`;
    `cogmap cells rat --set metres_per_unit=0.002 --out measured` for a folder with spikes.csv and track.csv;
    `cogmap cells walk.zarr --map map --out cells`;
    `cogmap cells rat.nwb walk.zarr --map map --out both`, side by side; then `cogmap report both`.

    Parameters
    ----------
    sources
        Sessions: NWB files, folders with spikes.csv (columns cell, t in s) and track.csv, or such a
        table of spikes with a `track`; recordings of an explorer, where a map is given.
    out
        Folder for tables, figures and metrics; an earlier result there is replaced.
    cmap
        Folder of the map whose cells look at the views of recordings, which `cogmap learn` wrote.
    track
        The animal's track, where it is not in the file or folder of its spikes.
    told
        How sessions are read: unit=cm (or m, mm, in), metres_per_unit, heading_unit=deg, slowest (m/s),
        between=[0, 600] (s), position, heading and activity (names of series, and spikes or rates, in an NWB
        file), options of `arena.read_track` for the file of a track (rate, bodypart, missing, ...); how cells
        are measured: bin (m), smoothing (m), window (s, of decoding).
    shuffles
        By which chance is judged.
    """
    if not sources:
        raise CogmapError(
            "there is no session; give an NWB file, a folder of tables, or a recording and --map"
        )
    checked_count("shuffles", shuffles)
    options = {name: _number(value) for name, value in parse(told or []).items()}
    measures = {name: positive(name, options.pop(name)) for name in _OF_MEASURES if name in options}
    window = {"window": measures.pop("window")} if "window" in measures else {}
    grown = None if cmap is None else CognitiveMap.load(cmap)
    read = {_name(path, sources): _read(path, grown, track, options) for path in sources}
    measured = {
        name: MeasuredSession(found, shuffles=shuffles, seed=seed, **measures) for name, found in read.items()
    }
    if grown is not None and not grown.trusted_:
        sys.stderr.write(f"cogmap: this map is not to be trusted: {grown.reason_}\n")
    with result_folder(out) as folder:
        result = compare_sessions(measured, **window)
        result.write(folder)
        where = {} if cmap is None else {"map": str(cmap)}
        beside = {} if track is None else {"track": str(track)}
        pairs = [word for pair in told or [] for word in ("--set", pair)]
        words = ("cells", *map(str, sources), *pairs)
        write_provenance(folder, words, None, **where, **beside, shuffles=shuffles, seed=seed)
    tell(result.metrics, as_json=as_json)


def _read(path: Path, cmap: CognitiveMap | None, track: Path | None, options: dict[str, Any]) -> Session:
    """Read one session, of an animal or of a map."""
    if (path / "zarr.json").exists():
        if cmap is None:
            raise CogmapError(
                f"{path} is a recording, which has no cells; give the map whose cells look, --map"
            )
        both = {name: value for name, value in options.items() if name in _OF_BOTH}
        return map_session(Recording.open(path), cmap, **both)
    known = [*{**dict.fromkeys([*inspect.signature(session).parameters][2:-1]), **TrackFormat.model_fields}]
    for name in options.keys() - {*known}:
        raise unknown(name, [*known, *_OF_MEASURES])
    return session(path, track=track, **options)


def _number(value: Any) -> Any:
    """Read what is a number without being one in TOML, as `.05`."""
    with suppress(ValueError, TypeError):
        return float(value) if isinstance(value, str) else value
    return value


def _name(path: Path, sources: tuple[Path, ...]) -> str:
    """Call a session by its file, or by its path where another is called so."""
    alone = [other.stem for other in sources].count(path.stem) == 1
    return path.stem if alone else str(path)
