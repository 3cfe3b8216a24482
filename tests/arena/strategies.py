"""Random rooms for hypothesis."""

from typing import Any

import numpy as np
import shapely
from hypothesis import strategies as st

from arena.rooms.arena import Arena
from arena.rooms.materials import materials

NAMES = list(materials())
BESIDE = 0.08
"""A source at least this far (m) from all else has an odour cell in its sight."""
Fields = dict[str, Any]

coordinates = st.floats(-3, 3).map(lambda value: round(value, 3))
points = st.tuples(coordinates, coordinates)
materials = st.sampled_from(NAMES)
heights = st.sampled_from([0.1, 0.29, 0.31, 0.6, 1.0, 2.5])
colours = st.tuples(*3 * [st.integers(0, 255)])


@st.composite
def polygons(draw: st.DrawFn, least: float, most: float) -> list[tuple[float, float]]:
    """Star-shaped ones, in either order around, seldom convex."""
    x, y = draw(points)
    radii = np.array(draw(st.lists(st.floats(least, most), min_size=3, max_size=9)))
    angles = draw(st.floats(0, 7)) + np.arange(len(radii)) * draw(st.sampled_from([-1, 1])) * (
        2 * np.pi / len(radii)
    )
    corners = np.stack([x + radii * np.cos(angles), y + radii * np.sin(angles)], axis=1)
    return [(a, b) for a, b in corners.round(4).tolist()]


@st.composite
def walls(draw: st.DrawFn) -> Fields:
    start = draw(points)
    end = draw(points.filter(lambda other: np.hypot(*np.subtract(other, start)) > 0.01))
    return {"start": start, "end": end, "height": draw(heights), "material": draw(materials)}


@st.composite
def boxes(draw: st.DrawFn) -> Fields:
    sides = st.floats(0.05, 1.2)
    return {
        "center": draw(points),
        "size": (draw(sides), draw(sides)),
        "angle_deg": draw(st.floats(-360, 360)),
        "height": draw(heights),
        "material": draw(materials | st.tuples(*4 * [materials])),
    }


@st.composite
def pillars(draw: st.DrawFn) -> Fields:
    return {"center": draw(points), "radius": draw(st.floats(0.03, 0.7)), "material": draw(materials)}


@st.composite
def blocks(draw: st.DrawFn) -> Fields:
    corners = draw(polygons(0.1, 0.8))
    each = st.lists(materials, min_size=len(corners), max_size=len(corners)).map(tuple)
    return {"corners": corners, "height": draw(heights), "material": draw(materials | each)}


lights = st.fixed_dictionaries(
    {"azimuth_deg": st.floats(-360, 360), "elevation_deg": st.floats(0.1, 89.9), "strength": st.floats(0, 1)}
)


@st.composite
def arenas(draw: st.DrawFn) -> Arena:
    """Rooms some 6 m wide with anything anywhere: solids overlap, walls cross, parts are cut off."""
    room = Arena.create(
        name="random",
        platform=draw(st.lists(polygons(0.4, 2.5), min_size=1, max_size=2)),
        walls=draw(st.lists(walls(), min_size=1, max_size=5)),
        boxes=draw(st.lists(boxes(), max_size=2)),
        pillars=draw(st.lists(pillars(), max_size=2)),
        blocks=draw(st.lists(blocks(), max_size=2)),
        decay_length=draw(st.sampled_from([0.3, 1.5, 5.0])),
        floor=draw(colours | materials),
        zenith=draw(st.none() | colours),
        light=draw(st.none() | lights),
    )
    low, high = np.reshape(room.bounds, (2, 2))
    seed = draw(st.integers(0, 2**32 - 1))
    found = np.random.default_rng(seed).uniform(low, high, (30, 2)).round(4).clip(low, high)
    clear = found[shapely.distance(room.obstacles, shapely.points(found)) > BESIDE]
    sources = [{"position": tuple(xy)} for xy in clear[: draw(st.integers(0, 3))].tolist()]
    return Arena.create(**{**room.model_dump(), "sources": sources})
