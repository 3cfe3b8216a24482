"""The recording that an exploration leaves: views, smells, times and (for scoring only) poses."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from jaxtyping import Bool, Float32, Float64, Int, UInt8

from arena.errors import ArenaError
from arena.recordings import storage
from arena.recordings.sharding import shards

Images = UInt8[np.ndarray, "views height width 3"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """Views and smells of one exploration, in the order in which they were met.

    Parameters
    ----------
    views
        RGB images; when opened from disk a lazy zarr array, whose slices give arrays.
    odours
        Smelt concentrations, all > 0.
    times
        s.
    poses
        x, y (m) and heading (rad): ground truth, for scoring only. None when taken away.
    attributes
        Where it came from, as far as JSON can say; `explore` puts the room, the seed and all parameters here.

    Raises
    ------
    ArenaError
        When the arrays do not fit each other or are not finite.
    """

    views: Images | zarr.Array[Any]
    odours: Float32[np.ndarray, "views odorants"]
    times: Float64[np.ndarray, " views"]
    poses: Float64[np.ndarray, "views 3"] | None = None
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _check(self.views, self._columns)

    def __len__(self) -> int:
        return int(self.views.shape[0])

    def __getitem__(
        self, key: slice | Bool[np.ndarray, " views"] | Int[np.ndarray, " chosen"]
    ) -> "Recording":
        """Choose views by a slice, a mask or indices; the result is in memory."""
        views = self.views
        return replace(
            self,
            views=views[key]
            if isinstance(views, np.ndarray)
            else storage.read(views, np.arange(len(self))[key]),
            odours=self.odours[key],
            times=self.times[key],
            poses=None if self.poses is None else self.poses[key],
        )

    def without_truth(self) -> "Recording":
        """Take the poses away."""
        return replace(self, poses=None)

    def save(self, path: str | Path) -> None:
        """Write to a folder that does not exist yet; it takes this name only when it is whole.

        Raises
        ------
        ArenaError
            When there is something at the path already, or it cannot be written.
        """
        with storage.new_folder(Path(path)) as folder:
            storage.lay_out(folder, self.views.shape, self._columns, self.attributes)
            with storage.writable_views(folder) as views:
                for rows in shards(len(self)):
                    views[rows] = np.asarray(self.views[rows])

    @classmethod
    def open(cls, path: str | Path) -> "Recording":
        """Open a recording on disk, leaving the views there.

        Raises
        ------
        ArenaError
            When it is missing, half-written, of another version, damaged or not a recording at all.
        """
        views, columns, attributes, missing = storage.load(Path(path))
        try:
            _check(views, columns)
        except ArenaError as error:
            raise ArenaError(f"{path} is damaged: {error}") from None
        if missing:
            count = views.shape[0]
            present = count - sum(rows.stop - rows.start for rows in missing)
            raise ArenaError(
                f"{path} is half-written: {present} of its {count} views are there; "
                "the same `explore` command goes on where it stopped"
            )
        return cls(views=views, **columns, attributes=attributes)

    @property
    def _columns(self) -> dict[str, np.ndarray]:
        columns = {"odours": self.odours, "times": self.times, "poses": self.poses}
        return {name: values for name, values in columns.items() if values is not None}


def _check(views: np.ndarray | zarr.Array[Any], columns: Mapping[str, np.ndarray]) -> None:
    """Raise an `ArenaError` unless there is one sound row a view."""
    count = views.shape[0]
    odorants = columns["odours"].shape[-1:]
    wanted = {
        "odours": ("float32", (count, *odorants)),
        "times": ("float64", (count,)),
        "poses": ("float64", (count, 3)),
    }
    arrays = {"views": views, **columns}
    for name, array in arrays.items():
        dtype, shape = wanted.get(name, ("uint8", (count, *views.shape[1:3], 3)))
        if array.dtype != dtype or array.shape != shape:
            raise ArenaError(
                f"{name} is {array.dtype} of shape {array.shape}; "
                f"for {count} views it must be {dtype} of shape {shape}"
            )
    for name, values in columns.items():
        if not np.isfinite(values).all():
            raise ArenaError(f"{name} has NaN or infinite values; leave those views out")
    if not (columns["odours"] > 0).all():
        raise ArenaError("odours has values that are not positive; a concentration must be > 0")
