import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.imagination.surprise import Surprise, unusual
from cogmap.imagination.turning import Painted


@pytest.mark.parametrize("sense", [1, -1])
def test_bearings_from_many_views_meet_where_something_changed(sense: int) -> None:
    rng = np.random.default_rng(0)
    position, phase, there = rng.uniform(-1, 1, (40, 2)), rng.uniform(-np.pi, np.pi, 40), np.array([1.4, 0.6])
    bounds = np.array([[-1.0, -1.0], [1.0, 1.0]])
    pixels = np.zeros((40, 5, 180), np.float32)
    for view, (place, heading) in enumerate(zip(position, phase, strict=True)):
        bearing = sense * (np.arctan2(*(there - place)[::-1]) - heading)
        column = int(np.floor((np.pi - bearing) * 180 / (2 * np.pi))) % 180
        pixels[view, 2, (column + np.arange(-1, 2)) % 180] = 5.0
        # and something else, each time elsewhere
        pixels[view, 1, rng.integers(180)] = 4.0
    found = Surprise(pixels, position, phase, 3.0, sense, bounds)
    assert found.alarms.all()
    np.testing.assert_allclose(found.shares, pixels.astype(bool).mean(axis=(1, 2)))
    np.testing.assert_allclose(found.plan().peak, there, atol=0.15)


def test_what_is_usual_grows_with_spread_and_where_flow_changed_much() -> None:
    rng = np.random.default_rng(0)
    view = rng.integers(0, 256, (20, 90, 3)).astype(np.float32)
    sure, unsure = np.zeros((20, 90), np.float32), np.full((20, 90), 30, np.float32)
    other = np.clip(view + 25, 0, 255)
    near = unusual(other, Painted(view, sure), view)
    assert (unusual(other, Painted(view, unsure), view) < near).all()
    assert (unusual(other, Painted(view, sure), view[::-1]) < near).all()
    assert not unusual(view, Painted(view, sure), view).any()
    plain = np.full((20, 90, 3), 100, np.float32)
    np.testing.assert_allclose(unusual(plain + 8, Painted(plain, sure), plain), 2.0, rtol=1e-5)


def looks(*most: float) -> Surprise:
    """Views from the left side of a room, one pixel of which surprises so much, straight ahead."""
    pixels = np.zeros((len(most), 3, 90), np.float32)
    pixels[:, 1, 45] = most
    position = np.column_stack([np.full(len(most), -0.9), np.linspace(-0.1, 0.1, len(most))])
    phase = -np.arctan2(position[:, 1], 1.9)
    return Surprise(pixels, position, phase, 3.0, 1, np.array([[-1.0, -1.0], [1.0, 1.0]]))


def test_many_views_tell_what_none_is_sure_of() -> None:
    unsure = looks(*[2.0] * 10, *[0.5] * 90)
    assert not unsure.alarms.any()
    assert unsure.notable.sum() == 10
    assert unsure.changed
    assert not looks(*[2.0] * 4, *[0.5] * 96).changed
    assert looks(3.5, *[0.5] * 99).changed
    with pytest.raises(CogmapError, match="nothing surprises"):
        looks(*[0.5] * 100).plan()


def test_the_plan_holds_all_that_is_remembered_and_not_only_where_these_views_are_from() -> None:
    plan = looks(*[2.0] * 20).plan()
    assert plan.x[0] < -1.9
    assert plan.x[-1] > 1.9
    assert plan.y[-1] > 1.9
    # one narrow side tells the direction alone: ahead, as far as the plan reaches
    assert abs(plan.peak[1]) < 0.2
