"""Hypotheses about where a view was taken where places look alike: Markov localisation on a memory."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import KDTree
from sklearn.decomposition import PCA

from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.threads import one_thread

COMPONENTS = 60
"""Of the codes."""
NEAREST = 250
"""Remembered views, by looks, that hypotheses are made of."""
ALIKE = 2.0
"""How many times farther than the nearest, or than is usual, these may be."""
SPOT, APART = 1.0, 4.0
"""Usual differences of smell within which views belong to a place, and from which on places are apart."""
BESIDE = 3
"""Views of the walk before and after one, by which it is told in what direction smells change."""
SAMPLE = 400
"""Remembered views that tell what is usual."""


@dataclass(eq=False)
class SceneMemory:
    """Remembers views and smells of a walk, so that views that look alike are told apart by smell.

    A place is told by what was smelt there, and a direction by how that changed as the walk went on, because
    a body goes where it looks. Neither needs a pose.

    Parameters
    ----------
    codes
        What the views look like, as of `image_codes`, in the order of the walk.
    smells
        Log concentration of odorants where they were taken.

    Raises
    ------
    CogmapError
        At first use: for arrays that are not finite or do not fit, and fewer than 250 views.
    """

    codes: Float[np.ndarray, "views features"]
    smells: Float[np.ndarray, "views odorants"]

    def looks(self, codes: Float[np.ndarray, "queries features"]) -> Float[np.ndarray, "queries components"]:
        """Give the principal components of other codes."""
        with one_thread():
            return np.asarray(self._axes.transform(codes), np.float64)

    @cached_property
    def known(self) -> Float[np.ndarray, "views components"]:
        """Principal components of the remembered codes."""
        return self.looks(self.codes)

    @cached_property
    def places(self) -> Float[np.ndarray, "views odorants"]:
        """Smell of each view, the mean over five of the walk."""
        return self._means(-2, 3)

    @cached_property
    def courses(self) -> Float[np.ndarray, "views odorants"]:
        """How smell changes along the walk about each view."""
        return np.asarray(self._means(1, 1 + BESIDE) - self._means(-BESIDE, 0))

    @cached_property
    def spot(self) -> float:
        """Difference of smell within which views belong to a place."""
        return SPOT * float(np.median(np.linalg.norm(self.places[5:] - self.places[:-5], axis=1)))

    @cached_property
    def usual(self) -> float:
        """How unlike a view is at most (95 %) to the most similar other of its place and direction."""
        told = []
        for view in np.unique(np.linspace(0, len(self.known) - 1, SAMPLE).astype(int)):
            there = self.around(self.places[view], self.courses[view])
            there = there[np.abs(there - view) > BESIDE]
            if len(there):
                told.append(np.linalg.norm(self.known[there] - self.known[view], axis=1).min())
        if not told:
            raise CogmapError("no place was visited twice on this walk; remember more views")
        return float(np.percentile(told, 95))

    def around(
        self, place: Float[np.ndarray, "odorants"], course: Float[np.ndarray, "odorants"]
    ) -> Int[np.ndarray, "near"]:
        """Give the remembered views of a place in about a direction."""
        there = np.array(self._tree.query_ball_point(place, self.spot), int)
        return np.sort(there[self.courses[there] @ course > 0])

    @cached_property
    def _axes(self) -> PCA:
        check_array("codes", self.codes, (None, None))
        check_array("smells", self.smells, (len(self.codes), None))
        if len(self.codes) < NEAREST:
            raise CogmapError(f"{len(self.codes)} views are no memory; give at least {NEAREST}")
        with one_thread():
            return PCA(min(COMPONENTS, *self.codes.shape), svd_solver="covariance_eigh").fit(self.codes)

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self.places)

    def _means(self, first: int, last: int) -> Float[np.ndarray, "views odorants"]:
        """Mean smell of the views from the first to before the last after each, as far as there are."""
        count = len(self.smells)
        sums = np.concatenate([np.zeros((1, self.smells.shape[1])), np.cumsum(self.smells, axis=0)])
        here = np.arange(count)
        low = np.clip(here + first, 0, count - 1)
        high = np.maximum(np.clip(here + last, 1, count), low + 1)
        means: np.ndarray = (sums[high] - sums[low]) / (high - low)[:, None]
        return means


class Hypotheses:
    """Where a view may have been taken, and what further looks from there, in other directions, say of it.

    The remembered views most like the first look fall into places and directions: a hypothesis each. Under
    each something remembered of that place must look like every further look; how unlike the most similar
    is, over what is usual, is counted against it, as a Gaussian log-likelihood.

    Parameters
    ----------
    memory
        What is remembered.
    look
        Components (`SceneMemory.looks`) of the first view.

    Attributes
    ----------
    evidence_ : (hypotheses,)
        Log-likelihood of each.
    view_
        The remembered view, of the place that is most likely, that is most like the last look.
    lead_
        By how much that place is ahead of all that are apart from it; infinite where there is none.
    """

    def __init__(self, memory: SceneMemory, look: Float[np.ndarray, "components"]) -> None:
        self._memory = memory
        unlike = np.linalg.norm(memory.known - look, axis=1)
        near = np.argsort(unlike, kind="stable")[:NEAREST]
        left = near[unlike[near] <= ALIKE * max(unlike[near[0]], memory.usual)]
        places, courses = [], []
        while len(left):
            same = np.linalg.norm(memory.places[left] - memory.places[left[0]], axis=1) < 2 * memory.spot
            same &= memory.courses[left] @ memory.courses[left[0]] > 0
            same[0] = True
            places.append(memory.places[left[same]].mean(axis=0))
            courses.append(memory.courses[left[same]].mean(axis=0))
            left = left[~same]
        self._places, self._courses = np.array(places), np.array(courses)
        found = [memory.around(place, course) for place, course in zip(places, courses, strict=True)]
        self._views = [views if len(views) else near[:1] for views in found]
        self.evidence_ = np.zeros(len(places))
        self.weigh(look)

    def weigh(self, look: Float[np.ndarray, "components"]) -> None:
        """Take account of another look."""
        memory = self._memory
        unlike = [np.linalg.norm(memory.known[views] - look, axis=1) for views in self._views]
        self.evidence_ -= np.square([each.min() / memory.usual for each in unlike]) / 2
        best = int(self.evidence_.argmax())
        self.view_ = int(self._views[best][unlike[best].argmin()])
        rivals = self._apart(best)
        self.lead_ = float(self.evidence_[best] - self.evidence_[rivals].max()) if rivals.any() else np.inf

    def _apart(self, best: int) -> Bool[np.ndarray, "hypotheses"]:
        """Tell which hypotheses are of another place or direction."""
        near = np.linalg.norm(self._places - self._places[best], axis=1) < APART * self._memory.spot
        near &= self._courses @ self._courses[best] > 0
        near[best] = True
        return np.asarray(~near)
