"""Smell: the steady concentration of odorants that diffuse around the walls and decay."""

import math
import typing
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import shapely
from jaxtyping import Bool, Float, Int
from scipy import ndimage, sparse
from scipy.sparse.linalg import splu

from arena.errors import ArenaError
from arena.kernels import kernel

FAINTEST = 1e-30
"""Concentration where no odour arrives: positive, so that its logarithm and its float32 exist."""


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
        return self._interpolate(xy, 1)[..., 0]

    def gradient(self, xy: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "points odorants 2"]:
        """Differentiate `concentration` by x and y, per m; raises like it."""
        return self._interpolate(xy, 3)[..., 1:]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, OdourField) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @cached_property
    def _key(self) -> tuple[object, ...]:
        arrays = (self.walls, self.sources, *self.solids)
        lengths = (*self.bounds, self.decay_length, self.cell)
        return (*(np.asarray(array, float).tobytes() for array in arrays), lengths)

    def _interpolate(
        self, xy: Float[np.ndarray, "points 2"], terms: int
    ) -> Float[np.ndarray, "points odorants terms"]:
        xy = np.ascontiguousarray(xy, dtype=np.float64)
        log, reached, box = self._table
        out = np.empty((len(xy), log.shape[2], terms))
        outside = _convolve(xy, log, reached, box, out)
        if outside >= 0:
            raise ArenaError(
                f"no odour at {xy[outside].tolist()}: it is outside the room, whose x min, y min, x max, "
                f"y max are {self.bounds}; ask for points inside"
            )
        return out

    @property
    def _shape(self) -> tuple[int, int]:
        extent = np.subtract(self.bounds[2:], self.bounds[:2])
        nx, ny = np.maximum(1, np.rint(extent / self.cell))
        # Above this the factorisation takes more than a few seconds and a gigabyte.
        if nx * ny > (most := 250_000):
            raise ArenaError(
                f"a room of {extent[0]:g} by {extent[1]:g} m needs {nx * ny:.3g} odour cells of "
                f"{self.cell:g} m, more than {most}; make the room smaller"
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
        rings = [np.stack([outline, np.roll(outline, -1, axis=0)], axis=1) for outline in self._outlines]
        return np.concatenate([self.walls, *rings])

    @cached_property
    def _outlines(self) -> list[Float[np.ndarray, "_ 2"]]:
        """Those of the solids, each once: some rooms are made of thousands that coincide."""
        return list({np.asarray(outline, float).tobytes(): outline for outline in self.solids}.values())

    @cached_property
    def _free(self) -> Bool[np.ndarray, "nx ny"]:
        inside = np.zeros(self._shape, dtype=bool)
        for outline in self._outlines:
            inside |= shapely.contains_xy(shapely.Polygon(outline), *np.moveaxis(self._centres, -1, 0))
        return ~inside

    def _parted(
        self, a: Float[np.ndarray, "links 2"], b: Float[np.ndarray, "links 2"]
    ) -> Bool[np.ndarray, "links"]:
        """Whether any wall crosses the way from a to b; a point on a wall belongs to its left."""
        parted = np.zeros(len(a), dtype=bool)
        near = shapely.STRtree(_boxes(a, b))
        for first in range(0, len(self._edges), 1024):
            starts, ends = np.moveaxis(self._edges[first : first + 1024], 1, 0)
            edge, link = near.query(_boxes(starts, ends, margin=1e-6))
            start, along = starts[edge], (ends - starts)[edge]
            side_a, side_b = (
                along[:, 0] * (p[link] - start)[:, 1] - along[:, 1] * (p[link] - start)[:, 0] for p in (a, b)
            )
            crossing = np.flatnonzero((side_a >= 0) != (side_b >= 0))
            link, start, along = link[crossing], start[crossing], along[crossing]
            share = side_a[crossing] / (side_a[crossing] - side_b[crossing])
            hit = a[link] + share[:, None] * (b - a)[link]
            where = ((hit - start) * along).sum(axis=1) / (along**2).sum(axis=1)
            # Walls that share a corner must not leak there by rounding.
            parted[link[(where > -1e-9) & (where < 1 + 1e-9)]] = True
        return parted

    def _spread(self) -> Float[np.ndarray, "cells odorants"]:
        """Each source as weights of the cells around it, summing to one."""
        out = np.zeros((*self._shape, len(self.sources)))
        low, high = np.reshape(self.bounds, (2, 2))
        for odorant, source in enumerate(self.sources):
            if not ((low <= source) & (source <= high)).all():
                raise ArenaError(
                    f"odour source {odorant} at {source.tolist()} is outside the room; move it inside"
                )
            base, fraction = np.divmod((source - low) / self._step - 0.5, 1)
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
    def _table(self) -> tuple[np.ndarray, np.ndarray, Float[np.ndarray, "4"]]:
        return *self._solve(), np.array(self.bounds)

    @lru_cache(maxsize=8)  # noqa: B019  equal fields share one solution, as when many environments load a room
    def _solve(
        self,
    ) -> tuple[Float[np.ndarray, "nx_and_4 ny_and_4 odorants"], Bool[np.ndarray, "nx ny odorants"]]:
        """Log concentration at the cell centres, with two mirrored cells beyond each side; where any arrives.

        A cell in a solid, and for the taps of its neighbours a cell that no odour arrives at, is like the
        nearest that has an odour.
        """
        # One factorisation serves every odorant.
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


def _boxes(
    a: Float[np.ndarray, "lines 2"], b: Float[np.ndarray, "lines 2"], margin: float = 0.0
) -> np.ndarray:
    """Make the boxes around lines from a to b, and a margin more."""
    low, high = np.minimum(a, b) - margin, np.maximum(a, b) + margin
    return np.asarray(shapely.box(*low.T, *high.T))


@kernel()
@typing.no_type_check
def _weights(f: float) -> tuple[float, float, float, float]:
    """Give the weights of the taps at −1, 0, 1, 2 for a fraction f of the way from 0 to 1 (Keys 1981)."""
    # His a = -1/2, the only one with which the error falls as the cube of the cell.
    return (
        0.5 * f * (f * (2 - f) - 1),
        0.5 * (f * f * (3 * f - 5) + 2),
        0.5 * f * (f * (4 - 3 * f) + 1),
        0.5 * f * f * (f - 1),
    )


@kernel()
@typing.no_type_check
def _slopes(f: float) -> tuple[float, float, float, float]:
    """Differentiate `_weights` by the fraction."""
    return (
        0.5 * (f * (4 - 3 * f) - 1),
        0.5 * f * (9 * f - 10),
        0.5 * (f * (8 - 9 * f) + 1),
        0.5 * f * (3 * f - 2),
    )


@kernel()
@typing.no_type_check
def _convolve(xy: np.ndarray, log: np.ndarray, reached: np.ndarray, box: np.ndarray, out: np.ndarray) -> int:
    """Fill out with concentrations and, if it has room, slopes; return a point out of bounds or −1."""
    nx, ny, odorants = reached.shape
    step_x, step_y = (box[2] - box[0]) / nx, (box[3] - box[1]) / ny
    for p in range(len(xy)):
        x, y = xy[p, 0], xy[p, 1]
        if not (box[0] <= x <= box[2] and box[1] <= y <= box[3]):
            return p
        x, y = (x - box[0]) / step_x, (y - box[1]) / step_y
        # On the far border lies the cell beyond the last.
        cell_x, cell_y = min(int(x), nx - 1), min(int(y), ny - 1)
        # Values are at the middles of cells, and `log` has two more at each side: tap i - 1 of the room is
        # row i + 1 of `log`, and the first of four.
        i, j = int(x + 0.5), int(y + 0.5)
        f, g = x + 0.5 - i, y + 0.5 - j
        across, up = _weights(f), _weights(g)
        slope_across, slope_up = _slopes(f), _slopes(g)
        for odorant in range(odorants):
            # Where nothing arrives the logarithm would be minus infinity, and there is no slope.
            if not reached[cell_x, cell_y, odorant]:
                out[p, odorant] = 0.0
                out[p, odorant, 0] = FAINTEST
                continue
            # In logarithms: an odour falls exponentially, and an overshoot never makes it negative.
            value, by_x, by_y = 0.0, 0.0, 0.0
            for a in range(4):
                for b in range(4):
                    tap = log[i + a, j + b, odorant]
                    value += across[a] * up[b] * tap
                    by_x += slope_across[a] * up[b] * tap
                    by_y += across[a] * slope_up[b] * tap
            concentration = math.exp(value)
            out[p, odorant, 0] = concentration
            if out.shape[2] == 3:
                out[p, odorant, 1] = concentration * by_x / step_x
                out[p, odorant, 2] = concentration * by_y / step_y
    return -1
