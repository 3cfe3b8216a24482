"""The posture of an arm: joints by hand, what its eye sees, and where that lies among all its views."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, UInt8

from arena import Arena, Recording
from arena.angles import wrap_angle
from arena.bodies.base import Body
from arena.eye.base import AnyEye, see
from cogmap.coordinates import GeneralisedCoordinates
from cogmap.errors import CogmapError
from cogmap.pages.live.pictures import data_url, packed
from cogmap.pages.live.player import Act, Update
from cogmap.pages.live.scenery import Json, room_lines

NEAREST = 3
"""Remembered views that are shown beside the one that is seen."""
WIDE, THICK = 0.68, 0.3
"""Radii of the torus that two phases are drawn on, and of the tube."""


@dataclass(eq=False)
class Mechanism:
    """A body with joints in a room, an eye, and the coordinates that were found in what it sees.

    Parameters
    ----------
    room, body, eye
        The room, the mechanism, and what sees from it or sees it.
    coordinates
        Found in the views of `walk`, which is read to draw them in the colours of the joints.

    Raises
    ------
    CogmapError
        For coordinates that are not resolved, with the reason, and a recording without joints.
    """

    room: Arena
    body: Body
    eye: AnyEye
    coordinates: GeneralisedCoordinates
    walk: Recording

    def __post_init__(self) -> None:
        if self.coordinates.coordinates_ is None:
            raise CogmapError(f"there are no coordinates to show, unresolved: {self.coordinates.reason_}")
        if self.walk.joints is None:
            raise CogmapError("the memory has no joints; give the recording of the body that babbled")

    @cached_property
    def joints(self) -> Float[np.ndarray, "kept axes"]:
        """Where the body was on its axes at the views that are kept: the truth, for the colours."""
        joints = np.asarray(self.walk.require("joints"), np.float64)
        return np.asarray(joints[self.coordinates.indices_])

    def drawn(self, found: Float[np.ndarray, "views coordinates"]) -> Float[np.ndarray, "views 3"]:
        """Put coordinates into space: two phases onto a torus, one onto a cylinder, others as they are."""
        loops = self.coordinates.loops_
        if loops >= 2:
            turned, bent = found[:, 0], found[:, 1]
            out = WIDE + THICK * np.cos(bent)
            return np.column_stack([out * np.cos(turned), out * np.sin(turned), THICK * np.sin(bent)])
        if loops == 1:
            height = found[:, 1] / 3 if found.shape[1] > 1 else np.zeros(len(found))
            return np.column_stack([WIDE * np.cos(found[:, 0]), WIDE * np.sin(found[:, 0]), height])
        flat = np.pad(found[:, :3], [(0, 0), (0, max(0, 3 - found.shape[1]))])
        return np.asarray(flat / 3)

    @cached_property
    def scenery(self) -> Json:
        """What does not change while the body moves."""
        assert self.coordinates.coordinates_ is not None  # noqa: S101  # asked at the beginning
        first, last = self.joints[:, 0], self.joints[:, min(1, self.joints.shape[1] - 1)]
        looks = np.column_stack([last, last, first])
        return {
            "kind": "arm",
            "room": {**room_lines(self.room), "odours": [], "sources": []},
            "radius": self.body.radius,
            "embedding": {
                "points": packed(self.drawn(self.coordinates.coordinates_).astype(np.float32)),
                "poses": packed(looks.astype(np.float32)),
                "colours": [
                    f"by {self.body.axes[0].name}",
                    f"by {self.body.axes[min(1, self.joints.shape[1] - 1)].name}",
                ],
            },
            "reason": self.coordinates.reason_,
        }


class Posture:
    """One body, set joint by joint. It is a session without time.

    Parameters
    ----------
    mechanism
        Shared by all.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism, self.said, self._changed = mechanism, "", True
        self.joints = mechanism.joints[0].copy()

    def bend(self, axis: int, value: float) -> None:
        """Put one joint (rad or m) somewhere; where the body would touch something it stays."""
        axes = self.mechanism.body.axes
        if not 0 <= axis < len(axes) or not np.isfinite(value):
            return
        asked = self.joints.copy()
        asked[axis] = wrap_angle(np.array(value)) if axes[axis].kind == "circle" else value
        self._changed = True
        if self.mechanism.body.is_free(self.mechanism.room, asked[None])[0]:
            self.joints, self.said = asked, ""
        else:
            self.said = f"it cannot bend {axes[axis].name} so far: it would touch something"

    def turn(self, seconds: float, *, anew: bool = False) -> Update | None:
        """Give what a page shows, where anything changed."""
        del seconds
        if not (self._changed or anew):
            return None
        self._changed = False
        return Update(self._frame(), None, [], 0)

    def do(self, act: Act) -> None:
        """Take no act of an explorer: there is none."""

    def hear(self, said: object) -> None:
        """Hear nothing: joints are bent by switches of the page."""

    @property
    def view(self) -> UInt8[np.ndarray, "height width 3"]:
        """What the eye sees now."""
        out = np.empty((1, self.mechanism.eye.height, self.mechanism.eye.width, 3), np.uint8)
        rng = np.random.default_rng(0)
        see(self.mechanism.eye, self.mechanism.room, self.mechanism.body, self.joints[None], out=out, rng=rng)
        return np.asarray(out[0])

    def _frame(self) -> Json:
        mechanism, view = self.mechanism, self.view
        found = mechanism.coordinates
        coordinates, code = found.transform(view[None]), found.encode(view[None])
        nearest = np.linalg.norm(found.codes_ - code, axis=1).argsort()[:NEAREST]
        eye = mechanism.body.camera_poses(self.joints[None])[0]
        return {
            "links": np.round(mechanism.body.segments(self.joints[None])[0], 3).tolist(),
            "pose": np.round(eye, 4).tolist(),
            "seen": data_url(view, 95),
            "near": [
                {
                    "view": data_url(np.asarray(mechanism.walk.views[int(found.indices_[kept])]), 95),
                    "joints": np.round(mechanism.joints[kept], 3).tolist(),
                }
                for kept in nearest
            ],
            "point": np.round(mechanism.drawn(coordinates)[0], 4).tolist(),
            "coordinates": np.round(coordinates[0], 4).tolist(),
            "joints": np.round(self.joints, 4).tolist(),
            "doing": "bent by hand",
            "said": self.said,
            "replay": {"name": "", "at": 0, "length": 0},
        }
