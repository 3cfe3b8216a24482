"""The world of a page: a room, the animal in it, its mind, and the truth that lays its map over the room."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from threading import RLock

import numpy as np
from jaxtyping import Float

from arena import Arena, Camera, Disc, Nose, Recording
from arena.angles import wrap_angle
from cogmap.cells import HeadingFrame, MapFrame, fit_heading_frame, fit_map_frame, place_map
from cogmap.errors import CogmapError
from cogmap.pages.live.mind import Mind


@dataclass(eq=False)
class World:
    """What all pages of one server show. Poses of the memory are read to draw, never by the mind.

    Parameters
    ----------
    room, camera, body, nose
        Where the explorer goes, and what it is.
    mind
        What it thinks with.
    walk
        The recording that is remembered, with poses.
    replays
        Recordings to replay by name; the first is `walk`.

    Raises
    ------
    CogmapError
        For a memory without poses, and a camera whose views are not of the map's size.
    """

    room: Arena
    camera: Camera
    body: Disc
    mind: Mind
    walk: Recording
    _: KW_ONLY
    nose: Nose = Nose()  # noqa: RUF009  # frozen
    replays: dict[str, Recording] | None = None

    def __post_init__(self) -> None:
        shape = self.mind.cmap.view_shape_
        if (self.camera.height, self.camera.width) != shape[:2]:
            raise CogmapError(
                f"the camera takes {self.camera.height}×{self.camera.width} pixels but the map was learnt "
                f"from {shape[0]}×{shape[1]}; give the recording that the map was learnt from"
            )
        if self.walk.poses is None:
            raise CogmapError(
                "the memory has no poses, so nothing tells how its map lies in the room; "
                "give a recording that `cogmap explore` wrote"
            )

    @cached_property
    def lock(self) -> RLock:
        """One thinks at a time: all pages share the mind, and one thread of torch."""
        return RLock()

    @cached_property
    def poses(self) -> Float[np.ndarray, "views 3"]:
        """Where the remembered views were taken (m, m, rad): the truth."""
        return np.asarray(self.walk.require("poses"), np.float64)

    @cached_property
    def sampled_poses(self) -> Float[np.ndarray, "sampled 3"]:
        """Where those were taken that the map perceives anew, row by row as `Mind.remembered`."""
        return np.asarray(self.poses[self.mind.sample])

    @cached_property
    def map_frame(self) -> MapFrame | None:
        """How the metric map lies in the room; None without one."""
        found = self.mind.remembered.position
        return None if np.isnan(found).any() else fit_map_frame(found, self.sampled_poses[:, :2])

    @cached_property
    def heading_frame(self) -> HeadingFrame | None:
        """How the compass lies in the room; None without one."""
        found = self.mind.remembered.phase
        return None if np.isnan(found).any() else fit_heading_frame(found, self.sampled_poses[:, 2])

    @cached_property
    def full_rates(self) -> tuple[float, float]:
        """Rates (Hz) of place and heading cells that are drawn brightest: of the strongest in most views."""
        seen = self.mind.remembered
        strongest = (np.nan_to_num(rates).max(axis=1, initial=0.0) for rates in (seen.place, seen.heading))
        place, heading = (max(float(np.median(rates)), 1e-6) for rates in strongest)
        return place, heading

    def in_room(self, mapped: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points 2"]:
        """Lay positions of the map in the room, m; NaN without a metric map."""
        if self.map_frame is None or not len(mapped):
            return np.full(mapped.shape, np.nan)
        return place_map(mapped, self.map_frame)

    def facing(self, phase: float) -> float:
        """Turn a heading of the map to one of the room, rad; NaN without a compass."""
        if self.heading_frame is None:
            return np.nan
        sign = -1 if self.heading_frame.mirror else 1
        return float(wrap_angle(np.array(sign * phase + self.heading_frame.rotation)))

    def prepare(self) -> None:
        """Make all that a first page would wait for."""
        with self.lock:
            self.mind.prepare()
            _ = self.map_frame, self.heading_frame
            self.mind.look(np.asarray(self.walk.views[0]))
