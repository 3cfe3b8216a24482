"""Rolling: the kernels that move a disc on wheels among the edges of a room, one body or many.

A body's state is a row of six numbers: x, y (m), heading (rad, unwrapped), speed (m/s), turn rate (rad/s) and
the direction from what it touched (rad), NaN for nothing.

`Arena.space` is the room to pymunk. A step through it costs 6 µs in the open and 21 at a wall, of which
Chipmunk's own work is 1; and many bodies need one call a step for each. So the two queries that a body makes
are compiled here: in doubles and in the order of Chipmunk's own arithmetic for segments without thickness.
The tests compare them with pymunk's, bit by bit, in every room of the gallery.
"""

import math
import typing

import numpy as np
from jaxtyping import Float

from arena.kernels import kernel

X, Y, HEADING, SPEED, TURN, CONTACT = range(6)
"""Columns of a state."""

Limits = tuple[float, float, float, float, float, float, float, float]
"""Radius (m), most speed (m/s) and turn rate (rad/s), accelerations (m/s², rad/s²) or infinity, time
constants of speed and turn rate (s), zero for a body without mass, and the wheels' distance (m)."""

CLOSE = 1e-6
"""How far a body may overlap an edge, m."""
COAST = 0.01
"""Longest part of a step in which the speed of a body with mass is taken as even, s."""


@kernel()
@typing.no_type_check
def _approach(now: float, goal: float, limit: float, lag: float, dt: float) -> tuple[float, float]:
    """Change by no more than limit a second, or with a lag (s): give what is reached in dt, and the mean."""
    if lag > 0.0:
        left = (now - goal) * math.exp(-dt / lag)
        return goal + left, goal - (now - goal) * math.expm1(-dt / lag) * lag / dt
    if limit == math.inf:
        return goal, goal
    change = goal - now
    needed = abs(change) / limit
    if needed < dt:
        return goal, goal - 0.5 * change * needed / dt
    end = now + math.copysign(limit * dt, change)
    return end, 0.5 * (now + end)


@kernel()
@typing.no_type_check
def _nearest(x: float, y: float, reach: float, edges: np.ndarray) -> tuple[float, float, float]:
    """Find the nearest point of any edge: give its distance, or reach where none is nearer, and itself."""
    nearest, px, py = reach, x, y
    for k in range(len(edges)):
        ax, ay, bx, by = edges[k, 0, 0], edges[k, 0, 1], edges[k, 1, 0], edges[k, 1, 1]
        # Most edges are out of reach, and to know it takes no division.
        if (
            max(ax, bx) < x - reach
            or min(ax, bx) > x + reach
            or max(ay, by) < y - reach
            or min(ay, by) > y + reach
        ):
            continue
        dx, dy = ax - bx, ay - by
        along = (dx * (x - bx) + dy * (y - by)) / (dx * dx + dy * dy)
        along = max(0.0, min(along, 1.0))
        qx, qy = bx + dx * along, by + dy * along
        distance = math.sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy))
        if distance < nearest:
            nearest, px, py = distance, qx, qy
    return nearest, px, py


@kernel()
@typing.no_type_check
def _push_out(state: np.ndarray, dx: float, dy: float, radius: float, edges: np.ndarray) -> None:
    """Free a body that overlaps an edge after a step by dx, dy (m)."""
    x0, y0 = x, y = state[X], state[Y]
    # A corner takes a few pushes; what twenty do not free is a wedge.
    for attempt in range(21):
        distance, px, py = _nearest(x, y, radius - CLOSE, edges)
        if distance == radius - CLOSE:
            break
        if attempt == 20:
            x, y = x0 - dx, y0 - dy
            break
        stretch = radius / max(distance, CLOSE * radius)
        x, y = px + stretch * (x - px), py + stretch * (y - py)
    if x != x0 or y != y0:
        state[X], state[Y] = x, y
        state[CONTACT] = math.atan2(y - y0, x - x0)


@kernel()
@typing.no_type_check
def _go(state: np.ndarray, edges: np.ndarray, radius: float, speed: float, turn: float, dt: float) -> None:
    """Move for dt (s) at an even speed and turn rate."""
    # No part of a step is longer than a fifth of the radius, so that none passes a wall.
    parts = max(1, math.ceil(5 * abs(speed) * dt / radius))
    dt /= parts
    for _ in range(parts):
        # Half the turn first: second-order accurate along the arc.
        course = state[HEADING] + 0.5 * turn * dt
        state[HEADING] += turn * dt
        dx, dy = (speed * math.cos(course) + 0.0) * dt, (speed * math.sin(course) + 0.0) * dt
        state[X] += dx
        state[Y] += dy
        _push_out(state, dx, dy, radius, edges)


@kernel()
@typing.no_type_check
def roll(
    state: Float[np.ndarray, "6"],
    edges: Float[np.ndarray, "edges 2 2"],
    limits: Limits,
    gains: tuple[float, float],
    speed: float,
    turn: float,
    dt: float,
) -> None:
    """Move a body for dt (s) towards a speed (m/s) and turn rate (rad/s).

    Gains are how far the left and the right wheel roll over how far they should.
    """
    radius, max_speed, max_turn, acceleration, turn_acceleration, lag, turn_lag, base = limits
    speed, turn = max(-max_speed, min(max_speed, speed)), max(-max_turn, min(max_turn, turn))
    parts = max(1, math.ceil(dt / COAST)) if lag > 0.0 else 1
    dt /= parts
    touched = math.nan
    for _ in range(parts):
        state[SPEED], forward = _approach(state[SPEED], speed, acceleration, lag, dt)
        state[TURN], veer = _approach(state[TURN], turn, turn_acceleration, turn_lag, dt)
        if gains[0] != 1.0 or gains[1] != 1.0:
            left, right = gains[0] * (forward - 0.5 * base * veer), gains[1] * (forward + 0.5 * base * veer)
            forward, veer = 0.5 * (left + right), (right - left) / base
        state[CONTACT] = math.nan
        x, y, course = state[X], state[Y], state[HEADING] + 0.5 * veer * dt
        _go(state, edges, radius, forward, veer, dt)
        if not math.isnan(state[CONTACT]):
            touched = state[CONTACT]
            if lag > 0.0:
                # Wheels slip at a wall and turn on; what has mass keeps the speed that the wall leaves it.
                gone = ((state[X] - x) * math.cos(course) + (state[Y] - y) * math.sin(course)) / dt
                state[SPEED] = max(min(state[SPEED], 0.0), min(gone, max(state[SPEED], 0.0)))
    state[CONTACT] = touched


@kernel()
@typing.no_type_check
def roll_all(
    states: Float[np.ndarray, "bodies 6"],
    edges: Float[np.ndarray, "edges 2 2"],
    limits: Limits,
    gains: Float[np.ndarray, "bodies 2"],
    commands: Float[np.ndarray, "bodies 2"],
    dt: float,
) -> None:
    """Move bodies of one kind that pass through each other, each by its own speed and turn rate."""
    for k in range(len(states)):
        wheels = gains[k, 0], gains[k, 1]
        roll(states[k], edges, limits, wheels, commands[k, 0], commands[k, 1], dt)


@kernel()
@typing.no_type_check
def look_ahead(state: Float[np.ndarray, "6"], edges: Float[np.ndarray, "edges 2 2"], reach: float) -> float:
    """Give the normal (rad) of the first edge straight ahead of the centre within reach (m), or NaN."""
    x, y, heading = state[X], state[Y], state[HEADING]
    dx, dy = (x + reach * math.cos(heading)) - x, (y + reach * math.sin(heading)) - y
    first, normal_x, normal_y = 1.0, math.nan, math.nan
    for k in range(len(edges)):
        ax, ay, bx, by = edges[k, 0, 0], edges[k, 0, 1], edges[k, 1, 0], edges[k, 1, 1]
        # Both ends on one side of the way: it passes by.
        if (dx * (ay - y) - dy * (ax - x)) * (dx * (by - y) - dy * (bx - x)) > 0.0:
            continue
        length = math.sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
        nx, ny = (by - ay) * (1.0 / length), -(bx - ax) * (1.0 / length)
        # As if turned with a body that is not: it decides which zero an axis has, and so π or −π.
        nx, ny = nx + 0.0 * ny, 0.0 * nx + ny
        aside = (ax - x) * nx + (ay - y) * ny
        beyond = (dx * nx + dy * ny) - aside
        if -aside * beyond < 0.0:
            share = -aside / (-aside - beyond)
            if share < first:
                side = -1.0 if aside > 0.0 else 1.0
                first, normal_x, normal_y = share, side * nx, side * ny
    return math.atan2(normal_y, normal_x)
