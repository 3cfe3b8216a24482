"""Trial of a body: babbled views, the coordinates that are found in them, and what its joints say."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import Axis, Babble, Body, Recording
from arena.eye.base import AnyEye
from cogmap.coordinates import GeneralisedCoordinates, chart_dimension
from cogmap.evaluation.joints import (
    JointReading,
    Windings,
    interpolated_joints,
    joint_errors,
    joint_medians,
    read_joints,
    windings,
)
from cogmap.experiments import Conditions, Result
from cogmap.features.image_codes import sharp_codes
from cogmap.navigation import Localiser
from cogmap.plots import plot_barcodes, plot_coordinates
from cogmap.shape import LocalDimension

Truth: TypeAlias = tuple[Sequence[Axis], Float[np.ndarray, "views joints"]]
"""Axes, and where the body was on each of them."""


def all_axes(body: Body, recording: Recording) -> Truth:
    """Take all axes of a body for what its views can tell."""
    return body.axes, recording.require("joints")


@dataclass(frozen=True, eq=False)
class BodyTrial:
    """What is found in babbled views and measured on fresh ones, worked out when first asked for."""

    body: Body
    walk: Recording
    """Babbled."""
    fresh: Recording
    """Babbled by another seed."""
    coordinates: GeneralisedCoordinates
    """Found in the walk's views."""
    truth: Callable[[Body, Recording], Truth] = all_axes
    """What of the body its views can tell."""

    @classmethod
    def of(
        cls,
        conditions: Conditions,
        body: Body,
        eye: AnyEye,
        *,
        truth: Callable[[Body, Recording], Truth] = all_axes,
    ) -> BodyTrial:
        """Let a body babble twice before an eye or with it, unless told with others, and find coordinates."""
        walk, fresh = (conditions.explore(Babble(), eye, body=body, fresh=again) for again in (False, True))
        found = GeneralisedCoordinates(seed=conditions.seed).fit(walk.views)
        return cls(conditions.body or body, walk, fresh, found, truth)

    @cached_property
    def kept(self) -> Recording:
        """The views that are kept in the even memory."""
        return self.walk[self.coordinates.indices_]

    @property
    def axes(self) -> Sequence[Axis]:
        """Those that views can tell."""
        return self.truth(self.body, self.kept)[0]

    @property
    def joints(self) -> Float[np.ndarray, "kept joints"]:
        """Where the body was on them when the views were taken that are kept."""
        return self.truth(self.body, self.kept)[1]

    @property
    def circles(self) -> list[bool]:
        """Which of the axes are circles."""
        return [axis.kind == "circle" for axis in self.axes]

    @cached_property
    def charted(self) -> LocalDimension:
        """Degrees of freedom as charts of all views of the walk tell them."""
        found = self.coordinates
        return chart_dimension(found.encode(self.walk.views), seed=found.seed)

    @cached_property
    def located(self) -> Float[np.ndarray, "fresh joints"]:
        """Errors (rad, m) of joints that a `Localiser` reads for the fresh views from those that are kept."""
        known, seen = (sharp_codes(part.views) for part in (self.kept, self.fresh))
        codes = self.coordinates.encode(self.fresh.views)
        localiser = Localiser(
            self.coordinates.codes_, codes=known, neighbours=15, ridge=1e-3, metric="euclidean"
        )
        read = interpolated_joints(*localiser.locate(codes, codes=seen), self.joints, self.circles)
        return joint_errors(read, self.truth(self.body, self.fresh)[1], self.circles)

    @cached_property
    def regression(self) -> JointReading | None:
        """Joints regressed on the coordinates; None where there are none."""
        found = self.coordinates
        if found.coordinates_ is None:
            return None
        return read_joints(found.coordinates_, found.loops_, self.joints, self.circles)

    @cached_property
    def windings(self) -> Windings | None:
        """How phases wind around joints; None without phases."""
        found = self.coordinates
        if found.coordinates_ is None or not found.loops_:
            return None
        return windings(found.coordinates_[:, : found.loops_], self.joints, self.circles)

    @property
    def metrics(self) -> dict[str, Any]:
        """Degrees of freedom, holes, and how well joints are read; in m those that slide."""
        found, units = self.coordinates, [axis.unit for axis in self.axes]
        read, turned = self.regression, self.windings
        return {
            "eye": found.eye_,
            "dimension": found.dimension_,
            "dimension_vote": found.vote_,
            "charts_dimension": self.charted.dimension,
            "charts_vote": self.charted.vote,
            "betti": list(found.betti_.numbers),
            "betti_resolved": list(found.betti_.resolved),
            "betti_margins": [list(margins) for margins in found.betti_.margins],
            "reason": found.reason_,
            "joints": [axis.name for axis in self.axes],
            "joint_median_deg": joint_medians(self.located, units),
            "regression_median_deg": None if read is None else joint_medians(read.errors, units),
            "regression_correlation": None if read is None else read.correlations.tolist(),
            "windings": None if turned is None else turned.matrix.tolist(),
            "windings_determinant": None if turned is None else turned.determinant,
            "memory_views": len(self.kept),
        }

    def result(self, name: str) -> Result:
        """Give all of it under the name of the cloud of views, with a sheet of views and the barcode."""
        found = self.coordinates
        table = pd.DataFrame({axis.name: part for axis, part in zip(self.axes, self.joints.T, strict=True)})
        figures = {"barcodes": plot_barcodes({name: found.betti_})}
        if found.coordinates_ is not None:
            names = list(found.get_feature_names_out())
            table = table.join(pd.DataFrame(found.coordinates_, columns=names))
            figures["coordinates"] = plot_coordinates(
                found.coordinates_, names, np.asarray(self.kept.views), self.joints, self.axes
            )
        return Result(
            self.metrics,
            tables={"kept_views": table},
            figures=figures,
            captions={
                "coordinates": "Views laid out by the coordinates found in them, and the true joints there"
            },
        )
