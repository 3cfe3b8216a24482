"""Smell: the steady concentration of odorants that diffuse around the walls and decay."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from jaxtyping import Bool, Float, Int
from scipy import ndimage, sparse
from scipy.sparse.linalg import splu

from arena.errors import ArenaError

FAINTEST = 1e-30
"""Concentration where no odour arrives: positive, so that its logarithm and its float32 exist."""
MOST_CELLS = 250_000
"""Above this the factorisation takes more than a few seconds and a gigabyte."""

_TAPS = np.arange(-1, 3)
# Cubic convolution: the weight of each tap is a polynomial in the fraction, lowest power first (Keys 1981).
_KEYS = 0.5 * np.array([[0, -1, 2, -1], [2, 0, -5, 3], [0, 1, 4, -3], [0, 0, -1, 1]])


@dataclass(frozen=True, kw_only=True, eq=False)
class OdourField:
    r"""Steady screened diffusion from point sources in a room.

    .. math:: -\nabla^2 c + c / \lambda^2 = \delta(x - x_s), \quad \partial_n c = 0 \text{ on walls}

    so that in the open :math:`c = K_0(r / \lambda) / 2\pi`. Solved by finite volumes: a wall blocks the flux
    between the cell centres it parts, cells inside solids are left out, nothing leaves through `bounds`. A
    source is shared out bilinearly among the cells around it that it sees, which makes c finite within a cell
    of it. Between cell centres log c is interpolated by cubic convolution, which has continuous derivatives
    and reaches two cells far; nearer than that to a wall inside `bounds` it blends both of the wall's sides,
    unless no odour arrives at one of them: within half a cell of such a wall it drops to `FAINTEST`.

    Parameters
    ----------
    walls
        Ends of thin walls, m.
    solids
        Outlines of boxes and pillars, m, counter-clockwise.
    bounds
        The grid's box: x min, y min, x max, y max in m.
    sources
        Where each odorant comes from, m.
    decay_length
        λ in m.
    cell
        About how wide a cell is, m; it is made to divide `bounds`.

    Raises
    ------
    ArenaError
        For a decay length or cell that is not a positive number.

    References
    ----------
    R. G. Keys (1981), Cubic convolution interpolation for digital image processing, IEEE Trans. ASSP 29.
    """

    walls: Float[np.ndarray, "walls 2 2"]
    solids: list[Float[np.ndarray, "_ 2"]]
    bounds: tuple[float, float, float, float]
    sources: Float[np.ndarray, "odorants 2"]
    decay_length: float
    cell: float = 0.05

    def __post_init__(self) -> None:
        for name, value in (("decay_length", self.decay_length), ("cell", self.cell)):
            if not 0 < value < np.inf:
                raise ArenaError(f"{name} is {value} m; give a positive length")

    def concentration(self, xy: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points odorants"]:
        """Concentration (source strength over diffusivity) of every odorant at each point (m).

        Raises
        ------
        ArenaError
            For points out of bounds, and for a room or source that the grid cannot resolve.
        """
        out: np.ndarray = np.exp(self._interpolate(xy, (0, 0)))
        return out

    def gradient(self, xy: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points odorants 2"]:
        """Differentiate `concentration` by x and y, per m; raises like it."""
        slopes = np.stack([self._interpolate(xy, (1, 0)), self._interpolate(xy, (0, 1))], axis=-1)
        out: np.ndarray = self.concentration(xy)[..., None] * slopes
        return out

    def _interpolate(
        self, xy: Float[np.ndarray, "points 2"], order: tuple[int, int]
    ) -> Float[np.ndarray, "points odorants"]:
        within = self._within(xy)
        if not within.all():
            raise ArenaError(
                f"no odour at {xy[~within][0].tolist()}: it is outside the room, whose x min, y min, x max, "
                f"y max are {self.bounds}; ask for points inside"
            )
        base, fraction = np.divmod((xy - self.bounds[:2]) / self._step - 0.5, 1)
        index = base.astype(int)[:, :, None] + _TAPS + len(_TAPS) // 2
        wx, wy = (
            _weights(fraction[:, axis], order[axis]) / self._step[axis] ** order[axis] for axis in (0, 1)
        )
        log, reached = self._log
        samples = log[index[:, 0, :, None], index[:, 1, None, :]]
        out: np.ndarray = np.einsum("pi,pj,pijk->pk", wx, wy, samples)
        i, j = np.minimum((xy - self.bounds[:2]) // self._step, np.subtract(self._shape, 1)).astype(int).T
        return np.where(reached[i, j], out, 0.0 if any(order) else np.log(FAINTEST))

    def _within(self, xy: Float[np.ndarray, "points 2"]) -> Bool[np.ndarray, " points"]:
        low, high = np.reshape(self.bounds, (2, 2))
        return np.asarray(((xy >= low) & (xy <= high)).all(axis=1))

    @property
    def _shape(self) -> tuple[int, int]:
        extent = np.subtract(self.bounds[2:], self.bounds[:2])
        nx, ny = np.maximum(1, np.rint(extent / self.cell))
        if nx * ny > MOST_CELLS:
            raise ArenaError(
                f"a room of {extent[0]:g} by {extent[1]:g} m needs {nx * ny:.3g} odour cells of "
                f"{self.cell:g} m, more than {MOST_CELLS}; make the room smaller"
            )
        return int(nx), int(ny)

    @cached_property
    def _step(self) -> Float[np.ndarray, "2"]:
        return np.subtract(self.bounds[2:], self.bounds[:2]) / self._shape

    @cached_property
    def _centres(self) -> Float[np.ndarray, "nx ny 2"]:
        grid = np.stack(np.meshgrid(*map(np.arange, self._shape), indexing="ij"), axis=-1)
        out: np.ndarray = self.bounds[:2] + (grid + 0.5) * self._step
        return out

    @cached_property
    def _edges(self) -> Float[np.ndarray, "edges 2 2"]:
        rings = [np.stack([outline, np.roll(outline, -1, axis=0)], axis=1) for outline in self.solids]
        return np.concatenate([self.walls, *rings])

    @cached_property
    def _free(self) -> Bool[np.ndarray, "nx ny"]:
        inside = np.zeros(self._shape, dtype=bool)
        for outline in self.solids:
            inside |= shapely.contains_xy(shapely.Polygon(outline), *np.moveaxis(self._centres, -1, 0))
        return ~inside

    def _parted(
        self, a: Float[np.ndarray, "links 2"], b: Float[np.ndarray, "links 2"]
    ) -> Bool[np.ndarray, "links"]:
        """Whether any wall crosses the way from a to b; a point on a wall belongs to its left."""
        parted = np.zeros(len(a), dtype=bool)
        for start, end in self._edges:
            along = end - start
            side_a, side_b = (along[0] * (p - start)[:, 1] - along[1] * (p - start)[:, 0] for p in (a, b))
            crossing = np.flatnonzero((side_a >= 0) != (side_b >= 0))
            share = side_a[crossing] / (side_a[crossing] - side_b[crossing])
            hit = a[crossing] + share[:, None] * (b - a)[crossing]
            where = (hit - start) @ along / (along @ along)
            # Walls that share a corner must not leak there by rounding.
            parted[crossing] |= (where > -1e-9) & (where < 1 + 1e-9)
        return parted

    def _spread(self) -> Float[np.ndarray, "cells odorants"]:
        """Each source as weights of the cells around it, summing to one."""
        out = np.zeros((*self._shape, len(self.sources)))
        for odorant, source in enumerate(self.sources):
            if not self._within(source[None])[0]:
                raise ArenaError(
                    f"odour source {odorant} at {source.tolist()} is outside the room; move it inside"
                )
            base, fraction = np.divmod((source - self.bounds[:2]) / self._step - 0.5, 1)
            corners = base.astype(int) + np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
            weight = np.prod(np.where(corners > base, fraction, 1 - fraction), axis=1)
            # Outside the grid is the mirror image of the cell inside.
            i, j = np.clip(corners, 0, np.subtract(self._shape, 1)).T
            centres = self._centres[i, j]
            weight *= self._free[i, j] & ~self._parted(np.broadcast_to(source, centres.shape), centres)
            if weight.sum() < 1e-6:
                raise ArenaError(
                    f"odour source {odorant} at {source.tolist()} lies in a gap too narrow for odour cells "
                    f"of {self.cell:g} m; move it into open space"
                )
            np.add.at(out, (i, j, odorant), weight / weight.sum())
        return out.reshape(self._free.size, len(self.sources))

    def _matrix(self) -> sparse.csc_array:
        """Assemble the finite-volume operator of the free cells and, for the others, the identity."""
        label: Int[np.ndarray, "nx ny"] = np.arange(self._free.size).reshape(self._shape)
        centres, free = self._centres.reshape(-1, 2), self._free.ravel()
        area = float(np.prod(self._step))
        entries = [np.where(free, area / self.decay_length**2, 1.0)]
        rows, columns = [label.ravel()], [label.ravel()]
        for axis in (0, 1):
            a, b = (np.delete(label, end, axis).ravel() for end in (-1, 0))
            joined = free[a] & free[b] & ~self._parted(centres[a], centres[b])
            a, b = a[joined], b[joined]
            flux = np.full(len(a), area / self._step[axis] ** 2)
            entries += [flux, flux, -flux, -flux]
            rows += [a, b, a, b]
            columns += [a, b, b, a]
        where = np.concatenate(rows), np.concatenate(columns)
        return sparse.coo_array((np.concatenate(entries), where), shape=2 * (free.size,)).tocsc()

    @cached_property
    def _log(
        self,
    ) -> tuple[Float[np.ndarray, "nx_and_4 ny_and_4 odorants"], Bool[np.ndarray, "nx ny odorants"]]:
        """Log concentration at the cell centres, with two mirrored cells beyond each side; where any arrives.

        A cell in a solid, and for the taps of its neighbours a cell that no odour arrives at, is like the
        nearest that has an odour.
        """
        concentration = splu(self._matrix()).solve(self._spread()).reshape(*self._shape, len(self.sources))
        if not self._free.any():
            raise ArenaError("the odour has no free cell to be in; make room between the solids")
        concentration = concentration[self._nearest(self._free)]
        reached = concentration > FAINTEST
        for odorant in np.flatnonzero(~reached.all(axis=(0, 1))):
            concentration[..., odorant] = concentration[..., odorant][self._nearest(reached[..., odorant])]
        return np.pad(np.log(concentration), ((2, 2), (2, 2), (0, 0)), mode="symmetric"), reached

    def _nearest(self, cells: Bool[np.ndarray, "nx ny"]) -> tuple[Int[np.ndarray, "nx ny"], ...]:
        """For every cell the indices of the nearest of these."""
        return tuple(
            ndimage.distance_transform_edt(
                ~cells, sampling=self._step, return_distances=False, return_indices=True
            )
        )


def _weights(fraction: Float[np.ndarray, "points"], order: int) -> Float[np.ndarray, "points 4"]:
    """Weights of the taps at −1, 0, 1, 2, or their derivatives by the fraction."""
    power = np.arange(4)
    lowered = power * fraction[:, None] ** np.maximum(power - 1, 0) if order else fraction[:, None] ** power
    out: np.ndarray = lowered @ _KEYS.T
    return out
