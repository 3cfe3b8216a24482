import numpy as np
import pytest

from cogmap.evaluation.betti_calibration import KINDS, SPACES, draw, judge


def test_spaces_and_kinds_take_turns() -> None:
    clouds = [draw(seed, crowd=(100, 120)) for seed in range(len(SPACES) * len(KINDS))]
    assert {(cloud.space, cloud.kind) for cloud in clouds} >= {(space, "strays") for space in SPACES}
    assert {cloud.kind for cloud in clouds} == {*KINDS}
    assert all((cloud.smells is not None) == (cloud.kind == "alike") for cloud in clouds)
    assert all(cloud.numbers == SPACES[cloud.space][1] for cloud in clouds)
    np.testing.assert_array_equal(draw(30, crowd=(100, 120)).views, clouds[30].views)


@pytest.mark.parametrize("seed", [1, 7, 19, 37])
def test_clean_noisy_and_strayed_clouds_are_right_and_resolved(seed: int) -> None:
    cloud = draw(seed, crowd=(800, 900))
    (found,) = judge(cloud, landmarks=(150, 60)).values()
    assert (found.numbers, found.resolved) == (cloud.numbers, (True,) * 3), str(found)


def test_places_that_look_alike_are_near_to_sight_and_far_to_smell() -> None:
    cloud = draw(48, crowd=(1500, 1600))
    assert cloud.smells is not None
    found = judge(cloud, landmarks=(150, 60))
    assert found.keys() == {"alike, sight", "alike, both senses"}
    for told in found.values():
        wrong = [n != wanted for n, wanted in zip(told.numbers, cloud.numbers, strict=True)]
        assert not any(np.logical_and(wrong, told.resolved)), str(told)
