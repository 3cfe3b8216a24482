"""A visual compass: by how much the body turned between panoramas, and one north for all of them."""

import numpy as np
import scipy.sparse as sp
from jaxtyping import Complex64, Float, Float32, Int
from scipy import fft
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree
from scipy.sparse.linalg import cg

from arena.angles import wrap_angle
from cogmap.features.strips import FREQUENCIES
from cogmap.graph.neighbour_graph import edge_differences

COLUMNS = 2 * (FREQUENCIES - 1)
"""At which a panorama is compared with another."""
BLOCK = 2048
"""Pairs compared at a time."""
OUTLIERS = (np.inf, 0.3, 0.1, 0.03)
"""Error of a turn (rad) from which on it counts less, round by round."""

_f = np.arange(FREQUENCIES, dtype=np.float32)


Series = Complex64[np.ndarray, "views rows frequencies"]
"""Fourier series of the brightness of panoramas, `strips(views).grey`."""
Others = Complex64[np.ndarray, "others rows frequencies"]
"""The same of other panoramas."""


def turns(
    grey: Series, pairs: Int[np.ndarray, "pairs 2"], others: Others | None = None
) -> Float[np.ndarray, "pairs"]:
    r"""Give the heading of the first view of each pair minus that of the second, rad.

    Both must be from places near to each other. A turn shifts a panorama as a whole, a step shifts what is
    near more than what is far: with t and ψ the length and direction of the step and u the nearness
    (1 / distance) of what is seen at azimuth φ, the flow is

    .. math:: s(\varphi) = \Delta + t\,u(\varphi) \sin(\varphi - \psi).

    A correlation over the circle, which takes the mean of s for Δ, is misled wherever one side is nearer than
    the other: walking around a pillar it turns with it. But s(φ) = s(φ + π) only along ±ψ, and s is Δ there.
    So Δ is the mean of ½ [s(φ) + s(φ + π)] with weights that are large where both are equal.

    Parameters
    ----------
    grey, pairs, others
        The first of a pair is a row of `grey`, the second one of `others`, or of `grey` when None.
    """
    seconds = grey if others is None else others
    found = [
        _turns(grey[block[:, 0]], seconds[block[:, 1]])
        for block in np.split(pairs, range(BLOCK, len(pairs), BLOCK))
    ]
    return np.concatenate(found)


def misfit(
    grey: Series,
    pairs: Int[np.ndarray, "pairs 2"],
    turned: Float[np.ndarray, "pairs"],
    others: Others | None = None,
) -> Float[np.ndarray, "pairs"]:
    """Give how unlike two panoramas are once the second is turned to the first, in [0, 2].

    It is Σ |difference|² / Σ (|first|² + |second|²) over all but their means, and 1 for nothing in common.
    """
    seconds = grey if others is None else others
    found = []
    for rows in np.split(np.arange(len(pairs)), range(BLOCK, len(pairs), BLOCK)):
        first, second = grey[pairs[rows, 0], :, 1:], seconds[pairs[rows, 1], :, 1:]
        second = second * np.exp(-1j * turned[rows, None, None].astype(np.float32) * _f[1:])
        power = sum(np.square(np.abs(part)).sum(axis=(1, 2)) for part in (first, second))
        found.append(np.square(np.abs(first - second)).sum(axis=(1, 2)) / (power + 1e-12))
    return np.concatenate(found).astype(np.float64)


def _turns(
    first: Complex64[np.ndarray, "pairs rows frequencies"],
    second: Complex64[np.ndarray, "pairs rows frequencies"],
) -> Float[np.ndarray, "pairs"]:
    # Detail beyond 15 periods around the circle is not trusted to tell the turn at first.
    sharp = (_f * np.exp(-np.square(_f / 15))) ** 2
    likeness = fft.irfft((first * second.conj()).sum(axis=1) * sharp, 2 * COLUMNS, axis=1)
    coarse = likeness.argmax(axis=1).astype(np.float32) * np.float32(np.pi / COLUMNS)
    # Within a blur of 0.1 rad (standard deviation) flow is linear.
    low = np.exp(-0.5 * np.square(0.1 * _f))
    first = first * low
    second = second * np.exp(-1j * coarse[:, None, None] * _f) * low
    change = fft.irfft(second - first, COLUMNS, axis=2)
    slope = fft.irfft((first + second) * (0.5j * _f), COLUMNS, axis=2)
    moved = _windowed((slope * change).sum(axis=1))
    certainty = _windowed(np.square(slope).sum(axis=1))
    # Where nothing has an edge the flow is taken for none.
    flow = moved / (certainty + 1e-3 * certainty.mean(axis=1, keepdims=True) + 1e-12)
    behind = np.roll(flow, COLUMNS // 2, axis=1)
    unequal = np.square(flow - behind)
    weight = 1 / (unequal + 0.1 * np.median(unequal, axis=1, keepdims=True) + 1e-8)
    turn = coarse + (weight * (flow + behind) / 2).sum(axis=1) / weight.sum(axis=1)
    return wrap_angle(turn.astype(np.float64))


def _windowed(values: Float32[np.ndarray, "pairs columns"]) -> Float32[np.ndarray, "pairs columns"]:
    # Within a window of 0.16 rad (standard deviation) flow is one number.
    spectrum = fft.rfft(values, axis=1) * np.exp(-0.5 * np.square(0.16 * _f))
    return np.asarray(fft.irfft(spectrum, COLUMNS, axis=1))


def synchronise_headings(
    graph: sp.csr_array, edges: Int[np.ndarray, "edges 2"], turned: Float[np.ndarray, "edges"]
) -> Float[np.ndarray, "views"]:
    r"""Give each view a heading, so that headings differ over the edges by the turns found there.

    Headings are summed up along the shortest spanning tree and then relaxed to the least

    .. math:: \sum_{ij} \rho\bigl(\Delta_{ij} - (\theta_i - \theta_j)\bigr) / \ell_{ij}^2

    with a loss ρ that counts outliers less, and at first none: around a box turns add up to some degrees too
    many, which all edges of the loop are to share; a loss that is robust from the start leaves them in one
    seam. Each connected piece has a north of its own; the heading of a view without edges is 0.

    Parameters
    ----------
    graph
        Symmetric lengths ℓ between near views.
    edges
        Its edges (i, j), each once.
    turned
        Δ, rad.

    References
    ----------
    Blake & Zisserman (1987), Visual reconstruction: graduated non-convexity.
    """
    views, (rows, columns) = graph.shape[0], edges.T
    headings = np.zeros(views)
    if not len(edges):
        return headings
    lengths = np.asarray(graph[rows, columns])
    signed = sp.csr_array((turned, (rows, columns)), shape=graph.shape)
    signed = sp.csr_array(signed - signed.T)
    tree = minimum_spanning_tree(graph)
    seen = np.diff(graph.indptr) == 0
    for root in range(views):
        if not seen[root]:
            order, before = breadth_first_order(tree, root, directed=False)
            seen[order] = True
            steps = np.asarray(signed[order[1:], before[order[1:]]])
            for view, step in zip(order[1:], steps, strict=True):
                headings[view] = headings[before[view]] + step
    difference = edge_differences(columns, rows, views)
    trust = 1 / np.square(lengths + 0.1 * np.median(lengths))
    for outlier in OUTLIERS:
        left = wrap_angle(turned - difference @ headings)
        weighted = difference.T @ sp.diags_array(trust / (1 + np.square(left / outlier)))
        matrix = sp.csr_array(weighted @ difference)
        scale = sp.diags_array(1 / np.maximum(matrix.diagonal(), 1e-300))
        headings += cg(matrix, weighted @ left, rtol=1e-5, M=scale, maxiter=1000)[0]
    return wrap_angle(headings)
