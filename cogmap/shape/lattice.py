"""Lattice reduction: the shortest basis among all that integers make of one."""

import numpy as np
from jaxtyping import Int

from cogmap.inputs import AnyArray, checked_array


def short_basis(gram: AnyArray) -> Int[np.ndarray, "vectors vectors"]:
    """Find whole numbers B, det B = ±1, such that the basis B b of the lattice of b is short.

    From a vector the multiple of another is taken off that shortens it most, while any can be shortened
    (Lagrange's reduction, by pairs). Of two vectors these are the shortest there are, and of three or four
    hardly longer. The shortest comes first.

    Parameters
    ----------
    gram
        Inner products of the vectors b.

    References
    ----------
    Seysen (1993), Simultaneous reduction of a lattice basis and its reciprocal basis. Combinatorica 13.
    """
    gram = checked_array("gram", gram, (None, None))
    basis = np.eye(len(gram), dtype=np.int64)
    pairs = [(i, j) for i in range(len(gram)) for j in range(len(gram)) if i != j]
    shortened = True
    while shortened:
        shortened = False
        for i, j in pairs:
            products = basis @ gram @ basis.T
            times = round(float(products[i, j] / products[j, j]))
            # A tie would be taken off and put on again for ever.
            if times and abs(products[i, j]) > (0.5 + 1e-9) * products[j, j]:
                basis[i] -= times * basis[j]
                shortened = True
    order = np.argsort(np.diagonal(basis @ gram @ basis.T), kind="stable")
    return np.asarray(basis[order])
