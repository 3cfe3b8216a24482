"""Every room of the gallery is the one of the design."""

import numpy as np
import pytest
import shapely

from arena.eye.camera import Camera
from arena.rooms.arena import Arena, gallery
from arena.rooms.parts import Box

RADIUS = 0.18
FREE = 4 - 0.36, 3 - 0.36
SOURCES = [(-1.5, -1.0), (1.6, 0.9), (1.2, -1.1)]
RECTANGLES = {
    "open_field": (6, 5),
    "furnished": (6, 5),
    "pillar": (6, 5),
    "obstacles": (6, 5),
    "linear_track": (6, 5),
    "plus_maze": (6, 5),
    "two_pillars": (7, 5),
    "white_rectangle": (6, 4),
    "blue_wall": (6, 4),
}
PLATFORMS = {
    "open_field": 12,
    "furnished": 12,
    "pillar": 12,
    "two_pillars": 15,
    "obstacles": 12,
    "l_shape": 2 * 3 * 1.5 - 1.5**2,
    "two_rooms": 2 * 9 + 1,
    "linear_track": 5 * 0.4,
    "plus_maze": 4 * 2 * 0.5 + 0.5**2,
    "white_rectangle": 12,
    "blue_wall": 12,
    "cue_square": 9,
    "cue_cylinder": 16 * 1.5**2 * np.sin(np.pi / 16),
}
FREE_AREAS = {
    "open_field": FREE[0] * FREE[1],
    "furnished": FREE[0] * FREE[1],
    "pillar": FREE[0] * FREE[1] - np.pi * 0.68**2,
    "two_pillars": 4.64 * FREE[1] - 2 * np.pi * 0.58**2,
    "obstacles": FREE[0] * FREE[1]
    - (0.55 * 0.9 + 0.6 * 0.8 + 0.36 * (0.55 + 0.9 + 0.6 + 0.8) + 2 * np.pi * RADIUS**2),
    "l_shape": 2.64 * 1.14 + 1.14 * 1.5,
    "two_rooms": 2 * 2.64**2 + 1.36 * 0.64,
    "linear_track": 4.64 * 0.04,
    "plus_maze": 4.14 * 0.14 * 2 - 0.14**2,
    "white_rectangle": FREE[0] * FREE[1],
    "blue_wall": FREE[0] * FREE[1],
    "cue_square": 2.64**2,
    "cue_cylinder": 32 * (1.5 * np.cos(np.pi / 32) - RADIUS) ** 2 * np.tan(np.pi / 32),
}
HOLES = {"pillar": 1, "two_pillars": 2, "obstacles": 2}
CUES = ("cue_square", "cue_cylinder")


@pytest.fixture(params=gallery())
def room(request: pytest.FixtureRequest) -> Arena:
    return Arena.load(request.param)


def test_these_are_the_rooms() -> None:
    assert set(gallery()) == set(PLATFORMS)
    assert [Arena.load(name).name for name in gallery()] == gallery()


def test_size(room: Arena) -> None:
    assert room.walkable.area == pytest.approx(PLATFORMS[room.name], rel=1e-3)
    if room.name in RECTANGLES:
        width, depth = RECTANGLES[room.name]
        assert {(w.start, w.end) for w in room.walls} == {
            ((-width / 2, -depth / 2), (width / 2, -depth / 2)),
            ((width / 2, -depth / 2), (width / 2, depth / 2)),
            ((width / 2, depth / 2), (-width / 2, depth / 2)),
            ((-width / 2, depth / 2), (-width / 2, -depth / 2)),
        }
        assert room.walkable.centroid.coords[0] == pytest.approx((0, 0))
        assert [source.position for source in room.sources] == SOURCES
    assert {wall.height for wall in room.walls} == {1.0}
    assert room.decay_length == 1.5


def test_the_body_gets_everywhere(room: Arena) -> None:
    region = room.free_space(RADIUS)
    assert isinstance(region, shapely.Polygon)
    assert len(region.interiors) == HOLES.get(room.name, 0)
    assert region.area == pytest.approx(FREE_AREAS[room.name], abs=0.03)


def test_walls_close_the_room(room: Arena) -> None:
    (inside,) = shapely.polygonize([shapely.LineString([w.start, w.end]) for w in room.walls]).geoms
    assert inside.contains(room.walkable)
    assert room.walkable.distance(inside.boundary) >= 0.25 - 1e-9
    assert all(inside.buffer(1e-9).contains(shapely.Polygon(solid.outline)) for solid in room.solids)
    for wall, after in zip(room.walls, (*room.walls[1:], room.walls[0]), strict=True):
        assert wall.end == after.start


def test_no_two_things_look_alike(room: Arena) -> None:
    if room.name in ("white_rectangle", "blue_wall", *CUES):
        return
    materials = [wall.material for wall in room.walls]
    for solid in room.solids:
        # The jambs of a door are narrow.
        lengths = np.linalg.norm(np.roll(solid.outline, -1, axis=0) - solid.outline, axis=1)
        materials += {side for side, length in zip(solid.sides, lengths, strict=True) if length > 0.25} or {
            solid.sides[0]
        }
    assert len(set(materials)) == len(materials)


def test_odours_reach_everywhere_and_are_strongest_at_their_source(room: Arena) -> None:
    rng = np.random.default_rng(0)
    assert len(room.sources) == 3
    assert (room.odours.concentration(room.sample_free(2000, RADIUS, rng)) > 1e-3).all()
    low, high = np.reshape(room.bounds, (2, 2))
    anywhere = rng.uniform(low, high, (20_000, 2))
    smelt = room.odours.concentration(anywhere)
    assert (smelt > 0).all()
    strongest = anywhere[smelt.argmax(axis=0)]
    assert np.linalg.norm(strongest - room.odours.sources, axis=1).max() < 0.05
    # Three sources on a line would leave two mirrored places that smell alike.
    assert shapely.Polygon(room.odours.sources).area > 0.5
    if room.name not in ("linear_track", "plus_maze"):
        assert room.is_free(room.odours.sources, RADIUS).all()


def test_furniture_stands_off_the_platform_and_the_rest_is_the_same() -> None:
    furnished, bare = Arena.load("furnished"), Arena.load("open_field")
    assert len(furnished.boxes) == 5
    assert furnished.free_space(RADIUS).equals(bare.free_space(RADIUS))
    assert furnished.walls == bare.walls
    pillar, obstacles = Arena.load("pillar"), Arena.load("obstacles")
    assert pillar.boxes == furnished.boxes == obstacles.boxes[:5]
    assert (pillar.pillars[0].center, pillar.pillars[0].radius) == ((0, 0), 0.5)
    assert [box.size for box in obstacles.boxes[5:]] == [(0.55, 0.9), (0.6, 0.8)]


def test_two_pillars() -> None:
    room, furnished = Arena.load("two_pillars"), Arena.load("furnished")
    assert [(pillar.center, pillar.radius) for pillar in room.pillars] == [((-1.2, 0), 0.4), ((1.2, 0), 0.4)]
    looks = [[(box.size, box.height, box.material) for box in one.boxes] for one in (room, furnished)]
    assert looks[0] == looks[1]


def test_a_body_passes_all_round_obstacles_and_between() -> None:
    room = Arena.load("obstacles")
    for index in (5, 6):
        around = shapely.Polygon(room.boxes[index].outline).buffer(RADIUS + 0.05).exterior
        assert room.free_space(RADIUS).contains(around)
    a, b = (shapely.Polygon(room.boxes[index].outline) for index in (5, 6))
    assert a.distance(b) > 4 * RADIUS


def test_walls_follow_the_l_at_half_a_metre() -> None:
    room = Arena.load("l_shape")
    (inside,) = shapely.polygonize([shapely.LineString([w.start, w.end]) for w in room.walls]).geoms
    assert inside.equals(room.walkable.buffer(0.5, join_style="mitre"))


def test_the_door_is_one_metre_wide_and_the_only_way() -> None:
    room = Arena.load("two_rooms")
    lower, upper = sorted(room.boxes, key=lambda box: box.center[1])
    assert upper.outline[:, 1].min() - lower.outline[:, 1].max() == pytest.approx(1.0)
    assert (lower.outline[:, 1].min(), upper.outline[:, 1].max()) == (-2, 2)
    crossed = room.free_space(RADIUS).intersection(shapely.LineString([(0, -2), (0, 2)]))
    assert crossed.length == pytest.approx(1 - 2 * RADIUS)
    # Each side of the dividing wall is of its own material.
    assert len({side for box in (lower, upper) for side in (box.sides[1], box.sides[3])}) == 4


def test_half_a_turn_of_the_white_rectangle_changes_nothing() -> None:
    room = Arena.load("white_rectangle")
    assert room.light is None
    assert not room.solids
    faces = room.surfaces
    assert faces.materials == ("white",)
    found = {(*a, *b, h) for a, b, h in zip(faces.start, faces.end, faces.height, strict=True)}
    turned = {(*-a, *-b, h) for a, b, h in zip(faces.start, faces.end, faces.height, strict=True)}
    assert found == turned
    assert room.walkable.equals(shapely.affinity.rotate(room.walkable, 180, (0, 0)))


def mirrored(poses: np.ndarray) -> np.ndarray:
    return np.c_[-poses[:, :2], poses[:, 2] + np.pi]


@pytest.fixture
def poses() -> np.ndarray:
    rng = np.random.default_rng(0)
    return np.c_[Arena.load("white_rectangle").sample_free(40, RADIUS, rng), rng.uniform(-np.pi, np.pi, 40)]


@pytest.mark.parametrize("camera", [Camera.panoramic(180, 30), Camera.perspective(80, 60)])
def test_sight_cannot_tell_the_two_halves_of_white_apart_but_of_blue(
    camera: Camera, poses: np.ndarray
) -> None:
    white, blue = Arena.load("white_rectangle"), Arena.load("blue_wall")
    change = camera.render(white, poses).astype(int) - camera.render(white, mirrored(poses))
    assert np.abs(change).max() <= 1
    assert (np.abs(camera.render(white, poses).astype(int)[1:] - camera.render(white, poses)[:-1]) > 50).any()
    change = camera.render(blue, poses).astype(int) - camera.render(blue, mirrored(poses))
    assert (np.abs(change).max(axis=(1, 2, 3)) > 50).mean() > 0.7


def test_smell_tells_the_two_halves_of_white_apart(poses: np.ndarray) -> None:
    odours = Arena.load("white_rectangle").odours
    change = np.log(odours.concentration(poses[:, :2]) / odours.concentration(-poses[:, :2]))
    assert (np.abs(change).max(axis=1) > 0.2).all()


def test_one_wall_is_blue() -> None:
    white, blue = Arena.load("white_rectangle"), Arena.load("blue_wall")
    differing = [(a, b) for a, b in zip(white.walls, blue.walls, strict=True) if a != b]
    ((before, after),) = differing
    assert before.model_copy(update={"material": "blue"}) == after
    assert blue.model_copy(update={"walls": white.walls, "name": white.name}) == white


@pytest.mark.parametrize("name", CUES)
def test_a_quarter_turn_moves_nothing_but_the_card(name: str, poses: np.ndarray) -> None:
    room = Arena.load(name)
    (card,) = room.solids
    assert set(card.sides) == {"blue"}
    assert room.walkable.equals(shapely.affinity.rotate(room.walkable, 90, (0, 0)))
    bare = room.model_copy(update={"boxes": [], "blocks": []})
    poses = poses * (0.7, 0.9, 1)
    around = np.c_[-poses[:, 1], poses[:, 0], poses[:, 2] + np.pi / 2]
    camera = Camera.panoramic(180, 30)
    change = camera.render(bare, poses).astype(int) - camera.render(bare, around)
    assert np.abs(change).mean() < 0.05
    change = camera.render(room, poses).astype(int) - camera.render(room, around)
    assert (np.abs(change).max(axis=(1, 2, 3)) > 50).all()


def test_demonstrations_of_what_a_room_can_be() -> None:
    assert Arena.load("l_shape").light is not None
    assert Arena.load("l_shape").zenith is not None
    assert isinstance(Arena.load("linear_track").floor, str)
    assert isinstance(Arena.load("plus_maze").floor, str)
    assert any(isinstance(box, Box) and len(set(box.sides)) > 1 for box in Arena.load("two_rooms").boxes)
