import numpy as np
import pandas as pd
import pytest

from arena import Arena
from cogmap.experiments.registry import run_experiment
from cogmap.experiments.rooms import morph
from cogmap.experiments.rooms.morph import _switch, blended, repainted


def test_a_blend_lies_between_both() -> None:
    one, other = np.zeros((1, 2, 2, 3), np.uint8), np.full((1, 2, 2, 3), 200, np.uint8)
    np.testing.assert_array_equal(blended(one, other, 0.0), one)
    np.testing.assert_array_equal(blended(one, other, 1.0), other)
    assert (blended(one, other, 0.3) == 60).all()


def test_all_walls_and_boxes_are_painted_and_nothing_moves() -> None:
    room = Arena.load("furnished")
    other = repainted(room)
    for part in ("walls", "boxes"):
        for before, after in zip(getattr(room, part), getattr(other, part), strict=True):
            assert before.material != after.material
            assert before.model_copy(update={"material": after.material}) == after
    assert (room.sources, room.platform) == (other.sources, other.platform)


def test_the_width_of_a_switch_is_found_and_a_flat_curve_has_none() -> None:
    blend = np.linspace(0, 1, 11)
    # from −1 to 1 between .3 and .5, with a little back and forth
    level = np.interp(blend, [0.0, 0.3, 0.5, 0.8, 0.9, 1.0], [-1.0, -1.0, 1.0, 1.0, 0.98, 1.0])
    rising = pd.DataFrame({"blend": blend, "place": level})
    assert _switch(rising, "place") == pytest.approx((0.4, 0.16))
    assert _switch(rising.assign(place=0.5), "place") is None
    sudden = rising.assign(place=np.where(blend < 0.55, -1.0, 1.0))
    assert _switch(sudden, "place") == pytest.approx((0.55, 0.08))


@pytest.mark.near_guard  # what is recognised does not depend on what is trusted
def test_cells_switch_between_two_rooms(monkeypatch: pytest.MonkeyPatch, small: Arena) -> None:
    monkeypatch.setattr(morph, "SEEDS", 2)
    monkeypatch.setattr(morph, "STEPS", 5)
    found = run_experiment("morph", views=500, room=small)
    curves = found.tables["curves"].groupby("blend")[["place", "room"]].mean()
    assert curves["place"].iloc[0] < -0.5
    assert curves["place"].iloc[-1] > 0.5
    assert curves["room"].iloc[-1] > 0.9
    assert 0.2 < found.metrics["switch_at_room"] < 0.8
    assert 0 < found.metrics["switch_width_place"] < 1
