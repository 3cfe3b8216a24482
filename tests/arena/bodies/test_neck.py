import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.bodies.neck import ABOVE, DECK, Neck
from arena.errors import ArenaError
from arena.eye.base import see
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.rooms.materials import texture

ROOM = Arena.load("furnished")
EYE = Camera.panoramic(90, 20)
RNG = np.random.default_rng
ONE = np.zeros(1, int)


def seen(body: Neck, *configurations: list[float], eye: Camera = EYE) -> np.ndarray:
    views = np.empty((len(configurations), eye.height, eye.width, 3), np.uint8)
    see(eye, ROOM, body, np.array(configurations), out=views, rng=RNG(0))
    return views


def test_the_base_rolls_as_a_disc_and_the_head_turns_on_it() -> None:
    neck, disc = Neck(base=Disc(slip=0.1)).at_large(ROOM, 1), Disc(slip=0.1).at_large(ROOM, 1)
    neck.begin(ONE, np.array([[0.1, 0.2, 0.3, 1.0]]))
    disc.begin(ONE, np.array([[0.1, 0.2, 0.3]]))
    rng = RNG(4)
    neck.step(ONE, np.array([[0.4, 1.0, -2.0]]), 0.2, [rng])
    disc.step(ONE, np.array([[0.4, 1.0]]), 0.2, [RNG(4)])
    np.testing.assert_array_equal(neck.configurations[:, :3], disc.configurations)
    again = RNG(4)
    again.standard_normal(2)
    assert neck.configurations[0, 3] == pytest.approx(1.0 - 0.4 * (1 + 0.1 * again.standard_normal()))


def test_of_the_room_only_base_and_neck_together_are_seen() -> None:
    one, other = seen(Neck(), [0.5, 0.3, 1.0, 0.7], [0.5, 0.3, -0.5, 2.2])
    np.testing.assert_array_equal(one, other)


def test_the_deck_stays_where_the_base_is() -> None:
    """A base that turns changes the room above, a head that turns shifts the deck below by as much."""
    step = 2 * np.pi / 90
    plain = seen(Neck(), [0.5, 0.3, 0.0, 0.0])[0]
    still, turned, panned = seen(
        Neck(deck="seen"), [0.5, 0.3, 0.0, 0.0], [0.5, 0.3, 7 * step, 0.0], [0.5, 0.3, 0.0, 7 * step]
    )
    (rows,) = np.nonzero((still != plain).any(axis=(1, 2)))
    assert 2 <= len(rows) == 20 - rows[0] <= 6
    np.testing.assert_array_equal(turned[rows], still[rows])
    np.testing.assert_array_equal(turned[: rows[0]], panned[: rows[0]])
    np.testing.assert_allclose(panned[rows].astype(int), np.roll(still[rows].astype(int), 7, axis=1), atol=1)
    assert still[rows].std() > 20
    # All around the deck is its texture once: 113 texels of 1 cm, as far out as the row looks.
    focal, below = 90 / (2 * np.pi), rows[-1] + 0.5 - 10
    ring = texture(DECK)[:113, int(focal * ABOVE / below / 0.01)]
    np.testing.assert_allclose(still[rows[-1]].mean(axis=0), ring.mean(axis=0), atol=1)


def test_the_deck_moves_smoothly() -> None:
    pans = np.linspace(0, 2 * np.pi / 90, 9)
    views = seen(Neck(deck="seen"), *([0.5, 0.3, -pan, pan] for pan in pans)).astype(int)
    steps = np.abs(np.diff(views[:, -2:], axis=0)).mean(axis=(1, 2, 3))
    assert steps.max() < 2 * steps.min()


@pytest.mark.parametrize("eye", [Camera.perspective(40, 40), Camera.panoramic(90, 8)])
def test_a_deck_that_no_row_sees_is_refused(eye: Camera) -> None:
    with pytest.raises(ArenaError, match="no deck is seen"):
        seen(Neck(deck="seen"), [0.5, 0.3, 0.0, 0.0], eye=eye)
    seen(Neck(), [0.5, 0.3, 0.0, 0.0], eye=eye)
