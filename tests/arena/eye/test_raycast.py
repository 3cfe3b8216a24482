from collections.abc import Callable

import numpy as np
import pymunk
import pytest

from arena.eye import raycast
from arena.eye.camera import Camera
from arena.rooms.arena import Arena, gallery
from tests.arena.reference import BEFORE_BOXES, BEHIND_LOW_BOXES, PLATFORM, free_poses, rays, trace

CAMERAS = [Camera.panoramic(120, 40), Camera.perspective(64, 48)]


@pytest.mark.parametrize("name", gallery())
@pytest.mark.parametrize("make", [Camera.perspective, Camera.panoramic])
def test_depth_is_that_of_segment_queries(name: str, make: Callable[..., Camera]) -> None:
    arena, camera = Arena.load(name), make(100, 2)
    space = pymunk.Space()
    for a, b in zip(arena.surfaces.start.tolist(), arena.surfaces.end.tolist(), strict=True):
        space.add(pymunk.Segment(space.static_body, a, b, 0.0))
    poses = free_poses(arena, 8)
    for pose, depth in zip(poses, camera.depth(arena, poses), strict=True):
        direction = rays(camera, pose, np.arange(100) + 0.5)
        ends = pose[:2] + 20 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        hits = [
            space.segment_query_first(tuple(pose[:2]), tuple(end), 0.0, pymunk.ShapeFilter()) for end in ends
        ]
        np.testing.assert_allclose(depth, [20 * hit.alpha for hit in hits], rtol=0, atol=1e-9)


@pytest.mark.parametrize("camera", CAMERAS)
def test_the_surface_seen_is_what_single_rays_meet(camera: Camera) -> None:
    pillar = Arena.load("pillar")
    for room, poses in ((pillar, free_poses(pillar, 4)), (BEHIND_LOW_BOXES, BEFORE_BOXES)):
        wanted = np.stack([trace(room, camera, pose, 1).index for pose in poses])
        seen = camera.identify(room, poses)
        assert (seen != wanted).mean() < 1e-3
        assert {raycast.FLOOR, raycast.CEILING} < set(seen.ravel().tolist())
    assert seen.max() >= len(BEHIND_LOW_BOXES.surfaces.height)


@pytest.mark.full
@pytest.mark.parametrize("name", gallery())
def test_ten_thousand_rays_are_those_of_segment_queries(name: str) -> None:
    arena, camera = Arena.load(name), Camera.panoramic(100, 1)
    space = pymunk.Space()
    for a, b in zip(arena.surfaces.start.tolist(), arena.surfaces.end.tolist(), strict=True):
        space.add(pymunk.Segment(space.static_body, a, b, 0.0))
    poses = free_poses(arena, 100)
    worst = 0.0
    for pose, depth in zip(poses, camera.depth(arena, poses), strict=True):
        ends = pose[:2] + 20 * rays(camera, pose, np.arange(100) + 0.5)
        hits = [
            space.segment_query_first(tuple(pose[:2]), tuple(end), 0.0, pymunk.ShapeFilter()) for end in ends
        ]
        worst = max(worst, np.abs(depth - [20 * hit.alpha for hit in hits]).max())
    print(f"{name}: depth within {worst:.1e} m of pymunk's on 10,000 rays (bar 1e-9)")  # noqa: T201
    assert worst < 1e-9


@pytest.mark.parametrize("make", [Camera.perspective, Camera.panoramic])
def test_depth_in_a_square_room_has_a_closed_form(make: Callable[..., Camera]) -> None:
    corners = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
    walls = [
        {"start": a, "end": b, "material": "brick"}
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    room, camera = Arena.create(name="square", platform=PLATFORM, walls=walls), make(90, 1)
    poses = np.array([(0, 0, 0), (1.2, -0.4, 2.0), (-1.9, 1.9, -2.5), (0.5, 1.99, np.pi / 2)])
    for pose, depth in zip(poses, camera.depth(room, poses), strict=True):
        direction = rays(camera, pose, np.arange(90) + 0.5)
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        wanted = 1 / (np.abs(direction) / (2 - pose[:2] * np.sign(direction))).max(axis=1)
        np.testing.assert_allclose(depth, wanted, rtol=1e-9)


def test_nothing_ahead_is_infinitely_far() -> None:
    depth = Camera.perspective(9, 3).depth(BEHIND_LOW_BOXES, np.array([(0.0, 0.0, np.pi)]))
    assert np.isinf(depth).all()
