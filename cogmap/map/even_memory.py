"""Even memory: of a stream of views those that are farthest from each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from jaxtyping import Float, Int, Num, Shaped
from scipy.spatial.distance import cdist

from cogmap.errors import CogmapError
from cogmap.graph.points import checked_cloud
from cogmap.inputs import checked_count
from cogmap.map.storage import read_state, write_state

BATCH = 256
"""Views compared with the memory together; what is kept does not depend on it."""


class EvenMemory:
    """A bounded memory of a stream, spread as evenly over what was seen as farthest points would be.

    Once it is full, a view is kept if it is farther from all that are kept than the two nearest of these are
    from each other, and of those two the newer one is forgotten. So places where a body lingers fill no more
    of the memory than those it passed once, and the holes of the manifold show in fewer views
    (`cogmap.betti`). What is kept depends on the order of the stream, and not on how it is cut into batches.

    Parameters
    ----------
    size
        How many views are kept at most. Up to then every view is new that repeats no other: give half of
        the views that are to come, or fewer.

    Attributes
    ----------
    views_
        The views that are kept, in no order, (kept, ...), as they were given.
    codes_
        What they are compared by, (kept, components), float32.
    indices_
        Their places in the stream, from 0; whatever else was recorded of them is found by these.
    seen_
        Views that came so far.
    spacing_
        Distance from all that are kept beyond which a view is new, in the unit of the codes; 0 until the
        memory is full.

    References
    ----------
    Gonzalez (1985), Clustering to minimize the maximum intercluster distance: farthest points.
    Charikar, Chekuri, Feder & Motwani (2004), Incremental clustering and dynamic information retrieval.
    """

    def __init__(self, size: int = 4000) -> None:
        self.size = size
        self._kept = 0

    def partial_fit(
        self,
        views: Shaped[np.ndarray, "views *shape"],
        codes: Num[np.ndarray, "_ components"] | None = None,
    ) -> EvenMemory:
        """Keep what is new among the next views of a stream.

        Parameters
        ----------
        views
            Images, or whatever else is to be kept, one row each.
        codes
            What they are compared by, as `CognitiveMap.encode` gives; the views themselves when None, which
            takes long for large images.

        Raises
        ------
        CogmapError
            When the codes are not finite, or views or codes do not fit each other or those that came before.
        """
        views = np.asarray(views)
        given = views.reshape(len(views), -1) if codes is None else np.asarray(codes)
        vectors = np.asarray(checked_cloud(given), np.float32)
        if len(vectors) != len(views):
            raise CogmapError(f"there are {len(views)} views but {len(vectors)} codes; give one for each")
        if not hasattr(self, "seen_"):
            self._begin(views, vectors)
        kinds = [(views, self._views, "views"), (vectors, self._codes, "codes")]
        for fresh, kept, name in kinds:
            if fresh.shape[1:] != kept.shape[1:]:
                raise CogmapError(f"{name} of shape {fresh.shape[1:]} cannot stand beside {kept.shape[1:]}")
        for first in range(0, len(views), BATCH):
            self._offer(views[first : first + BATCH], vectors[first : first + BATCH])
        return self

    def save(self, path: str | Path) -> None:
        """Write the memory to a new folder: `weights.safetensors` and `memory.json`.

        Raises
        ------
        CogmapError
            When something is at the path already, it cannot be written, or nothing was seen yet.
        """
        weights = {name: torch.from_numpy(array[: len(self)]) for name, array in self._state.items()}
        write_state(path, weights, {"size": self.size}, {"seen": self.seen_}, kind="memory")

    @classmethod
    def load(cls, path: str | Path) -> EvenMemory:
        """Read a memory that `save` wrote; it goes on as if it had never been away.

        Raises
        ------
        CogmapError
            When it is missing, damaged or of another version.
        """
        weights, settings, learnt = read_state(path, kind="memory")
        try:
            loaded = cls(**settings)
            loaded._begin(weights["views"].numpy(), weights["codes"].numpy())
            loaded.seen_, loaded._kept = learnt["seen"], len(weights["views"])
            for name, array in loaded._state.items():
                array[: len(loaded)] = weights[name].numpy()
        except (KeyError, TypeError, ValueError) as error:
            raise CogmapError(f"{path} does not hold a whole memory: {error}") from None
        return loaded

    def __len__(self) -> int:
        return self._kept

    @property
    def views_(self) -> Shaped[np.ndarray, "kept *shape"]:
        """The views that are kept."""
        return self._state["views"][: len(self)]

    @property
    def codes_(self) -> Float[np.ndarray, "kept components"]:
        """What they are compared by."""
        return self._state["codes"][: len(self)]

    @property
    def indices_(self) -> Int[np.ndarray, "kept"]:
        """Their places in the stream."""
        return self._state["indices"][: len(self)]

    @property
    def spacing_(self) -> float:
        """Distance beyond which a view is new."""
        nearest = self._state["nearest"]
        return float(nearest.min()) if len(self) == len(nearest) else 0.0

    @property
    def _state(self) -> dict[str, np.ndarray]:
        """Everything of one entry per view."""
        if not hasattr(self, "seen_"):
            raise CogmapError("this memory has seen nothing yet; call partial_fit first")
        names = ("views", "codes", "indices", "nearest", "whose")
        return {name: getattr(self, f"_{name}") for name in names}

    def _begin(self, views: np.ndarray, codes: np.ndarray) -> None:
        size = checked_count("size", self.size, 2)
        self.seen_ = self._kept = 0
        self._views = np.empty((size, *views.shape[1:]), views.dtype)
        self._codes = np.empty((size, codes.shape[1]), np.float32)
        self._indices = np.empty(size, np.int64)
        # How far the nearest other one is that is kept, and which it is.
        self._nearest, self._whose = np.full(size, np.inf), np.full(size, -1)

    def _offer(self, views: np.ndarray, codes: np.ndarray) -> None:
        apart = np.full((len(codes), len(self._codes)), np.inf)
        apart[:, : len(self)] = cdist(codes, self.codes_)
        among = cdist(codes, codes)
        for row, distances in enumerate(apart):
            if distances.min() > self.spacing_:
                slot = self._vacate()
                distances[slot] = np.inf
                self._views[slot], self._codes[slot] = views[row], codes[row]
                self._indices[slot] = self.seen_ + row
                self._nearest[slot], self._whose[slot] = distances.min(), distances.argmin()
                closer = distances < self._nearest
                self._nearest[closer], self._whose[closer] = distances[closer], slot
                apart[row + 1 :, slot] = among[row + 1 :, row]
        self.seen_ += len(codes)

    def _vacate(self) -> int:
        """Give a free slot, if need be that of the newer of the two that are nearest to each other."""
        if len(self) < len(self._codes):
            self._kept += 1
            return len(self) - 1
        one = int(self._nearest.argmin())
        slot = max(one, int(self._whose[one]), key=self._indices.__getitem__)
        widowed = np.flatnonzero(self._whose == slot)
        distances = cdist(self._codes[widowed], self._codes)
        distances[:, slot] = distances[np.arange(len(widowed)), widowed] = np.inf
        self._nearest[widowed], self._whose[widowed] = distances.min(axis=1), distances.argmin(axis=1)
        return slot
