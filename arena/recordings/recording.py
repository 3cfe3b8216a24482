"""The recording that an exploration leaves: views and times, and what else was sensed or is known."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsFloat, overload

import numpy as np
from jaxtyping import Float32, Float64, Shaped, UInt8

from arena.errors import ArenaError
from arena.paths import user_path
from arena.recordings import choosing, storage
from arena.recordings.begun import unfinished
from arena.recordings.choosing import Moment, Several, WholeNumber
from arena.recordings.sharding import shards, write_shards
from arena.recordings.storage import StoredViews

if TYPE_CHECKING:
    from arena.recordings.lens import Kind

_FIELDS = ("times", "odours", "poses", "commands", "joints")
"""Arrays by the names that they have on disk, too."""

Images = UInt8[np.ndarray, "views height width 3"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """Views of one exploration, in the order in which they were met, and what was recorded with them.

    Parameters
    ----------
    views
        RGB images; when opened from disk they stay there, and slices, masks and indices give arrays.
    times
        s.
    odours
        Smelt concentrations, all > 0. None when nothing was smelt.
    poses
        x, y (m) and heading (rad): ground truth, for scoring only. None when unknown or taken away.
    commands
        What was commanded from each view to the next, in [−1, 1]; NaN where the explorer stopped. No truth:
        the animal knows it. None for motions that do not tell.
    joints
        Where the body was on its axes (rad, m): ground truth, for scoring only. None for one without joints.
    signals
        Whatever else has one row of numbers a view, by its name; a name is one word, as in Python.
    attributes
        Where it came from, as far as JSON can say; `explore` puts the room, the seed and all parameters here.

    Raises
    ------
    ArenaError
        When the arrays do not fit each other or are not finite.
    """

    views: Images | StoredViews
    times: Float64[np.ndarray, " views"]
    odours: Float32[np.ndarray, "views odorants"] | None = None
    poses: Float64[np.ndarray, "views 3"] | None = None
    commands: Float64[np.ndarray, "views commands"] | None = None
    joints: Float64[np.ndarray, "views joints"] | None = None
    signals: Mapping[str, Shaped[np.ndarray, "views ..."]] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _check(self.views, self._columns)

    def __len__(self) -> int:
        return int(self.views.shape[0])

    @overload
    def __getitem__(self, key: WholeNumber) -> Moment: ...

    @overload
    def __getitem__(self, key: Several) -> "Recording": ...

    def __getitem__(self, key: WholeNumber | Several) -> "Moment | Recording":
        """Give one view by its number, or choose some by a slice, a mask or numbers; all is in memory.

        `rec[key].odours` is `rec.odours[key]` whatever the key, and so are all other arrays.

        Raises
        ------
        NoSuchViewError
            For a number past either end; it is an `IndexError`, too.
        ArenaError
            For what chooses no views, and for a mask of another length.
        """
        number = choosing.one(key, len(self))
        if number is None:
            rows = choosing.several(key, len(self))
            chosen = {name: values[rows] for name, values in self._columns.items()}
            return replace(self, views=self.views[rows], **_fields(chosen))
        found = {name: values[number] for name, values in self._columns.items()}
        return Moment(**{"views": self.views[number], **dict.fromkeys(_FIELDS), **_fields(found)})

    def __iter__(self) -> Iterator[Moment]:
        """Go through the views, one at a time from disk."""
        return (self[number] for number in range(len(self)))

    def require(self, name: str) -> np.ndarray:
        """Give an array that a recording may lack: `odours`, `poses`, `commands`, `joints`, `signals/NAME`.

        Raises
        ------
        ArenaError
            When this one lacks it.
        """
        if name not in self._columns:
            raise ArenaError(
                f"this recording has no {name}, only views, {', '.join(self._columns)}; use one that has"
            )
        return self._columns[name]

    def without_truth(self) -> "Recording":
        """Take the poses and joints away."""
        return replace(self, poses=None, joints=None)

    def save(self, path: str | Path) -> None:
        """Write to a folder that does not exist yet; it takes this name only when it is whole.

        Raises
        ------
        ArenaError
            When there is something at the path already, or it cannot be written.
        """
        views = ((rows, np.asarray(self.views[rows])) for rows in shards(len(self)))
        with storage.new_folder(user_path(path), self.views.shape, self._columns, self.attributes) as folder:
            write_shards(folder / "views", views)

    @classmethod
    def from_images(
        cls,
        source: Any,
        *,
        out: str | Path | None = None,
        kind: "Kind | None" = None,
        width: int | None = None,
        height: int | None = None,
        ahead: SupportsFloat = 0.0,
        clockwise: bool = True,
        mirror: tuple[float, float, float, float] | None = None,
        times: Any = None,
        rate: SupportsFloat | None = None,
        poses: Any = None,
        signals: Any = None,
        columns: Collection[str] | None = None,
        log: bool = False,
        progress: bool = False,
    ) -> "Recording":
        """Make a recording of pictures from any camera, and of what was measured beside them.

        Parameters
        ----------
        source
            A folder of pictures, in natural order; a video; paths; arrays, stacked or one by one; or an
            iterator of either (`arena.recordings.images.pictures_of`), in grey or colour
            (`arena.recordings.colours.as_rgb`).
        out
            Folder to stream to, 256 views at a time, with a few in memory. The same call after a kill goes on
            where it stopped and ends with the same bits, and a source or lens that has changed is refused; a
            recording that is whole is compared with its source and opened. None keeps all in memory.
        kind, width, height, ahead, clockwise, mirror
            What the pictures show and what is made of them: `arena.recordings.lens.Lens`.
        times
            When they were taken, s, increasing: an array, or a table with a column `t` or only one.
        rate
            Pictures a second, in place of times; a video's own unless told, else 1.
        poses
            x, y (m), heading (rad) or heading_deg: ground truth, for scoring only. A table or an array.
        signals
            A table of what knows place and not heading, whatever it is: strengths of Wi-Fi or Bluetooth
            stations, gas, temperature, light. All are `odours`, and raw in `signals` by their names, made
            words.
        columns
            Which of them to take; None takes all but times.
        log
            Whether signals are decibels: an odour is then 10^(value / 10). Else it is the value.
        progress
            Whether to show a bar on stderr.

        Notes
        -----
        Tables are as `arena.recordings.tables.table_of` takes them. Where a table has a column of times and
        the pictures have times or a rate, a picture gets what lies on the line between the rows before and
        after it; up to one interval past the ends, the end's value. Else rows and pictures are matched one to
        one and must be as many, and the times of such a table are those of the pictures. Missing values are
        interpolated over time, if anybody tells it.

        Raises
        ------
        ArenaError
            For pictures or tables that cannot be read or do not go together, and an `out` that holds
            something else.
        """
        # OpenCV and pandas, which only imports need, load slowly.
        from arena.recordings.beside import Beside  # noqa: PLC0415
        from arena.recordings.images import pictures_of  # noqa: PLC0415
        from arena.recordings.importing import import_to_disk, import_to_memory  # noqa: PLC0415
        from arena.recordings.lens import Lens  # noqa: PLC0415

        pictures = pictures_of(source)
        lens = Lens(kind=kind, width=width, height=height, ahead=ahead, clockwise=clockwise, mirror=mirror)
        beside = Beside.read(times=times, rate=rate, poses=poses, signals=signals, columns=columns, log=log)
        if out is None:
            views, arrays, attributes = import_to_memory(pictures, lens, beside, progress=progress)
            return cls(views=views, **_fields(arrays), attributes=attributes)
        path = user_path(out)
        import_to_disk(pictures, lens, beside, path, progress=progress)
        return cls.open(path)

    @classmethod
    def open(cls, path: str | Path) -> "Recording":
        """Open a recording on disk, leaving the views there.

        Raises
        ------
        ArenaError
            When it is missing, half-written, of another version, damaged or not a recording at all.
        """
        path = user_path(path)
        there = unfinished(path)
        if there is not None:
            raise ArenaError(
                f"{path} is half-written: {there} views are there; the same `import` command goes on where "
                "it stopped"
            )
        views, columns, attributes, missing = storage.load(path)
        try:
            _check(views, columns)
        except ArenaError as error:
            raise ArenaError(f"{path} is damaged: {error}") from None
        if missing:
            command = "import" if "lens" in attributes else "explore"
            raise ArenaError(storage.say_what_is_missing(path, len(views), missing, command))
        return cls(views=views, **_fields(columns), attributes=attributes)

    @property
    def _columns(self) -> dict[str, np.ndarray]:
        """All arrays that are there but the views, by their names on disk."""
        columns = {name: getattr(self, name) for name in _FIELDS}
        signals = {f"signals/{name}": values for name, values in self.signals.items()}
        return {name: values for name, values in columns.items() if values is not None} | signals


def from_columns(
    views: Images | StoredViews, columns: Mapping[str, np.ndarray], attributes: Mapping[str, Any]
) -> Recording:
    """Make a recording of views and of other arrays by their names on disk."""
    return Recording(views=views, **_fields(columns), attributes=attributes)


def _fields(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Turn arrays by their names on disk into the fields of a recording."""
    signals = {name.removeprefix("signals/"): values for name, values in columns.items() if "/" in name}
    return {**{name: values for name, values in columns.items() if "/" not in name}, "signals": signals}


def _check(views: np.ndarray | StoredViews, columns: Mapping[str, np.ndarray]) -> None:
    """Raise an `ArenaError` unless there is one sound row a view."""
    count = views.shape[0]
    # None stands for any length.
    wanted: dict[str, tuple[str, tuple[int | None, ...]]] = {
        "views": ("uint8", (count, None, None, 3)),
        "times": ("float64", (count,)),
        "odours": ("float32", (count, None)),
        "poses": ("float64", (count, 3)),
        "commands": ("float64", (count, None)),
        "joints": ("float64", (count, None)),
    }
    for name, array in {"times": np.empty(0), "views": views, **columns}.items():
        kind, _, signal = name.rpartition("/")
        if kind == "signals" and signal.isidentifier() and array.dtype.kind in "biuf":
            dtype, shape = str(array.dtype), (count, *array.shape[1:])
        elif name in wanted:
            dtype, shape = wanted[name]
        else:
            raise ArenaError(
                f"{name} is {array.dtype} of shape {array.shape}; signals are numbers, named by one word"
            )
        fits = len(shape) == array.ndim and all(
            length in {None, given} for length, given in zip(shape, array.shape, strict=True)
        )
        if array.dtype != dtype or not fits:
            told = ", ".join("any" if length is None else str(length) for length in shape)
            raise ArenaError(
                f"{name} is {array.dtype} of shape {array.shape}; "
                f"for {count} views it must be {dtype} of shape ({told})"
            )
    for name, values in columns.items():
        stopped = np.isnan(values) if name == "commands" else False
        if not (np.isfinite(values) | stopped).all():
            raise ArenaError(f"{name} has NaN or infinite values; leave those views out")
    if not (columns.get("odours", np.ones(0)) > 0).all():
        raise ArenaError("odours has values that are not positive; a concentration must be > 0")
