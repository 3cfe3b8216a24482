"""Warping: a view from between remembered ones, which optical flow carries there."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from cogmap.imagination.flow import MARGIN, panoramic_flow, wrapped
from cogmap.imagination.turning import Painted

Map = Float32[np.ndarray, "height width 2"]


def warped(
    views: UInt8[np.ndarray, "sources height width 3"],
    shifts: Float32[np.ndarray, "sources"],
    affine: Float32[np.ndarray, "sources"],
    near: Float32[np.ndarray, "sources"],
) -> Painted:
    r"""Paint the view at a target from those of the places around it.

    Flow from the nearest of them, A, to the others is measured once. Flow varies linearly over near places,
    so the flow from A to the target is

    .. math:: F(p) = \sum_j w_j F_{Aj}(p),

    and the target's pixel p shows what A shows at u, where u + F(u) = p. What A shows there, view j shows at
    u + F_{Aj}(u). Each is sampled once, cubically, and they are averaged: where all are right, noise and
    blur of sampling cancel; where one is hidden behind an edge the others outvote it.

    Parameters
    ----------
    views, shifts
        Panoramas, the nearest first, and the columns by which each is to be turned to the right.
    affine, near
        Weights of flows, and of what is painted (`Sources`); a source without weight is left out.
    """
    used = np.flatnonzero(near)
    whole = np.floor(shifts[used])
    part = shifts[used] - whole
    turned = [np.roll(views[source], int(by), axis=1) for source, by in zip(used, whole, strict=True)]
    flows = [np.zeros((*turned[0].shape[:2], 2), np.float32)]
    flows += [panoramic_flow(turned[0], other) for other in turned[1:]]
    for flow, by in zip(flows, part, strict=True):
        flow[:, :, 0] += by - part[0]
    onwards = np.einsum("s,shwc->hwc", affine[used], np.stack(flows))
    grid = _grid(*turned[0].shape[:2])
    grid[:, :, 0] -= part[0]
    at = grid - onwards
    # flow is smooth and the step short: one more step of this iteration changes less than 0.01 dB
    for _ in range(2):
        at = grid - sampled(onwards, at, cv2.INTER_LINEAR)
    painted = []
    for view, flow, by in zip(turned, flows, part, strict=True):
        where = at + sampled(flow, at, cv2.INTER_LINEAR)
        where[:, :, 0] += part[0] - by
        painted.append(sampled(view.astype(np.float32), where, cv2.INTER_CUBIC))
    return averaged(np.stack(painted), near[used])


def averaged(
    painted: Float32[np.ndarray, "sources height width 3"], near: Float32[np.ndarray, "sources"]
) -> Painted:
    """Average what the sources show, and tell how far they agree."""
    mean = np.einsum("s,shwc->hwc", near, painted)
    spread = np.einsum("s,shwc->hw", near, np.square(painted - mean)) / 3
    return Painted(mean, np.sqrt(spread))


def sampled(image: Float32[np.ndarray, "height width _"], where: Map, how: int) -> np.ndarray:
    """Read a panorama between its pixels."""
    x, y = np.ascontiguousarray(where[:, :, 0] + MARGIN), np.ascontiguousarray(where[:, :, 1])
    return np.asarray(cv2.remap(wrapped(image), x, y, how, borderMode=cv2.BORDER_REPLICATE))


def _grid(height: int, width: int) -> Map:
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    return np.stack([columns, rows], axis=2)
