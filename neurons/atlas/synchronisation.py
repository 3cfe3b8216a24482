"""Synchronisation of signs, then phases, over the atlas: lateral weights turn local axes into one compass."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Complex, Float, Int
from scipy.linalg import eigh
from scipy.sparse import csc_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.sparse.linalg import eigsh
from torch import Tensor

from neurons.angles import wrap_angle
from neurons.atlas.atlas import Atlas
from neurons.errors import NeuronsError


@dataclass(frozen=True)
class Compass:
    """What the charts agree on.

    Attributes
    ----------
    axes
        Heading axes n_k, all turned the same way round.
    scale
        c, rad per unit of code along the axis.
    phases
        φ_k, heading of each chart's centre in the map's own frame, rad.
    sign_agreement
        Σ s_k s_j n_k·n_j / Σ |n_k·n_j| over the overlaps; 1 when the ring can be oriented.
    eigenvalue
        Top eigenvalue of the phase synchronisation; 1 when every overlap agrees.
    walking
        By how much walking turns the compass, rad per unit of code; None where it is taken to turn nothing.
    """

    axes: Float[Tensor, "charts components"]
    scale: float
    phases: Float[Tensor, "charts"]
    sign_agreement: float
    eigenvalue: float
    walking: Float[Tensor, "charts components"] | None = None

    @property
    def turning(self) -> Float[Tensor, "charts components"]:
        """By how much the heading changes in each chart, rad per unit of code."""
        along = self.scale * self.axes
        return along if self.walking is None else along + self.walking

    def turned_to(self, phases: Float[Tensor, "charts"]) -> "Compass":
        """Turn the whole compass, and mirror it if need be, so that it fits known headings best, rad."""
        angle, known = (torch.polar(torch.ones_like(each), each) for each in (self.phases, phases))
        straight, mirrored = (known * angle.conj()).mean(), (known * angle).mean()
        if straight.abs() >= mirrored.abs():
            return replace(self, phases=wrap_angle(self.phases + straight.angle()))
        return replace(
            self,
            axes=-self.axes,
            phases=wrap_angle(mirrored.angle() - self.phases),
            walking=None if self.walking is None else -self.walking,
        )


@dataclass(frozen=True)
class Overlaps:
    """The atlas as a sparse Hermitian matrix of degree-normalised weights, (j, k) conjugate to (k, j)."""

    edges: Int[np.ndarray, "edges 2"]
    count: int

    def top(
        self, weight: Complex[np.ndarray, "edges"], strength: Float[np.ndarray, "edges"] | None = None
    ) -> tuple[float, Complex[np.ndarray, "charts"]]:
        """Largest eigenvalue and its vector, by inverse iteration just above 1, the bound of the spectrum.

        `strength` says how much each overlap counts, all the same unless told.
        """
        k, j = self.edges.T
        counts = np.ones(len(k)) if strength is None else strength
        degree = np.bincount(self.edges.T.ravel(), np.tile(counts, 2), self.count)
        # by degrees: the spectrum is bounded by 1, and charts with many overlaps do not rule
        entry = counts * weight / np.sqrt(degree[k] * degree[j])
        index = (np.r_[k, j], np.r_[j, k])
        matrix = csc_array((np.r_[entry, entry.conj()], index), shape=(self.count, self.count))
        # the eigenvector where no weight has a phase: a start that needs no random numbers
        start = np.sqrt(degree).astype(complex)
        # above the bound, not at it, where the matrix to be factorised would be singular
        value, vector = eigsh(matrix, k=1, sigma=1 + 1e-4, v0=start, tol=1e-8)
        return float(value[0]), vector[:, 0]


def synchronise(
    centres: Float[Tensor, "charts components"],
    axes: Float[Tensor, "charts components"],
    atlas: Atlas,
    *,
    cells: int = 250,
    scales: tuple[float, float, int] = (0.03, 1.5, 80),
) -> Compass:
    """Make local heading axes agree on a direction of turning, a scale and a phase.

    Signs: Z₂ synchronisation, the top eigenvector of the degree-normalised n_k·n_j over the overlaps.
    Phases: with ω_kj = ½ (C_j − C_k)·(n_k + n_j), the Hermitian exp(i c ω) has an eigenvalue near 1 when a
    walk around any loop of charts turns by whole turns. The eigenvalue λ(c) falls as c leaves 0, rises to a
    first interior maximum where the ring closes after exactly one turn, and has others at the harmonics. The
    first is found on cells of charts, refined by a parabola in log c, and the phases of the eigenvector at
    that scale are the headings of the charts.

    Parameters
    ----------
    centres, axes, atlas
        C_k, n_k up to sign, and the overlaps.
    cells
        Groups of charts, turning together, on which the scale is sought: dense eigenvalues of a few hundred
        are fast.
    scales
        Least, greatest and number of the scales tried, in rad per root-mean-square displacement along the
        axis: from 200 overlaps around the ring to four; neighbours on the grid are 5 % apart.

    Raises
    ------
    NeuronsError
        When the atlas falls apart or closes no loop.

    References
    ----------
    Singer (2011), Angular synchronization by eigenvectors and semidefinite programming. ACHA 30.
    """
    overlaps = Overlaps(atlas.edges.cpu().numpy(), len(centres))
    k, j = overlaps.edges.T
    graph = csc_array((np.ones(len(k)), (k, j)), shape=(len(centres),) * 2)
    pieces, _ = connected_components(graph, directed=False)
    if pieces > 1:
        raise NeuronsError(f"the atlas falls into {pieces} pieces; use more charts or more views")
    # in double precision: ω is a small difference of codes, and c·ω is summed around the whole ring
    n, c = axes.double().cpu().numpy(), centres.double().cpu().numpy()
    agreement = np.einsum("ec,ec->e", n[k], n[j])
    _, vector = overlaps.top(agreement.astype(complex))
    # relative to the largest entry, as the phase of an eigenvector is arbitrary
    sign = np.where((vector * vector[np.argmax(np.abs(vector))].conj()).real < 0, -1.0, 1.0)
    n = n * sign[:, None]
    signed = sign[k] * sign[j] * agreement
    omega = 0.5 * np.einsum("ec,ec->e", c[j] - c[k], n[k] + n[j])
    scale, eigenvalue, phases = _close_ring(overlaps, omega, np.geomspace(*scales), cells)
    return Compass(
        axes=torch.from_numpy(n).to(axes),
        scale=scale,
        phases=torch.from_numpy(phases).to(axes),
        sign_agreement=float(signed.sum() / np.abs(agreement).sum()),
        eigenvalue=eigenvalue,
    )


def _close_ring(
    overlaps: Overlaps, omega: Float[np.ndarray, "edges"], scales: Float[np.ndarray, "scales"], cells: int
) -> tuple[float, float, Float[np.ndarray, "charts"]]:
    """Find the scale at which loops close after one turn; it, the eigenvalue there, and the phases."""
    # free of the unit of code: 1 is one radian across a typical overlap
    tried = scales / np.sqrt(np.mean(omega**2))
    values: list[float] = []
    for value in _coarse_eigenvalues(overlaps, omega, tried, cells):
        values.append(value)
        # where nothing closes the eigenvalue is 1 but for rounding, which has maxima too
        if len(values) > 2 and values[-3] < values[-2] >= value and values[-2] - min(values[:-1]) > 1e-6:
            break  # one turn closes at the first maximum; those that follow are its harmonics
    else:
        raise NeuronsError("no loop of charts closes after a turn; use more charts or more views")
    # in log c, in which the grid is even: three points, one parabola, no residual
    near = np.log(tried[len(values) - 3 : len(values)])
    bend, slope, _ = np.polyfit(near, values[-3:], 2)
    scale = float(np.exp(-slope / (2 * bend)))
    eigenvalue, vector = overlaps.top(np.exp(-1j * scale * omega))
    return scale, eigenvalue, np.angle(vector)


def _coarse_eigenvalues(
    overlaps: Overlaps, omega: Float[np.ndarray, "edges"], scales: Float[np.ndarray, "scales"], cells: int
) -> Iterator[float]:
    """Bound the top eigenvalue from below, scale by scale, by Rayleigh and Ritz on cells that turn together.

    Within a cell the phases follow c times the integral of ω from its root along shortest paths, which is
    close to what synchronisation finds; so the bound is tight, and its matrix is small.
    """
    k, j = overlaps.edges.T
    count = overlaps.count
    graph = csc_array((np.ones(len(k)), (k, j)), shape=(count, count))
    roots = np.linspace(0, count - 1, min(cells, count)).astype(int)
    steps, before, source = dijkstra(
        graph, directed=False, unweighted=True, indices=roots, min_only=True, return_predecessors=True
    )
    cell = np.searchsorted(roots, source)
    step = csc_array((np.r_[omega, -omega], (np.r_[k, j], np.r_[j, k])), shape=(count, count)).tocsr()
    # shell by shell, as each potential stands on that of the chart before it
    potential = np.zeros(count)
    for depth in range(1, int(steps.max()) + 1):
        shell = np.flatnonzero(steps == depth)
        potential[shell] = potential[before[shell]] + step[before[shell], shell]
    # 0 along the paths within a cell; what is left is what a cell cannot undo, or the step between two
    across = potential[k] + omega - potential[j]
    size = len(roots)
    pair = cell[k] * size + cell[j]
    degree = np.bincount(cell[overlaps.edges.ravel()], minlength=size)
    norm = 1 / np.sqrt(np.outer(degree, degree))
    for scale in scales:
        turn = np.exp(-1j * scale * across)
        # bincount adds real numbers only, in the order of edges: the same bits every time
        entry = np.bincount(pair, turn.real, size**2) + 1j * np.bincount(pair, turn.imag, size**2)
        half = entry.reshape(size, size) * norm
        yield eigh(half + half.conj().T, eigvals_only=True, subset_by_index=(size - 1, size - 1))[0]
