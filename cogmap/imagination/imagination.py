"""Imagination: what a map expects to see from anywhere that it remembers places around."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import Any, Literal, Protocol, get_args, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32, UInt8
from numpy.typing import ArrayLike

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.imagination.alignment import Seen
from cogmap.imagination.comparison import Comparison
from cogmap.imagination.decoder import ChartDecoder
from cogmap.imagination.painter import Painter, Turned
from cogmap.imagination.places import RememberedPlaces
from cogmap.imagination.stroll import stroll
from cogmap.imagination.surprise import ALARM, NOTABLE, Surprise
from cogmap.inputs import check_array, check_choice, checked_count, checked_views
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.even_memory import EvenMemory
from cogmap.map.novelty import check_known
from cogmap.navigation.place_graph import PlaceGraph

Method = Literal["decoder", Turned]
"""How a view is made.

"decoder"
    of what the charts have learnt from all that is remembered (`decoder.ChartDecoder`), in 3 ms and blurred;
"turned"
    of the nearest place, turned;
"blend"
    the affine mixture of the places around, turned;
"warp"
    optical flow carries what these show to where it is seen from the target (`warp.warped`).
"""
STRAIGHT = 0.2
"""Turn between views (rad) up to which a body counts as going straight on."""


@runtime_checkable
class Motor(Protocol):
    """What foretells motion from commands, as a `MotorModel` does."""

    def predict(
        self,
        commands: Float[np.ndarray, "decisions 2"],
        previous: Float[np.ndarray, "decisions 2"] | None = None,
    ) -> Float[np.ndarray, "decisions 3"]:
        """Give how far the body gets forward and to the left, in the unit of the map, and turns, rad."""


@dataclass(frozen=True)
class Dream:
    """Imagined views, where they are imagined from, and how far to trust them."""

    views: UInt8[np.ndarray, "targets height width 3"]
    position: Float[np.ndarray, "targets 2"]
    """In the unit of the map."""
    phase: Float[np.ndarray, "targets"]
    """Heading in the frame of the map, rad."""
    spread: Float32[np.ndarray, "targets"]
    """Root mean square over pixels of how far the sources differ, grey levels."""
    distance: Float[np.ndarray, "targets"]
    """To the nearest remembered place, in the unit of the map."""

    def __len__(self) -> int:
        return len(self.views)


@dataclass(eq=False)
class Imagination:
    """Imagines views, from a map and what its animal remembers having seen.

    Remembered panoramas have the places and headings that the map perceives; whatever is imagined is imagined
    in the map's frame and unit. No pose enters. Of the places around a target each is turned to the heading
    that is asked for, and optical flow between them carries what they show to the target (`at`).

    Parameters
    ----------
    cmap
        A map with a compass and a metric map; refined (`CognitiveMap.refine`) it imagines far better.
    memory
        Panoramas that are remembered, (views, height, width, 3), which may lie on disk, or an `EvenMemory` of
        such. 17,000 of 360×60 pixels are 1.1 GB; fewer are farther apart, and dreams of them coarser.
    sources
        Places that a view is made of.

    Raises
    ------
    CogmapError
        At first use: for a memory of another camera, a map without compass or metric map, and views whose
        columns do not shift when the body turns.
    """

    cmap: CognitiveMap
    _: KW_ONLY
    memory: Any
    sources: int = 5

    def at(self, position: ArrayLike, heading: ArrayLike | float, *, method: Method = "warp") -> Dream:
        """Imagine the views from places, (targets, 2) or (2,), in directions, (targets,) or one for all.

        Raises
        ------
        CogmapError
            For targets that are not finite or do not fit each other, and an unknown method.
        """
        check_choice("method", method, get_args(Method))
        where = np.atleast_2d(np.asarray(position, np.float64))
        check_array("position", where, (None, 2))
        phase = np.asarray(heading, np.float64)
        if phase.ndim > 1 or phase.size not in {1, len(where)}:
            raise CogmapError(f"heading has shape {phase.shape}; give one for each of {len(where)} places")
        phase = np.broadcast_to(phase.reshape(-1), len(where)).copy()
        check_array("heading", phase, (len(where),))
        count = checked_count("sources", self.sources) if method in {"blend", "warp"} else 1
        sources = self.places.sources(where, count)
        if method == "decoder":
            found = list(self.decoder.paint(np.column_stack([where, phase])))
        else:
            found = list(self._painter.paint(sources, phase, method))
        return Dream(
            views=np.stack([as_pixels(each.view) for each in found]),
            position=where,
            phase=phase,
            spread=np.array([np.sqrt(np.square(each.spread).mean()) for each in found], np.float32),
            distance=sources.distances[:, 0],
        )

    def along(self, route: Float[np.ndarray, "points 2"], *, step: float | None = None) -> Dream:
        """Imagine what is seen on the way along a route, facing where it leads, view by view.

        Parameters
        ----------
        route
            Its corners, in the unit of the map.
        step
            Distance from view to view; a quarter of the pace of the remembered walk when None.
        """
        check_array("route", route, (None, 2))
        return self._walked(route, step, None, None)

    def film(
        self, view_a: UInt8[np.ndarray, "height width 3"], view_b: UInt8[np.ndarray, "height width 3"]
    ) -> Dream:
        """Imagine the way from one view to another, round whatever it has learnt to go round.

        Raises
        ------
        CogmapError
            For views that show nothing or are of a place that is not remembered, and when no way is known.
        """
        views = np.stack([view_a, view_b])
        position, phase = self.perceive(views)
        route = self.ways.plan(position[0], position[1])
        return self._walked(route, None, float(phase[0]), float(phase[1]))

    def ahead(
        self,
        views: Any,
        motor: Motor | None = None,
        commands: Float[np.ndarray, "views 2"] | None = None,
        *,
        previous: Float[np.ndarray, "views 2"] | None = None,
    ) -> Dream:
        """Expect what is seen next after each of some views.

        Parameters
        ----------
        views
            What is seen now.
        motor, commands
            What foretells the motion that commands, one for each view, bring about. Without, the body is
            taken to go straight on, as far as it usually got from view to view of the remembered walk.
        previous
            Commands before these; they go on unchanged when None.
        """
        poses = self._poses(views)
        position, phase = poses[:, :2], poses[:, 2]
        if (motor is None) != (commands is None):
            raise CogmapError("give a motor model and commands for each view, or neither")
        if motor is None or commands is None:
            motion = np.broadcast_to([self.pace, 0.0, 0.0], (len(phase), 3))
        else:
            motion = np.asarray(motor.predict(commands, previous), np.float64)
            check_array("predicted motion", motion, (len(phase), 3))
        # along the chord of the arc, as it was learnt
        ahead = _ahead(phase + motion[:, 2] / 2)
        left = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        moved = motion[:, :1] * ahead + motion[:, 1:2] * left
        return self.at(position + moved, phase + motion[:, 2])

    def surprise(self, views: Any) -> Surprise:
        """Tell what surprises in views: what differs from what is imagined at their own pose, and where.

        Where something has changed the map perceives wrong poses; they are corrected by what has not
        (`recognise`). The threshold is told by how much 500 remembered views surprise those that remember
        all but the visits on which these were seen.
        """
        poses = self._poses(views)
        compared = self._comparison
        there = compared.seen(views, poses)
        pixels = there.unusual
        # aligning takes four times as long as all else: only where something may have changed
        doubtful = np.flatnonzero(pixels.max(axis=(1, 2)) > NOTABLE / ALARM * self.threshold)
        if len(doubtful):
            seen = np.stack([views[view] for view in doubtful])
            there = Seen(*(part[doubtful] for part in there))
            poses[doubtful], pixels[doubtful] = compared.judged(seen, poses[doubtful], there)
        return Surprise(
            pixels=pixels,
            position=poses[:, :2],
            phase=poses[:, 2],
            threshold=self.threshold,
            sense=self.sense,
            bounds=np.stack([self.places.position.min(axis=0), self.places.position.max(axis=0)]),
        )

    def recognise(self, views: Any) -> Float[np.ndarray, "views 3"]:
        """Tell from where views were seen, position and phase, as what is imagined there fits them best.

        Unlike `perceive` it looks at every pixel and mistrusts those that do not fit, so it holds when a
        thing was moved; it takes thirty times as long.
        """
        poses, compared = self._poses(views), self._comparison
        return compared.aligned(views, poses, compared.seen(views, poses))[0]

    @cached_property
    def threshold(self) -> float:
        """Above what surprises where nothing has changed: `ALARM` times what one view in 100 reaches."""
        places = self.places
        chosen = places.sample
        views = np.stack([places.views[view] for view in chosen])
        poses = np.column_stack([places.position[chosen], places.phase[chosen]])
        compared = replace(self._comparison, without=chosen)
        pixels = compared.judged(views, poses, compared.seen(views, poses))[1]
        return float(ALARM * np.percentile(pixels.max(axis=(1, 2)), 99))

    @cached_property
    def places(self) -> RememberedPlaces:
        """What is remembered, where the map perceives it."""
        views = self.memory.views_ if isinstance(self.memory, EvenMemory) else self.memory
        views = checked_views(views, self.cmap.view_shape_)
        return RememberedPlaces.of(views, self._perceived(views))

    @cached_property
    def decoder(self) -> ChartDecoder:
        """How what is remembered changes with pose across each chart of the map."""
        places = self.places
        return ChartDecoder.learn(self.cmap, places.views, np.column_stack([places.position, places.phase]))

    @cached_property
    def ways(self) -> PlaceGraph:
        """What plans ways over the remembered places."""
        return PlaceGraph(self.places.position)

    @cached_property
    def sense(self) -> int:
        """Whether phase grows to the left (1) or to the right (−1), in a mirrored map."""
        relaxed = self.cmap.relaxed_places_
        if relaxed is None:
            raise CogmapError(
                f"a map without relaxed places does not turn views in the mind: {self.cmap.refine_reason_}"
            )
        return -1 if relaxed.mirrored_ else 1

    @cached_property
    def pace(self) -> float:
        """How far the body got from view to view of the remembered walk, where it went straight on."""
        position, phase = self.places.position, self.places.phase
        turn = wrap_angle(np.diff(phase))
        forward = (np.diff(position, axis=0) * _ahead(phase[:-1] + turn / 2)).sum(axis=1)
        straight = forward[np.abs(turn) < STRAIGHT]
        if not len(straight):
            raise CogmapError("the remembered views are no walk that goes straight on; give a motor model")
        return float(np.median(straight))

    def perceive(self, views: Any) -> tuple[Float[np.ndarray, "views 2"], Float[np.ndarray, "views"]]:
        """Tell where the map perceives views, and in which direction.

        Raises
        ------
        CogmapError
            For views of another size, of one colour, or of nowhere that is remembered.
        """
        views = checked_views(views, self.cmap.view_shape_)
        for index, view in enumerate(views):
            if not np.ptp(view.reshape(-1, 3), axis=0).any():
                raise CogmapError(f"view {index} is of one colour and shows no place; give another")
        activity = self._perceived(views)
        check_known(activity, "view")
        return activity.position.astype(np.float64), activity.phase.astype(np.float64)

    @property
    def _painter(self) -> Painter:
        """What makes views."""
        return Painter(self.places, self.sense)

    @property
    def _comparison(self) -> Comparison:
        """What compares views with what is imagined where they were taken."""
        return Comparison(self._painter, self.sources)

    def _poses(self, views: Any) -> Float[np.ndarray, "views 3"]:
        views = checked_views(views, self.cmap.view_shape_)
        seen = self._perceived(views)
        return np.column_stack([seen.position, seen.phase]).astype(np.float64)

    def _perceived(self, views: Any) -> Activity:
        activity = self.cmap.perceive(views)
        if np.isnan(activity.phase).any():
            raise CogmapError("this map has no compass, so nothing is imagined; explore more")
        if np.isnan(activity.position).any():
            raise CogmapError(
                f"this map tells no positions, so nothing is imagined: {self.cmap.metric_reason_}"
            )
        return activity

    def _walked(
        self, route: Float[np.ndarray, "points 2"], step: float | None, start: float | None, end: float | None
    ) -> Dream:
        step = self.pace / 4 if step is None else step
        poses = stroll(route, step=step, turn=0.1, start=start, end=end)
        return self.at(poses[:, :2], poses[:, 2])


def _ahead(phase: Float[np.ndarray, "views"]) -> Float[np.ndarray, "views 2"]:
    return np.column_stack([np.cos(phase), np.sin(phase)])


def as_pixels(view: Float32[np.ndarray, "*shape"]) -> UInt8[np.ndarray, "*shape"]:
    """Round grey levels to what an image holds."""
    pixels: np.ndarray = np.clip(np.rint(view), 0, 255).astype(np.uint8)
    return pixels
