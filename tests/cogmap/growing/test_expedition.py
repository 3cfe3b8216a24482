import pickle

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, Cyclic, Disc, Nose
from cogmap import CogmapError
from cogmap.growing.expedition import TOGETHER, Expedition

ROOM = Arena.load("furnished")


def expedition(explorers: int = 3, views: int = 100, **changed: object) -> Expedition:
    parts: dict[str, object] = {
        "motion": Brownian(), "camera": Camera.panoramic(90, 15), "nose": Nose(), "body": Disc(), "seed": 0
    }  # fmt: skip
    return Expedition(ROOM.to_toml(), explorers=explorers, views=views, **{**parts, **changed})  # type: ignore[arg-type]


@pytest.mark.parametrize(("explorers", "views"), [(1, 1), (3, 100), (64, 1_000_000), (7, 100_003), (40, 40)])
def test_shares_are_whole_walks_in_order_and_all_of_them(explorers: int, views: int) -> None:
    one = expedition(explorers, views)
    assert [share.first for share in one.shares] == [0, *(share.end for share in one.shares[:-1])]
    assert one.shares[-1].end == explorers
    rows = np.concatenate([np.arange(views)[one.rows(k)] for k in range(explorers)])
    assert rows.tolist() == list(range(views))
    lengths = [one.rows(k).stop - one.rows(k).start for k in range(explorers)]
    assert max(lengths) - min(lengths) <= 1
    for share in one.shares:
        assert share.rows == slice(one.rows(share.first).start, one.rows(share.end - 1).stop)
        length = share.rows.stop - share.rows.start
        assert length <= max(min(TOGETHER, views // 16), lengths[share.first])


def test_an_explorer_goes_its_way_whoever_goes_beside_it() -> None:
    ways = [expedition().walk(k) for k in range(3)]
    again = pickle.loads(pickle.dumps(expedition())).walk(2)  # noqa: S301  as processes hand it on
    assert np.array_equal(ways[2].poses, again.poses)
    assert np.array_equal(ways[2].log_odours, again.log_odours)
    assert not np.array_equal(ways[0].poses[:33], ways[1].poses[:33])
    assert not np.array_equal(ways[0].poses, expedition(seed=1).walk(0).poses)


def test_what_is_smelt_is_smelt_there() -> None:
    way = expedition(nose=Nose(noise=0.0)).walk(0)
    expected = np.log(ROOM.odours.concentration(way.poses[:, :2]))
    np.testing.assert_allclose(way.log_odours, expected, rtol=1e-5)


def test_views_are_those_of_the_camera() -> None:
    one = expedition()
    way = one.walk(1)
    views = one.views_on(1, way.poses)
    assert views.shape == (33, 15, 90, 3)
    assert len(views) == 33
    assert np.array_equal(views[8:16], one.camera.render(ROOM, way.poses)[8:16])  # type: ignore[union-attr]


def test_a_noisy_eye_sees_the_same_twice_and_other_noise_elsewhere() -> None:
    one = expedition(camera=Camera.panoramic(90, 15).model_copy(update={"noise": 5.0}))
    poses = np.repeat(one.walk(0).poses[:1], 8, axis=0)
    first = one.views_on(0, poses)[0:4]
    assert np.array_equal(first, one.views_on(0, poses)[0:4])
    others = (one.views_on(0, poses)[4:8], one.views_on(1, poses)[0:4], one.views_from(poses, 0)[0:4])
    for other in others:
        assert not np.array_equal(first, other)


def test_it_is_sent_without_all_that_its_room_has_worked_out() -> None:
    one = expedition()
    one.views_on(0, one.walk(0).poses)[:]
    assert len(pickle.dumps(one)) < 20_000


def test_motions_that_give_too_few_views_are_refused() -> None:
    class Short(Cyclic):
        def walk(self, *args: object) -> object:  # type: ignore[override]
            walk = super().walk(*args)  # type: ignore[arg-type]
            return walk._replace(times=walk.times[:-1], poses=walk.poses[:-1])

    with pytest.raises(CogmapError, match="explorer 0 is to take 34 views and its motion gives 33"):
        expedition(motion=Short()).walk(0)
