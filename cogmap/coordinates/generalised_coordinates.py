"""Generalised coordinates: what moves a body whose mechanism nobody has described, from its images alone."""

from __future__ import annotations

from dataclasses import asdict
from math import comb
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
import torch
from jaxtyping import Float, Shaped
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from arena.angles import wrap_angle
from cogmap.coordinates.heights import heights
from cogmap.coordinates.relaxation import read_between, relaxed
from cogmap.coordinates.view_code import ViewCode
from cogmap.errors import CogmapError
from cogmap.features.seam import Eye
from cogmap.graph.neighbour_graph import neighbour_graph
from cogmap.inputs import checked_count, checked_views
from cogmap.map.even_memory import EvenMemory
from cogmap.map.storage import read_state, write_state
from cogmap.shape.agreement import unless_lower_is_unresolved
from cogmap.shape.circular import circular_coordinates
from cogmap.shape.dimension import LocalDimension, local_dimension
from cogmap.shape.homology import Betti, betti
from cogmap.shape.lattice import short_basis

FEWEST = 400
"""Fewer views than this have no shape to speak of."""
KEPT = 4
"""One in so many views is kept at most: of more, those that were babbled where there are hardly any others
are farther from each other than the rest, and make holes."""
MAJORITY, CLEAR = 0.5, 0.9
"""Share of the neighbourhoods that must agree on the dimension, and with which no other scale is tried."""
ONE_SIDED = 5
"""Neighbours that a view is joined to though it is none of theirs: those at the limits of joints look far for
their last ones, and might find them across a fold of the manifold."""
CHECK = 20
"""Neighbours in the graph that must tell as many holes: with more, views at the limits see across folds."""
LANDMARKS = 400
"""On which the cocycles of the loops are found, as many as the loops are counted on."""


class GeneralisedCoordinates(TransformerMixin, BaseEstimator):
    r"""The d parameters of a mechanism with d degrees of freedom, found from images of it or by it.

    Views of a mechanism lie on a manifold homeomorphic to its configurations, if no two of these look alike
    (the Visual Manifold Theorem). Of babbled views it keeps an even memory, and finds there

    - d, the modal gap of the spectra of neighbourhoods (`local_dimension`);
    - how many loops the manifold has, by persistent homology (`betti`), or why that is not sure;
    - one circular coordinate a loop: the harmonic forms in the classes of the longest bars of cohomology,
      and of the lattice of their whole combinations a short basis (`short_basis`);
    - a height for each other degree of freedom: what the loops do not explain of an embedding.

    Topology tells phases only up to an integer change of basis, and each up to a smooth function: no angles
    of joints, but as good to move by.

    Parameters
    ----------
    components
        Of the code that views are compared by.
    memory
        Views kept at most, those farthest from each other (`EvenMemory`), and never more than a quarter of
        them: of 12,000 views 3,000 are enough for two degrees of freedom, of 17,000 4,000 for three.
    eye
        "panorama", or "perspective" for any picture with borders; told from the views when None.
    seed
        Of weights, orders and landmarks; the same seed gives the same arrays.

    Attributes
    ----------
    dimension_, vote_, spectrum_
        d, the share of neighbourhoods that say so, and the shares of variance along their principal axes.
    betti_
        Numbers of pieces, loops and voids, with bars, margins, and whether each is resolved.
    reason_
        Why not all of this is to be trusted, in words; empty when it is.
    eye_
        Which eye the views were taken by, told or found.
    indices_, codes_
        Which of the views are kept, by their places among those that it was fitted to, and their codes.
    coordinates_
        Of the kept views, (kept, loops + heights): phases, rad in (−π, π], then heights, each of deviation 1.
        None where pieces or loops are not resolved, or the manifold falls to pieces.

    Raises
    ------
    CogmapError
        For views that are not uint8 images, and too few of them.

    References
    ----------
    A Visual Sense of Space: the theorem, and coordinates of a spin in its Table 2.
    de Silva, Morozov & Vejdemo-Johansson (2011), Persistent cohomology and circular coordinates.
    """

    def __init__(
        self, *, components: int = 60, memory: int = 4000, eye: Eye | None = None, seed: int = 0
    ) -> None:
        self.components = components
        self.memory = memory
        self.eye = eye
        self.seed = seed

    def fit(self, views: Any, y: object = None) -> GeneralisedCoordinates:
        """Find degrees of freedom, loops and coordinates of views, (views, height, width, 3) uint8."""
        del y
        views = checked_views(views)
        if views.shape[0] < FEWEST:
            raise CogmapError(f"{views.shape[0]} views are too few to show a shape; give at least {FEWEST}")
        self._code = ViewCode(self.components, eye=self.eye, seed=self.seed).fit(views)
        codes = self._code.transform(views)
        size = min(checked_count("memory", self.memory, FEWEST // KEPT), len(codes) // KEPT)
        memory = EvenMemory(size).partial_fit(np.arange(len(codes)), codes)
        self.eye_, self.indices_, self.codes_ = self._code.eye_, memory.indices_.copy(), memory.codes_.copy()
        self.dimension_, self.vote_, self.spectrum_ = _clearest_dimension(self.codes_)
        self.betti_ = unless_lower_is_unresolved(
            betti(self.codes_, one_sided=ONE_SIDED, check=CHECK, seed=self.seed)
        )
        self.reason_ = self._doubts()
        self.coordinates_ = self._locate() if self.located_ else None
        return self

    def transform(self, views: Any) -> Float[np.ndarray, "views coordinates"]:
        """Give the coordinates of views, read between those of the nearest ones that are kept.

        Raises
        ------
        CogmapError
            When there are no coordinates, with the reason; for views of another shape.
        """
        check_is_fitted(self)
        if self.coordinates_ is None:
            raise CogmapError(f"there are no coordinates, unresolved: {self.reason_}")
        parts = self.coordinates_[:, : self.loops_], self.coordinates_[:, self.loops_ :]
        return np.hstack(read_between(self.codes_, *parts, self._code.transform(views)))

    def encode(self, views: Any) -> Float[np.ndarray, "views components"]:
        """Give the codes by which views are compared, as those that are kept have in `codes_`."""
        check_is_fitted(self)
        return self._code.transform(views)

    @property
    def loops_(self) -> int:
        """How many of the coordinates are phases: the first ones."""
        return self.betti_.numbers[1]

    @property
    def located_(self) -> bool:
        """Whether there are coordinates: one piece, and loops that are sure and no more than d."""
        sure = all(self.betti_.resolved[:2])
        return sure and self.betti_.numbers[0] == 1 and self.loops_ <= self.dimension_

    def get_feature_names_out(self, input_features: object = None) -> Shaped[np.ndarray, "coordinates"]:
        """Name the coordinates: `phase_0`, `phase_1`, … (rad), `height_0`, …."""
        del input_features
        others = self.dimension_ - self.loops_
        names = [*(f"phase_{loop}" for loop in range(self.loops_)), *(f"height_{k}" for k in range(others))]
        return np.array(names, dtype=object)

    def save(self, path: str | Path) -> None:
        """Write what was found to a new folder: `weights.safetensors` and `coordinates.json`.

        Raises
        ------
        CogmapError
            When something is at the path already, or it cannot be written.
        """
        check_is_fitted(self)
        arrays = {"indices": self.indices_, "codes": self.codes_, "spectrum": self.spectrum_}
        arrays |= {f"bars_{dimension}": bars for dimension, bars in enumerate(self.betti_.bars)}
        if self.coordinates_ is not None:
            arrays["coordinates"] = self.coordinates_
        weights = {name: torch.from_numpy(np.ascontiguousarray(array)) for name, array in arrays.items()}
        weights |= {f"code.{name}": weight for name, weight in self._code.state().items()}
        learnt = {
            "eye": self.eye_,
            "view_shape": self._code.view_shape_,
            "dimension": self.dimension_,
            "vote": self.vote_,
            "reason": self.reason_,
            "betti": {name: value for name, value in asdict(self.betti_).items() if name != "bars"},
        }
        write_state(path, weights, self.get_params(), learnt, kind="coordinates")

    @classmethod
    def load(cls, path: str | Path) -> GeneralisedCoordinates:
        """Read what `save` wrote.

        Raises
        ------
        CogmapError
            When it is missing, damaged or of another version.
        """
        weights, settings, learnt = read_state(path, kind="coordinates")
        try:
            loaded = cls(**settings)
            arrays = {name: weight.numpy() for name, weight in weights.items() if name[:5] != "code."}
            state = {name.removeprefix("code."): weights[name] for name in weights.keys() - arrays.keys()}
            loaded.eye_, loaded.dimension_, loaded.vote_ = learnt["eye"], learnt["dimension"], learnt["vote"]
            shape = tuple(learnt["view_shape"])
            loaded._code = ViewCode(loaded.components).restore(loaded.eye_, shape, state)
            loaded.indices_, loaded.codes_ = arrays["indices"], arrays["codes"]
            loaded.spectrum_, loaded.coordinates_ = arrays["spectrum"], arrays.get("coordinates")
            found: dict[str, Any] = {
                name: tuple(value) if isinstance(value, list) else value
                for name, value in learnt["betti"].items()
            }
            bars = tuple(arrays[f"bars_{dimension}"] for dimension in range(len(found["numbers"])))
            loaded.betti_, loaded.reason_ = Betti(bars=bars, **found), learnt["reason"]
        except (KeyError, TypeError, ValueError, RuntimeError) as error:
            raise CogmapError(f"{path} does not hold whole coordinates: {error}") from None
        return loaded

    def _doubts(self) -> str:
        """Say all that is not sure, and what does not fit a product of circles and lines."""
        (pieces, loops, voids), d = self.betti_.numbers, self.dimension_
        said = [
            f"{name}: {reason}"
            for name, reason in zip(("pieces", "loops", "voids"), self.betti_.reasons, strict=True)
            if reason
        ]
        if self.vote_ < MAJORITY:
            said.insert(0, f"dimension: only {self.vote_:.0%} of the neighbourhoods say {d}")
        if not said and pieces > 1:
            said.append(f"the views fall into {pieces} pieces that nothing joins; babble more")
        elif not said and (loops > d or voids != comb(loops, 2)):
            said.append(
                f"{d} degrees of freedom with {loops} loops and {voids} voids are no circles and lines"
            )
        return "; ".join(said)

    def _locate(self) -> Float[np.ndarray, "kept coordinates"]:
        codes = self.codes_
        graph = neighbour_graph(codes, one_sided=ONE_SIDED)
        phases = np.empty((len(codes), 0))
        if self.loops_:
            phases = circular_coordinates(graph, self.loops_, landmarks=LANDMARKS, seed=self.seed).phases
            starts, ends = sp.triu(graph, 1).nonzero()
            turns = np.nan_to_num(wrap_angle(phases[ends] - phases[starts]))
            phases = wrap_angle(phases @ short_basis(turns.T @ turns).T)
        count = self.dimension_ - self.loops_
        others = heights(codes, phases, count, one_sided=ONE_SIDED, seed=self.seed)
        # A few that none counts among its nearest lie in pieces of their own.
        lost = np.isnan(np.hstack([phases, others])).any(axis=1)
        if lost.any():
            phases[lost], others[lost] = read_between(codes[~lost], phases[~lost], others[~lost], codes[lost])
        return np.hstack(relaxed(codes, phases, others))


def _clearest_dimension(codes: Float[np.ndarray, "kept components"]) -> LocalDimension:
    """Take the dimension on which most neighbourhoods agree, of all points or ever fewer.

    Where a body moves so slowly that the noise of the eye is wider than the space between views, only points
    farther apart show how it moves.
    """
    clearest = local_dimension(codes)
    while clearest.vote < CLEAR and len(codes) >= 200:
        codes = EvenMemory(len(codes) // 2).partial_fit(codes).codes_
        clearest = max(clearest, local_dimension(codes), key=lambda found: found.vote)
    return clearest
