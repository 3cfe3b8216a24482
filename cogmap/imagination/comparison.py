"""Comparison of views with what is imagined at their poses, which are corrected by what fits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Float32, Int

from cogmap.imagination.alignment import Seen, aligned, coarse
from cogmap.imagination.painter import Painter
from cogmap.imagination.surprise import unusual
from cogmap.threads import in_order, one_thread


@dataclass(frozen=True)
class Comparison:
    """Imagines views at their own poses, and compares."""

    painter: Painter
    sources: int
    """Places that a view is made of."""
    without: Int[np.ndarray, "views"] | None = None
    """Which remembered views these are themselves, if they are: of their visits nothing is used."""

    def seen(self, views: Any, poses: Float[np.ndarray, "views 3"], *, again: bool = False) -> Seen:
        """Imagine what views show at their poses, and compare; `again`, by flow from the second source."""
        sources = self.painter.places.sources(poses[:, :2], self.sources, without=self.without)
        sources = sources.second_first() if again else sources
        dreamt = self.painter.painted(sources, poses[:, 2])
        turned = self.painter.painted(sources.alone(), poses[:, 2], "turned")

        def compared(view: int) -> tuple[Float32[np.ndarray, "pixels"], Float32[np.ndarray, "height width"]]:
            painted = dreamt(view)
            return coarse(painted.view), unusual(views[view], painted, turned(view).view)

        with one_thread():
            found = list(in_order(compared, range(len(poses))))
        return Seen(*map(np.stack, zip(*found, strict=True)))

    def aligned(
        self, views: Any, poses: Float[np.ndarray, "views 3"], there: Seen
    ) -> tuple[Float[np.ndarray, "views 3"], Seen]:
        """Correct poses, from what is imagined there, until it fits."""
        places = self.painter.places

        def quick(where: Float[np.ndarray, "views 3"]) -> Float32[np.ndarray, "views pixels"]:
            sources = places.sources(where[:, :2], self.sources, without=self.without)
            painted = self.painter.paint(sources, where[:, 2], "blend")
            return np.stack([coarse(each.view) for each in painted])

        small = np.stack([coarse(view) for view in views])
        reach = np.array([places.spacing / 2, places.spacing / 2, 0.01])
        return aligned(
            small, poses, there, fine=lambda where: self.seen(views, where), quick=quick, reach=reach
        )

    def judged(
        self, views: Any, poses: Float[np.ndarray, "views 3"], there: Seen
    ) -> tuple[Float[np.ndarray, "views 3"], Float32[np.ndarray, "views height width"]]:
        """Correct poses, and tell what is unusual there however it is imagined.

        Flow goes wrong beside a box, but from two places hardly at the same pixels.
        """
        poses, there = self.aligned(views, poses, there)
        return poses, np.minimum(there.unusual, self.seen(views, poses, again=True).unusual)
