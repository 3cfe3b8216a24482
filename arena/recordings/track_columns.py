"""Which columns of a tracker's table are which, by what is told and by what there is."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from arena.errors import ArenaError
from arena.recordings.columns import check_names, listed
from arena.recordings.track_format import TrackFormat

TIMES = ("t", "time")
FRAMES = ("frame", "frame_idx", "frame_number", "frames")
HEADINGS = ("heading", "heading_deg")
SCORES = ("likelihood", "score")
"""How DeepLabCut and SLEAP call the likelihood of a body part."""


class TrackColumns(NamedTuple):
    """Names of columns; None for what there is not."""

    x: str
    y: str
    t: str | None
    heading: str | None
    likelihood: str | None
    track: str | None

    @property
    def all(self) -> list[str]:
        """Those that there are, each once."""
        return list(dict.fromkeys(name for name in self if name is not None))


def choose_columns(path: Path, names: Sequence[str], told: TrackFormat) -> TrackColumns:
    """Find the columns of a track.

    Raises
    ------
    ArenaError
        When one is missing, or it is not clear which one is meant; the error lists what was found.
    """
    x, y = told.x or _named(names, ("x",)), told.y or _named(names, ("y",))
    part = None
    if told.bodypart is not None or None in {x, y}:
        part = _bodypart(path, names, told.bodypart)
        x, y = (f"{part}.x", f"{part}.y") if part else (x, y)
    t = told.t or _named(names, TIMES if told.rate is None else (*FRAMES, *TIMES))
    if x is None or y is None or (t is None and told.rate is None):
        wanted = {"t": t or ("" if told.rate else None), "x": x, "y": y}
        missing = [name for name, there in wanted.items() if there is None]
        check_names(path, [name for name in names if name not in missing], missing, _hint(names, missing))
    both = told.heading is None and [name for name in names if name.lower() in HEADINGS]
    if both and len(both) > 1:
        raise ArenaError(
            f"{path} has both {' and '.join(both)}; leave one of them out, or name one: heading={both[0]!r}"
        )
    likelihood = told.likelihood
    if likelihood is None and told.least_likelihood is not None:
        likelihood = next((f"{part}.{score}" for score in SCORES if f"{part}.{score}" in names), None)
        if likelihood is None:
            raise ArenaError(
                f"{path} has no likelihood of {part or 'x and y'} for least_likelihood; "
                f"it has {listed(names)}; name its column: likelihood="
            )
    track = _named(names, ("track",)) if part or told.individual is not None else None
    if told.individual is not None and track is None:
        raise ArenaError(
            f"{path} has no column track for individual={told.individual!r}; it has {listed(names)}"
        )
    found = TrackColumns(str(x), str(y), t, told.heading or _named(names, HEADINGS), likelihood, track)
    check_names(path, names, found.all)
    return found


def bodyparts(names: Sequence[str]) -> list[str]:
    """Give the body parts of which there are x and y."""
    there = set(names)
    return [name[:-2] for name in names if name.endswith(".x") and f"{name[:-2]}.y" in there]


def _named(names: Sequence[str], wanted: Sequence[str]) -> str | None:
    """Find the first of some names, as it is written or else in any case."""
    lower = {name.lower(): name for name in reversed(names)}
    return next((name if name in names else lower[name] for name in wanted if name in lower), None)


def _bodypart(path: Path, names: Sequence[str], told: str | None) -> str | None:
    """Give the body part that is told, or the only one."""
    parts = bodyparts(names)
    if told is not None and told not in parts:
        found = f"its body parts are {listed(parts)}" if parts else f"it has columns {listed(names)}"
        raise ArenaError(f"{path} has no body part {told!r}; {found}")
    return told or (parts[0] if len(parts) == 1 else None)


def _hint(names: Sequence[str], missing: Sequence[str]) -> str:
    """Say what to pass."""
    if names and all(_is_number(name) for name in names):
        return "its first line has numbers where names must be, such as t,x,y; add such a line"
    hints = []
    parts = bodyparts(names)
    if parts and "x" in missing:
        hints.append(f"bodypart={parts[0]!r} (or another of {listed(parts)})")
    elif {"x", "y"} & set(missing):
        hints.append("x= and y=, the names of their columns")
    if "t" in missing:
        hints.append(
            "rate=, in Hz" if _named(names, FRAMES) else "t=, the name of its column, or rate=, in Hz"
        )
    return f"pass {' and '.join(hints)}" if names else "it must have t (s), x and y, by name"


def _is_number(name: str) -> bool:
    try:
        float(name.replace(",", "."))
    except ValueError:
        return False
    return True
