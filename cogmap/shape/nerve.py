"""The nerve of a population: which cells fire together, and the holes that this leaves."""

import math
from dataclasses import dataclass

import gudhi
import numpy as np
from jaxtyping import Bool, Int

from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_count, checked_rates

ACTIVE = math.exp(-2)
"""Share of its peak at which a cell counts as active: within two standard deviations of a Gaussian field."""


@dataclass(frozen=True)
class Nerve:
    """A nerve complex, as its Betti numbers and its size."""

    numbers: tuple[int, ...]
    """Pieces, loops, voids."""
    simplices: tuple[int, ...]
    """How many cells, pairs, triples … are active together; one entry more than `numbers`."""


def population_nerve(
    rates: AnyArray,
    *,
    max_dimension: int = 1,
    active: float = ACTIVE,
    together: int = 3,
) -> Nerve:
    """Count the pieces, loops and voids of what a population covers, from who fires with whom alone.

    The set U_i of the views in which cell i is active covers a part of what the population codes. The nerve
    has a simplex {i, j, …} wherever U_i ∩ U_j ∩ … holds at least `together` views. Where these intersections
    are without holes themselves, as those of convex fields are, the nerve has the holes of the union of all
    U_i (the nerve theorem): no positions, no distances, no scale.

    Parameters
    ----------
    rates
        Hz, of one population. A cell that never fires is left out.
    max_dimension
        Highest dimension of homology, 0 to 2; sets of up to `max_dimension` + 2 cells are looked at.
    active
        Share of its own peak rate that a cell must reach, above 0 and at most 1.
    together
        Fewest views in which cells must be active together; of three, one odd view joins nothing.

    Raises
    ------
    CogmapError
        For NaN, wrong shapes or negative rates, a share or counts out of range, a population that is silent.

    References
    ----------
    Curto & Itskov (2008), Cell groups reveal structure of stimulus space. PLoS Comput. Biol. 4.
    Borsuk (1948), On the imbedding of systems of compacta in simplicial complexes. Fundam. Math. 35.
    """
    if not 0 <= max_dimension <= 2:
        raise CogmapError(f"max_dimension is {max_dimension}; expected 0, 1 or 2")
    if not 0 < active <= 1:
        raise CogmapError(f"active is {active:g}; expected a share of the peak rate, above 0 and at most 1")
    checked_count("together", together)
    rates = checked_rates(rates)
    peak = rates.max(axis=0)
    fires = (rates >= active * peak) & (peak > 0)
    complex_ = gudhi.SimplexTree()
    _grow(complex_, [], np.arange(len(fires)), fires, together=together, most=max_dimension + 2)
    if complex_.is_empty():
        raise CogmapError(
            f"no cell is active in {together} views; give more views, or rates that are not all zero"
        )
    # Coefficients modulo 11, as in `rips_bars`.
    complex_.compute_persistence(homology_coeff_field=11, persistence_dim_max=True)
    found = complex_.betti_numbers()[: max_dimension + 1]
    sizes = np.bincount(
        [len(simplex) - 1 for simplex, _ in complex_.get_simplices()], minlength=max_dimension + 2
    )
    numbers = [*found, *[0] * (max_dimension + 1 - len(found))]
    return Nerve(tuple(numbers), tuple(int(size) for size in sizes))


def _grow(
    complex_: gudhi.SimplexTree,
    simplex: list[int],
    views: Int[np.ndarray, "shared"],
    fires: Bool[np.ndarray, "views cells"],
    *,
    together: int,
    most: int,
) -> None:
    """Add every set of at most `most` cells that begins with `simplex`, whose shared views are given."""
    shared = fires[views].sum(axis=0)
    first = simplex[-1] + 1 if simplex else 0
    for cell in first + np.flatnonzero(shared[first:] >= together):
        larger = [*simplex, int(cell)]
        complex_.insert(larger)
        if len(larger) < most:
            _grow(complex_, larger, views[fires[views, cell]], fires, together=together, most=most)
