"""Capsules: the kernel that paints all that is within a radius of a segment, over a picture.

OpenCV's polygons were no choice: their corners lie on sixteenths of a pixel, and their edges are smooth only
where they are drawn, not where they are filled.
"""

import math
import typing

import numpy as np
from jaxtyping import Float, UInt8

from arena.kernels import kernel


@kernel()
@typing.no_type_check
def _cover(canvas: np.ndarray, ends: np.ndarray, radius: float, strip: np.ndarray, texel: float) -> None:
    """Blend one capsule into a picture; lengths are in pixels, and rows go down where y goes up."""
    height, width = canvas.shape[0], canvas.shape[1]
    ax, ay = ends[0, 0], -ends[0, 1]
    dx, dy = ends[1, 0] - ax, -ends[1, 1] - ay
    length = math.sqrt(dx * dx + dy * dy)
    ux, uy = (dx / length, dy / length) if length > 0.0 else (1.0, 0.0)
    reach = radius + 0.5
    first = max(0, math.ceil(min(ay, ay + dy) - reach))
    last = min(height - 1, math.floor(max(ay, ay + dy) + reach))
    left = max(0, math.ceil(min(ax, ax + dx) - reach))
    right = min(width - 1, math.floor(max(ax, ax + dx) + reach))
    for r in range(first, last + 1):
        for c in range(left, right + 1):
            x, y = c - ax, r - ay
            along = x * ux + y * uy
            beyond = along - max(0.0, min(along, length))
            across = y * ux - x * uy
            share = radius + 0.5 - math.sqrt(beyond * beyond + across * across)
            if share <= 0.0:
                continue
            share = min(share, 1.0)
            at = max(0.0, min((along + radius) / texel, len(strip) - 1.001))
            k = int(at)
            part = at - k
            for channel in range(3):
                colour = strip[k, channel] + part * (strip[k + 1, channel] - strip[k, channel])
                canvas[r, c, channel] += share * (colour - canvas[r, c, channel])


@kernel()
@typing.no_type_check
def paint(
    capsules: Float[np.ndarray, "views capsules 2 2"],
    radii: Float[np.ndarray, " capsules"],
    strips: Float[np.ndarray, "capsules texels 3"],
    texel: float,
    plan: Float[np.ndarray, "height width 3"],
    out: UInt8[np.ndarray, "views height width 3"],
) -> None:
    """Paint capsules over a plan, the first of each view below the others.

    Parameters
    ----------
    capsules, radii
        Ends of their axes from the middle of the pixel at the top left, x to the right and y up, and how
        thick they are to either side, pixels.
    strips, texel
        Colours along each (0..255), from its round end on, and how many pixels each is long.
    plan
        What is behind, 0..255.
    """
    canvas = np.empty_like(plan)
    for view in range(len(capsules)):
        canvas[:] = plan
        for k in range(len(radii)):
            _cover(canvas, capsules[view, k], radii[k], strips[k], texel)
        for r in range(plan.shape[0]):
            for c in range(plan.shape[1]):
                for channel in range(3):
                    out[view, r, c, channel] = np.uint8(canvas[r, c, channel] + 0.5)
