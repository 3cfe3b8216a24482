from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from cogmap.errors import CogmapError
from cogmap.pages.film import write_frames
from cogmap.pages.live.filming import RATE, journeys_filmed
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.picture import PLAN, STRIP, STRIPS, Painting
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

RED = (200, 69, 45)


def where(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    left, top, right, bottom = PLAN
    hits = (np.abs(picture[top:bottom, left:right].astype(int) - colour) < 12).all(axis=2)
    return np.add(np.argwhere(hits).mean(axis=0)[::-1], (left, top))


def test_a_picture_shows_the_explorer_where_it_is_and_what_it_sees(session: Session) -> None:
    painting = Painting(session.world)
    session.stand(0.0, 0.0, 0.5)
    here = painting.paint(session, session.look())
    session.stand(1.0, 0.0, 0.5)
    look = session.look()
    there = painting.paint(session, look)
    assert there.shape == (720, 1280, 3)
    moved = where(there, RED) - where(here, RED)
    np.testing.assert_allclose(moved, (painting._scale, 0), atol=3)
    (left, top), (wide, high) = STRIPS[0], STRIP
    seen = cv2.resize(look.view, STRIP, interpolation=cv2.INTER_AREA)
    np.testing.assert_array_equal(there[top : top + high, left : left + wide], seen)


def test_a_film_shows_an_explorer_that_goes(world: World, tmp_path: Path) -> None:
    frames = list(journeys_filmed(world, seconds=1.6, seed=1))
    assert len(frames) == round(1.6 * RATE)
    assert np.linalg.norm(where(frames[-1], RED) - where(frames[0], RED)) > 20
    write_frames(iter(frames), tmp_path / "film.gif", rate=RATE)
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames > len(frames) // 2
        assert film.info["duration"] == 80
        first = np.asarray(film.convert("RGB")).astype(int)
    assert np.abs(first - frames[0]).mean() < 6
    write_frames(iter(frames[:3]), tmp_path / "film.mp4", rate=RATE)
    assert cv2.VideoCapture(str(tmp_path / "film.mp4")).read()[1].shape == (720, 1280, 3)


def test_a_film_of_nothing_and_one_who_does_not_go_are_refused(world: World) -> None:
    with pytest.raises(CogmapError, match="positive time"):
        next(journeys_filmed(world, seconds=0.0))
    mind = Mind(world.mind.cmap, memory=world.walk.views)
    still = World(world.room, world.camera, world.body, mind, world.walk)
    with pytest.raises(CogmapError, match="--motor"):
        next(journeys_filmed(still, seconds=1.0))
