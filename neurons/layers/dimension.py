"""The dimension of a manifold: in how many directions its neighbourhoods spread."""

from jaxtyping import Float
from torch import Tensor

FLOOR = 1e-3
"""Share of a neighbourhood's variance below which no direction counts: curvature and noise, however they
compare."""


def dimension_votes(
    spectra: Float[Tensor, "neighbourhoods directions"],
) -> Float[Tensor, "directions_less_one"]:
    """Let neighbourhoods vote on the dimension: give the shares of them that tell 1, 2, ….

    Of each, shares of variance λ₁ ≥ λ₂ ≥ … fall most, by the ratio λᵢ / λᵢ₊₁, where the directions along the
    manifold end and those of curvature and noise begin.

    References
    ----------
    Fukunaga & Olsen (1971), An algorithm for finding intrinsic dimensionality of data. IEEE Trans. Comput.
    """
    counted = spectra.clamp(min=FLOOR)
    gaps = (counted[:, :-1] / counted[:, 1:]).argmax(dim=1)
    return gaps.bincount(minlength=spectra.shape[1] - 1) / len(spectra)
