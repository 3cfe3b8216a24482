"""Linkage: the kernels that move chains of joints and straight links among the edges of a room.

pymunk's own motors were tried: over a minute of babbling, at steps of .01 s, two links came off by .3° from
what was commanded and by 1° within a step, the hinge opened by 2 mm, and a step took 20 µs. Here joints
obey exactly, and what stops them is asked of the edges, as `arena.bodies.rolling` does.
"""

import math
import typing

import numpy as np
from jaxtyping import Bool, Float

from arena.kernels import kernel

Chain = tuple[float, float, float, np.ndarray, np.ndarray]
"""x, y (m) and heading (rad) of the base, which joints slide, and the length of each joint's link (m)."""


@kernel()
@typing.no_type_check
def _bend(joints: np.ndarray, chain: Chain, links: np.ndarray) -> None:
    """Place the links of a body."""
    x, y, heading, slides, lengths = chain
    for k in range(len(joints)):
        if slides[k]:
            x, y = x + joints[k] * math.cos(heading), y + joints[k] * math.sin(heading)
        else:
            heading += joints[k]
        links[k, 0, 0], links[k, 0, 1] = x, y
        x, y = x + lengths[k] * math.cos(heading), y + lengths[k] * math.sin(heading)
        links[k, 1, 0], links[k, 1, 1] = x, y


@kernel()
@typing.no_type_check
def bend_all(joints: Float[np.ndarray, "bodies axes"], chain: Chain, links: np.ndarray) -> None:
    """Place the links of bodies, (bodies, axes, 2, 2) in m."""
    for k in range(len(joints)):
        _bend(joints[k], chain, links[k])


@kernel()
@typing.no_type_check
def _squared(x: float, y: float, ends: np.ndarray) -> float:
    """Square the distance of a point from a segment, m²."""
    ax, ay = ends[0, 0], ends[0, 1]
    dx, dy = ends[1, 0] - ax, ends[1, 1] - ay
    length = dx * dx + dy * dy
    along = 0.0 if length == 0.0 else max(0.0, min((dx * (x - ax) + dy * (y - ay)) / length, 1.0))
    gx, gy = ax + along * dx - x, ay + along * dy - y
    return gx * gx + gy * gy


@kernel()
@typing.no_type_check
def _side(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


@kernel()
@typing.no_type_check
def _clearance(links: np.ndarray, edges: np.ndarray, enough: float) -> float:
    """Find how far (m) the nearest edge is from the nearest link, or give `enough`: 0 where they cross."""
    nearest = enough * enough
    for k in range(len(links)):
        a, b = links[k, 0], links[k, 1]
        for e in range(len(edges)):
            c, d = edges[e, 0], edges[e, 1]
            # Most edges are out of reach.
            if (
                max(c[0], d[0]) < min(a[0], b[0]) - enough
                or min(c[0], d[0]) > max(a[0], b[0]) + enough
                or max(c[1], d[1]) < min(a[1], b[1]) - enough
                or min(c[1], d[1]) > max(a[1], b[1]) + enough
            ):
                continue
            if _side(a, b, c) * _side(a, b, d) < 0.0 and _side(c, d, a) * _side(c, d, b) < 0.0:
                return 0.0
            nearest = min(nearest, _squared(a[0], a[1], edges[e]), _squared(b[0], b[1], edges[e]))
            nearest = min(nearest, _squared(c[0], c[1], links[k]), _squared(d[0], d[1], links[k]))
    return math.sqrt(nearest)


@kernel()
@typing.no_type_check
def are_clear(
    joints: Float[np.ndarray, "bodies axes"],
    chain: Chain,
    radius: float,
    edges: Float[np.ndarray, "edges 2 2"],
    clear: Bool[np.ndarray, " bodies"],
) -> None:
    """Tell of which bodies no link of this radius (m) reaches an edge."""
    links = np.empty((joints.shape[1], 2, 2))
    for k in range(len(joints)):
        _bend(joints[k], chain, links)
        clear[k] = _clearance(links, edges, radius) >= radius


@kernel()
@typing.no_type_check
def turn_all(
    joints: Float[np.ndarray, "bodies axes"],
    chain: Chain,
    ranges: Float[np.ndarray, "axes 2"],
    radius: float,
    edges: Float[np.ndarray, "edges 2 2"],
    velocities: Float[np.ndarray, "bodies axes"],
    dt: float,
    touched: Bool[np.ndarray, " bodies"],
) -> None:
    """Move the joints of bodies that pass through each other for dt (s), each within its range.

    A joint that comes to an end stays there. Where a link comes to an edge the joints go on one by one, from
    the base on, that can without coming nearer to it, and so slide along it.
    """
    slides, lengths = chain[3], chain[4]
    count = joints.shape[1]
    links, before, wish = np.empty((count, 2, 2)), np.empty(count), np.empty(count)
    for k in range(len(joints)):
        q, touched[k] = joints[k], False
        # No part of a step takes any point farther than a fifth of the radius, so that none passes an edge.
        way = 0.0
        for j in range(count):
            reach = 1.0 if slides[j] else lengths[j:].sum()
            way += abs(velocities[k, j]) * dt * reach
        parts = max(1, math.ceil(5.0 * way / radius)) if len(edges) else 1
        _bend(q, chain, links)
        clearance = _clearance(links, edges, radius)
        for _ in range(parts):
            for j in range(count):
                before[j] = q[j]
                goal = q[j] + velocities[k, j] * (dt / parts)
                wish[j] = max(ranges[j, 0], min(goal, ranges[j, 1]))
                touched[k] |= wish[j] != goal
                q[j] = wish[j]
            if not len(edges):
                continue
            _bend(q, chain, links)
            now = _clearance(links, edges, radius)
            if now >= min(radius, clearance):
                clearance = now
                continue
            touched[k] = True
            for j in range(count):
                q[j] = before[j]
            for j in range(count):
                q[j] = wish[j]
                _bend(q, chain, links)
                now = _clearance(links, edges, radius)
                if now >= min(radius, clearance):
                    clearance = now
                else:
                    q[j] = before[j]
