import re
from copy import copy

import numpy as np
import pytest

from arena import Arena, Camera
from cogmap import CogmapError, EvenMemory
from cogmap.evaluation.image_quality import psnr
from cogmap.imagination import Imagination


def test_dreams_are_like_what_is_seen_and_the_finer_the_method_the_more(
    dream: Imagination, asked: np.ndarray
) -> None:
    position, phase = dream.perceive(asked)
    found = {method: dream.at(position, phase, method=method) for method in ("turned", "blend", "warp")}
    turned, blend, warp = (np.median(psnr(each.views, asked)) for each in found.values())
    assert warp > blend + 0.5 > turned + 1
    assert warp > 30
    warped = found["warp"]
    assert warped.views.dtype == np.uint8
    nearest = np.linalg.norm(dream.places.position[:, None] - position, axis=2).min(axis=0)
    np.testing.assert_allclose(warped.distance, nearest, atol=1e-6)
    assert (warped.spread > 0).all()


def test_a_dream_of_a_remembered_pose_is_what_was_seen_there(dream: Imagination) -> None:
    places = dream.places
    for method in ("turned", "warp"):
        made = dream.at(places.position[3], float(places.phase[3]), method=method)
        assert psnr(made.views, places.views[3:4])[0] > 45


def test_the_same_dream_whatever_the_threads(
    dream: Imagination, asked: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    position, phase = dream.perceive(asked)
    once = dream.at(position, phase).views
    monkeypatch.setattr("cogmap.threads.cpu_count", lambda: 3)
    np.testing.assert_array_equal(dream.at(position, phase).views, once)


def test_a_step_ahead_is_seen_before_it_is_made(
    dream: Imagination, remembered: tuple[np.ndarray, np.ndarray], room: Arena, camera: Camera
) -> None:
    class Turning:
        """Goes 5 cm along an arc and turns left by 0.3 rad, told in the map's unit and sense."""

        def predict(self, commands: np.ndarray, previous: np.ndarray | None = None) -> np.ndarray:
            assert previous is None
            return np.tile([0.1, 0.0, 0.3 * dream.sense], (len(commands), 1))

    views, poses = remembered
    x, y, heading = poses[-10:].T
    after = np.column_stack(
        [x + 0.05 * np.cos(heading + 0.15), y + 0.05 * np.sin(heading + 0.15), heading + 0.3]
    )
    truth = camera.render(room, after)
    expected = dream.ahead(views[-10:], Turning(), np.zeros((10, 2))).views
    assert np.median(psnr(expected, truth)) > np.median(psnr(views[-10:], truth)) + 8
    with pytest.raises(CogmapError, match="or neither"):
        dream.ahead(views[-10:], Turning())


def test_without_a_motor_the_body_goes_on_as_far_as_it_usually_got(
    dream: Imagination, room: Arena, camera: Camera
) -> None:
    line = np.column_stack([np.arange(-0.4, 0.4, 0.04), np.zeros(20), np.zeros(20)])
    views = camera.render(room, line)
    straight = copy(dream)
    straight.__dict__.pop("places", None)
    straight.__dict__.pop("pace", None)
    straight.memory = views
    straight.cmap = copy(dream.cmap)
    straight.cmap.poses = {view.tobytes(): pose for view, pose in zip(views, line, strict=True)}
    assert straight.pace == pytest.approx(0.08, rel=1e-3)
    ahead = straight.ahead(views[3:4])
    np.testing.assert_allclose(ahead.position[0], straight.places.position[4], atol=1e-4)


def test_a_film_begins_and_ends_with_its_views_and_keeps_to_what_was_visited(
    dream: Imagination, asked: np.ndarray
) -> None:
    dream.__dict__["pace"] = 0.2
    found = dream.film(asked[0], asked[1])
    position, phase = dream.perceive(asked[:2])
    np.testing.assert_allclose(found.position[[0, -1]], position)
    np.testing.assert_allclose(np.exp(1j * found.phase[[0, -1]]), np.exp(1j * phase), atol=1e-6)
    assert (psnr(found.views[[0, -1]], asked[:2]) > 25).all()
    assert np.linalg.norm(np.diff(found.position, axis=0), axis=1).max() <= 0.05 + 1e-9
    assert np.abs(np.angle(np.exp(1j * np.diff(found.phase)))).max() <= 0.1 + 1e-9


def test_a_moved_box_surprises_where_it_stood_or_stands(
    dream: Imagination,
    remembered: tuple[np.ndarray, np.ndarray],
    room: Arena,
    camera: Camera,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # remembered in no order, so that no two are of one visit
    monkeypatch.setattr("cogmap.imagination.places.VISIT", 0)
    # a square metre was walked, and the box stood 1.7 m beside it
    monkeypatch.setattr("cogmap.imagination.surprise.BEYOND", 2.0)
    monkeypatch.setattr("cogmap.imagination.places.SAMPLED", 6)
    boxes = [box.model_dump() for box in room.boxes]
    gone = room.model_copy(update={"boxes": boxes[:1] + boxes[2:]})
    views, poses = remembered
    changed = camera.render(gone, poses[-6:])
    cmap = copy(dream.cmap)
    cmap.poses = {**cmap.poses, **{v.tobytes(): p for v, p in zip(changed, poses[-6:], strict=True)}}
    waking = Imagination(cmap, memory=dream.memory)
    surprised = waking.surprise(changed)
    assert surprised.alarms.mean() > 0.5
    usual = waking.surprise(views[-6:])
    assert not usual.alarms.any()
    everywhere = waking.places.position
    np.testing.assert_array_equal(usual.bounds, [everywhere.min(axis=0), everywhere.max(axis=0)])
    assert (surprised.shares < 0.1).all()
    box = np.array([[*boxes[1]["center"], 0.0]])
    where, _ = dream.cmap.framed(box)
    # six views from one square metre tell a direction well, and a distance badly
    seen, true = (complex(*place) for place in (surprised.plan().peak, where[0]))
    assert abs(np.angle(seen / true)) < 0.1
    with pytest.raises(CogmapError, match="nothing surprises"):
        usual.plan()


def test_recognising_corrects_a_wrong_percept(
    dream: Imagination, remembered: tuple[np.ndarray, np.ndarray]
) -> None:
    views, poses = remembered
    off = copy(dream.cmap)
    wrong = poses[-5:] + np.array([0.03, -0.02, 0.01])
    off.poses = {**off.poses, **{v.tobytes(): p for v, p in zip(views[-5:], wrong, strict=True)}}
    found = Imagination(off, memory=dream.memory).recognise(views[-5:])
    right, phase = dream.perceive(views[-5:])
    assert np.median(np.linalg.norm(found[:, :2] - right, axis=1)) < 0.015
    assert np.median(np.abs(found[:, 2] - phase)) < 0.004


def test_an_even_memory_serves(
    dream: Imagination, remembered: tuple[np.ndarray, np.ndarray], asked: np.ndarray
) -> None:
    views, poses = remembered
    memory = EvenMemory(150).partial_fit(views[:-10], poses[:-10, :2])
    position, phase = dream.perceive(asked)
    found = Imagination(dream.cmap, memory=memory).at(position, phase)
    assert np.median(psnr(found.views, asked)) > 25


def test_bad_input_is_refused_in_one_sentence(dream: Imagination, asked: np.ndarray) -> None:
    cmap = copy(dream.cmap)
    again = Imagination(cmap, memory=dream.memory)
    black = np.zeros_like(asked[0])
    with pytest.raises(CogmapError, match="view 1 is of one colour"):
        again.film(asked[0], black)
    with pytest.raises(CogmapError, match="record with the camera"):
        again.film(asked[0][:, :60], asked[1][:, :60])
    with pytest.raises(CogmapError, match=re.escape("heading has shape (3,)")):
        again.at(np.zeros((2, 2)), np.zeros(3))
    with pytest.raises(CogmapError, match="not finite"):
        again.at(np.full((2, 2), np.nan), 0.0)
    cmap.novelty = 9.0
    with pytest.raises(CogmapError, match=r"9\.0 times as unlike"):
        again.film(asked[0], asked[1])
    cmap.novelty, cmap.compass = 1.0, False
    with pytest.raises(CogmapError, match="no compass"):
        again.film(asked[0], asked[1])
    cmap.compass, cmap.relaxed_places_ = True, None
    with pytest.raises(CogmapError, match="does not turn views in the mind: told so"):
        again.at(np.zeros(2), 0.0)
