"""Warping: a view from between remembered ones, which optical flow carries there."""

from __future__ import annotations

import typing

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from cogmap.imagination.flow import MARGIN, panoramic_flow, wrapped
from cogmap.imagination.turning import Painted
from cogmap.kernels import kernel

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
    onwards = np.zeros_like(flows[0])
    for weight, flow in zip(affine[used], flows, strict=True):
        onwards += weight * flow
    grid = _grid(*turned[0].shape[:2])
    grid[:, :, 0] -= part[0]
    at = grid - onwards
    # flow is smooth and the step short: one more step of this iteration changes less than 0.01 dB
    for _ in range(2):
        at = grid - sampled(onwards, at, cv2.INTER_LINEAR)
    painted = np.empty((len(used), *turned[0].shape), np.float32)
    for shown, view, flow, by in zip(painted, turned, flows, part, strict=True):
        where = at + sampled(flow, at, cv2.INTER_LINEAR)
        where[:, :, 0] += part[0] - by
        shown[:] = sampled(view.astype(np.float32), where, cv2.INTER_CUBIC)
    return averaged(painted, near[used])


def averaged(
    painted: Float32[np.ndarray, "sources height width 3"], near: Float32[np.ndarray, "sources"]
) -> Painted:
    """Average what the sources show, and tell how far they agree."""
    return Painted(*_averaged(painted, near))


@kernel(nogil=True)
@typing.no_type_check
def _averaged(painted: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    sources, height, width, _ = painted.shape
    mean = np.zeros((height, width, 3), np.float32)
    spread = np.zeros((height, width), np.float32)
    for row in range(height):
        average = mean[row].reshape(-1)
        for source in range(sources):
            line = painted[source, row].reshape(-1)
            for value in range(3 * width):
                average[value] += near[source] * line[value]
        for source in range(sources):
            off = painted[source, row] - mean[row]
            for column in range(width):
                red, green, blue = off[column]
                spread[row, column] += near[source] * (red * red + green * green + blue * blue)
        for column in range(width):
            spread[row, column] = np.sqrt(spread[row, column] / np.float32(3))
    return mean, spread


def sampled(image: Float32[np.ndarray, "height width _"], where: Map, how: int) -> np.ndarray:
    """Read a panorama between its pixels."""
    x, y = np.ascontiguousarray(where[:, :, 0] + MARGIN), np.ascontiguousarray(where[:, :, 1])
    return np.asarray(cv2.remap(wrapped(image), x, y, how, borderMode=cv2.BORDER_REPLICATE))


def _grid(height: int, width: int) -> Map:
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    return np.stack([columns, rows], axis=2)
