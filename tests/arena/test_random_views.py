"""What must hold of the views of any room, from anywhere, through any camera."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from arena.eye import raycast
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.rooms.parts import Solid
from tests.arena.reference import trace
from tests.arena.strategies import arenas

# beartype picks at random what it looks at in a list.
pytestmark = pytest.mark.filterwarnings("ignore:Do not use the `random` module")
SLOW = settings(deadline=None, max_examples=40, suppress_health_check=list(HealthCheck))
GUARD = 4096
CAMERAS = [Camera.panoramic(60, 31), Camera.perspective(33, 40), Camera.perspective(31, 7, eye_height=0.7)]

coordinates = st.integers(-8, 8).map(lambda n: n / 4) | st.floats(-3, 3)
headings = st.integers(-8, 8).map(lambda n: n * np.pi / 8) | st.floats(-10, 10)
sizes = st.sampled_from([(1, 1), (2, 3), (3, 2), (4096, 1), (8, 2000)]) | st.tuples(
    st.integers(1, 40), st.integers(1, 40)
)
eyes = st.sampled_from([0.001, 0.3, 0.6, 1.0, 30.0])


@st.composite
def cameras(draw: st.DrawFn) -> Camera:
    width, height = draw(sizes)
    if draw(st.booleans()):
        return Camera.panoramic(width, height, eye_height=draw(eyes))
    angle = draw(st.sampled_from([1e-3, 3e-3, np.pi / 2, 3.1]) | st.floats(0.01, 3.1))
    return Camera.perspective(width, height, field_of_view=angle, eye_height=draw(eyes))


@st.composite
def odd_rooms(draw: st.DrawFn) -> Arena:
    """Rooms with a wall of any height somewhere or very far."""
    room = draw(arenas())
    far = draw(st.sampled_from([1.0, 300.0]))
    start, end = [(far * draw(coordinates), far * draw(coordinates)) for _ in range(2)]
    assume(np.hypot(*np.subtract(end, start)) > 1e-6)
    wall = {"start": start, "end": end, "height": draw(st.sampled_from([1e-3, 1e3])), "material": "books"}
    fields = room.model_dump()
    return Arena.create(**{**fields, "walls": [*fields["walls"], wall], "sources": []})


@st.composite
def odd_poses(draw: st.DrawFn, room: Arena) -> np.ndarray:
    """Poses on corners, on faces, inside of solids, anywhere and far off."""
    faces = room.surfaces
    f = draw(st.integers(0, len(faces.height) - 1))
    share = draw(st.sampled_from([0.0, 0.5, 1.0]))
    places = [
        tuple(((1 - share) * faces.start[f] + share * faces.end[f]).tolist()),
        (draw(coordinates), draw(coordinates)),
        *[solid.outline.mean(axis=0).tolist() for solid in room.solids[:1]],
        draw(st.sampled_from([(1e3, -1e3), (1e9, 1e-9), (-1e300, 1e300)])),
    ]
    along = np.arctan2(*(faces.end[f] - faces.start[f])[::-1])
    return np.array([(*xy, draw(st.just(along) | headings)) for xy in places])


@SLOW
@given(data=st.data(), room=odd_rooms(), camera=cameras())
def test_any_view_is_drawn_and_nothing_else_is_written(
    data: st.DataObject, room: Arena, camera: Camera
) -> None:
    poses = data.draw(odd_poses(room))
    shape = len(poses), camera.height, camera.width

    def guarded(kind: type, *size: int) -> tuple[np.ndarray, np.ndarray]:
        whole = np.full(np.prod(size) + 2 * GUARD, 77, kind)
        return whole, whole[GUARD:-GUARD].reshape(size)

    whole, images = guarded(np.uint8, *shape, 3)
    assert camera.render(room, poses, out=images) is images
    np.testing.assert_array_equal(camera.render(room, poses), images)
    for pose, image in zip(poses, images, strict=True):
        np.testing.assert_array_equal(camera.render(room, pose[None])[0], image)
    lens = camera._optics[0]
    more, depth = guarded(np.float64, *shape[::2])
    raycast.measure(poses, room.scene.faces, lens, depth)
    most, index = guarded(np.int32, *shape)
    raycast.identify(poses, room.scene.faces, lens, index)
    for memory in (whole, more, most):
        assert (memory[:GUARD] == 77).all()
        assert (memory[-GUARD:] == 77).all()
    assert (depth > 0).all()
    assert index.min() >= -2
    assert index.max() < len(room.surfaces.height) + len(room.solids)
    below = np.arange(camera.height) + 0.5 >= camera.height / 2
    assert not (index[:, below] == raycast.CEILING).any()
    assert not (index[:, ~below] == raycast.FLOOR).any()
    np.testing.assert_array_equal(camera.depth(room, poses), depth)
    np.testing.assert_array_equal(camera.identify(room, poses), index)


def apart(room: Arena) -> Arena:
    """Leave out the solids that overlap others, and the walls that lie in others or in a face."""
    kept: list[Solid] = []
    for solid in room.solids:
        outline = shapely.Polygon(solid.outline)
        if not any(outline.intersects(shapely.Polygon(other.outline)) for other in kept):
            kept.append(solid)
    fields = {**room.model_dump(), "sources": []}
    for name in ("boxes", "pillars", "blocks"):
        parts = getattr(room, name)
        fields[name] = [part.model_dump() for part in parts if any(part is solid for solid in kept)]
    lines = [shapely.Polygon(solid.outline).exterior for solid in kept]
    fields["walls"] = []
    for wall in room.walls:
        line = shapely.LineString([wall.start, wall.end])
        if not any(line.intersection(other).length > 0 for other in lines):
            lines.append(line)
            fields["walls"].append(wall.model_dump())
    return Arena.create(**fields)


def outside(room: Arena, seed: int) -> np.ndarray:
    """Three poses that are in no solid."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-3, 3, (200, 2))
    solids = shapely.union_all([shapely.Polygon(solid.outline) for solid in room.solids])
    xy = xy[~shapely.contains_xy(solids.buffer(0.01), xy)][:3]
    return np.c_[xy, rng.uniform(-np.pi, np.pi, len(xy))]


@SLOW
@given(
    room=arenas().map(apart),
    seed=st.integers(0, 2**32 - 1),
    camera=st.sampled_from(CAMERAS),
)
def test_what_is_seen_is_what_single_rays_meet(room: Arena, seed: int, camera: Camera) -> None:
    poses = outside(room, seed)
    wanted = np.stack([trace(room, camera, pose, 1).index for pose in poses])
    # Rays along edges may go either way.
    assert (camera.identify(room, poses) != wanted).mean() < 0.01
