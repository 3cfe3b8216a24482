"""Replay of an animal's recorded path."""

import warnings
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np
import shapely
from jaxtyping import Float, Int
from pydantic import Field, PlainSerializer, model_validator
from shapely.geometry.base import BaseGeometry

from arena.angles import wrap_angle
from arena.bodies.base import TOLERANCE, Body, check_starts, wrapped
from arena.bodies.disc import Disc
from arena.errors import ArenaError, TrackWarning
from arena.motions.base import Walk
from arena.motions.fitting import fitted
from arena.motions.locomotion import Point, free_space
from arena.motions.paths import read_joints
from arena.paths import user_path
from arena.recordings.track_format import Above, TrackFormat
from arena.recordings.tracks import Positions, RecordedPath, Times, read_as
from arena.rooms.arena import Arena

LATE = 1.5
"""Samples further apart than this many median intervals leave a gap."""
MOST = 10_000_000
"""Samples that may be interpolated."""


class Replay(TrackFormat):
    """Goes where an animal went: see `arena.read_track` for the files.

    How they are to be read is told by the parameters of `arena.recordings.track_format.TrackFormat`, all of
    which are parameters here, too: `Replay(path="rat.csv", bodypart="nose", rate=30, y_down=True, fit=True)`.

    Another body than a disc goes through its recorded configurations, all of which must be free: the file has
    `t` (s) and a column for each axis by its name, such as `joint_1` (`arena.motions.paths.read_joints`).

    Where samples are missing, or are not numbers, the way between their neighbours is straight and even. A
    path without headings looks where it goes, and turns evenly between two moves while it is still.

    All views are samples of the path, interpolated ones among them. The notes of the walk tell how many
    `samples` the file has, how many lost ones were `trimmed` from its ends, how many `gaps` there are, the
    `longest_gap_s`, how many samples were `interpolated` for them, and how many positions were `clipped`;
    the others are those of `RecordedPath.notes` and, with `fit`, the `fitted_scale`, m per unit, and how many
    samples were `left_out`.

    Parameters
    ----------
    path
        The file.
    offset
        Added to positions in m, which `scale`, `calibration` and `y_down` make of the file's.
    fit
        Scale and move the path so that it just fits the box around the body's free space. Doubtful samples
        and those far from all others are left out, with a `TrackWarning`, and `fastest` is of the room.
    clip
        Move positions that are not free to the nearest that is; else they are an error.
    interval, view_every_m
        A view is taken at the first sample in every `interval` s, or after every `view_every_m` m of the
        path; at every sample when both are None.
    smoothing
        Time over which the direction of motion is taken, s.
    still
        Speed below which there is none, m/s.

    Raises
    ------
    ArenaError
        For parameters out of range or at odds with each other.
    """

    default_views: ClassVar[None] = None
    any_body: ClassVar[bool] = True

    path: Annotated[Path, PlainSerializer(str)]
    offset: Point = (0.0, 0.0)
    fit: bool = False
    clip: bool = False
    interval: Above | None = None
    view_every_m: Above | None = None
    smoothing: Above = 0.25
    still: Annotated[float, Field(ge=0, le=100)] = 0.02

    @model_validator(mode="after")
    def _agree(self) -> "Replay":
        if self.interval is not None and self.view_every_m is not None:
            raise ValueError("both interval and view_every_m are given; choose one")
        if self.fit and (self.metres_per_unit, self.offset) != ((1.0, 1.0), (0.0, 0.0)):
            raise ValueError("fit finds scale and offset itself; leave them out")
        return self

    def walk(self, arena: Arena, body: Body, views: int | None, rng: np.random.Generator) -> Walk:  # noqa: ARG002
        """Follow the path, for this many views if told; nothing is random.

        Raises
        ------
        ArenaError
            When the file is no path, the path leaves the body's free space or has fewer views.
        """
        if not isinstance(body, Disc):
            return self._joints(arena, body, views)
        free = free_space(arena, body)
        recorded = self._fitted(free) if self.fit else read_as(user_path(self.path), self)
        times, positions, notes = _bridged(recorded)
        positions += self.offset
        if recorded.headings is None:
            headings = self._ahead(times, positions)
        else:
            known = np.isfinite(recorded.headings)
            headings = np.interp(times, recorded.times[known], np.unwrap(recorded.headings[known]))
        taken = self._taken(times, positions, views)
        positions, clipped = self._kept(arena, body, times, positions)
        poses = np.column_stack([positions, wrap_angle(headings)])[taken]
        return Walk(times[taken] - times[0], poses, {**notes, "clipped": clipped})

    def _joints(self, arena: Arena, body: Body, views: int | None) -> Walk:
        """Go through recorded configurations."""
        usual = TrackFormat()
        given = [name for name in TrackFormat.model_fields if getattr(self, name) != getattr(usual, name)]
        if self.fit or self.clip or given or self.offset != (0.0, 0.0):
            raise ArenaError(
                f"{', '.join([*given, 'offset', 'fit'])} and clip are of a disc's path; leave them out"
            )
        times, joints = read_joints(user_path(self.path), [axis.name for axis in body.axes])
        taken = self._taken(times, body.camera_poses(joints)[:, :2], views)
        there = wrapped(body, joints[taken])
        check_starts(body, arena, there)
        return Walk(times[taken] - times[0], there)

    def _fitted(self, free: BaseGeometry) -> RecordedPath:
        """Read the path and bring it into the room; the speed is that in the room."""
        unhurried = self.model_copy(update={"fastest": None})
        recorded = read_as(user_path(self.path), unhurried, warn=self.fastest is None)
        placed, scale, left_out, fast = fitted(recorded, free, self.fastest)
        notes = {**recorded.notes, "fitted_scale": scale}
        if self.fastest is not None:
            notes |= {
                "too_fast": int(fast.sum()),
                "doubtful": int((recorded.doubtful & ~fast & ~left_out).sum()),
            }
        if left_out.any():
            notes["left_out"] = int(left_out.sum())
            warnings.warn(
                f"{self.path}: fit leaves {notes['left_out']} of {len(left_out)} samples out, which are "
                "doubtful or far from all others; they become gaps",
                TrackWarning,
                stacklevel=3,
            )
        headings = recorded.headings
        if headings is not None:
            headings = np.where(left_out | fast, np.nan, headings)
            headings = headings if np.isfinite(headings).any() else None
        return recorded._replace(positions=placed, headings=headings, notes=notes)

    def _ahead(self, times: Times, positions: Positions) -> Times:
        """Give the direction of motion, rad, unwrapped."""
        ends = [np.clip(times + sign * self.smoothing / 2, times[0], times[-1]) for sign in (-1, 1)]
        before, after = (_at(end, times, positions) for end in ends)
        x, y = (after - before).T
        moving = np.hypot(x, y) > self.still * (ends[1] - ends[0])
        if not moving.any():
            raise ArenaError(
                f"{self.path} never moves faster than {self.still:g} m/s, so that it has no direction; "
                "give it a heading column or lower `still`"
            )
        ahead: np.ndarray = np.interp(times, times[moving], np.unwrap(np.arctan2(y, x)[moving]))
        return ahead

    def _taken(self, times: Times, positions: Positions, views: int | None) -> Int[np.ndarray, " views"]:
        """Say at which samples views are taken."""
        taken = self._due(times, positions)[:views]
        if views is not None and len(taken) < views:
            raise ArenaError(f"{self.path} gives {len(taken)} views, not {views}; ask for no more")
        return taken

    def _due(self, times: Times, positions: Positions) -> Int[np.ndarray, " views"]:
        """Say at which samples a view is due."""
        if self.interval is not None:
            gone, every = times - times[0], self.interval
        elif self.view_every_m is not None:
            gone = np.insert(np.cumsum(np.hypot(*np.diff(positions, axis=0).T)), 0, 0.0)
            every = self.view_every_m
        else:
            return np.arange(len(times))
        # Rounding must not put a sample that is due into the interval before.
        return np.unique(np.floor(gone / every + 1e-9), return_index=True)[1]

    def _kept(self, arena: Arena, body: Disc, times: Times, positions: Positions) -> tuple[Positions, int]:
        """Keep the path in free space, and count the positions that had to be moved."""
        outside = np.flatnonzero(~arena.is_free(positions, max(0.0, body.radius - TOLERANCE)))
        if len(outside) and not self.clip:
            x, y = positions[outside[0]]
            width, height = np.ptp(positions, axis=0)
            raise ArenaError(
                f"{self.path} leaves the free space of a body of radius {body.radius:g} m, "
                f"first at ({x:.3f}, {y:.3f}) m and {times[outside[0]]:.3f} s, "
                f"in {len(outside)} of {len(times)} samples, and covers {width:.3g} by {height:.3g} m; "
                "fit or clip it, give scale or calibration if its unit is no metre, "
                "or take a wider arena or a smaller body"
            )
        kept = positions.copy()
        ways = shapely.shortest_line(shapely.points(positions[outside]), free_space(arena, body))
        kept[outside] = shapely.get_coordinates(ways)[1::2]
        return kept, len(outside)


def _bridged(path: RecordedPath) -> tuple[Times, Positions, dict[str, object]]:
    """Fill gaps; give times, positions, and what there is to tell."""
    known = np.flatnonzero(np.isfinite(path.positions).all(axis=1))
    times, positions = path.times[known], path.positions[known]
    lapse = np.diff(times)
    usual = np.median(lapse)
    gaps = np.flatnonzero(lapse > LATE * usual)
    lost = np.rint(lapse[gaps] / usual) - 1
    if lost.sum() > MOST:
        worst = gaps[np.argmax(lost)]
        raise ArenaError(
            f"a gap of {lapse[worst]:g} s after {times[worst]:g} s is too long to interpolate "
            f"every {usual:g} s; cut the path there"
        )
    fill = [np.linspace(times[g], times[g + 1], int(n) + 2)[1:-1] for g, n in zip(gaps, lost, strict=True)]
    dense = np.sort(np.concatenate([times, *fill]))
    notes: dict[str, object] = {
        **path.notes,
        "samples": len(path.times),
        "trimmed": len(path.times) - int(known[-1] - known[0]) - 1,
        "gaps": len(gaps),
        "longest_gap_s": float(lapse[gaps].max(initial=0.0)),
        "interpolated": int(lost.sum()),
    }
    return dense, _at(dense, times, positions), notes


def _at(
    when: Float[np.ndarray, " moments"], times: Times, positions: Positions
) -> Float[np.ndarray, "moments 2"]:
    return np.stack([np.interp(when, times, along) for along in positions.T], axis=1)
