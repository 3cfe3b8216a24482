import torch

from neurons.atlas.atlas import Atlas
from neurons.atlas.pieces import pieces


def cloud(count: int, at: float, seed: int) -> torch.Tensor:
    return torch.rand(count, 3, generator=torch.Generator().manual_seed(seed)) + at


def test_an_atlas_that_hangs_together_is_one_piece() -> None:
    points = cloud(300, 0.0, 0)
    (whole,) = pieces(Atlas.of(points), points)
    assert whole.tolist() == list(range(300))


def test_clouds_apart_are_pieces() -> None:
    points = torch.cat([cloud(200, 0.0, 1), cloud(100, 5.0, 2)])
    order = torch.randperm(300, generator=torch.Generator().manual_seed(3))
    found = pieces(Atlas.of(points[order]), points[order])
    assert sorted(map(len, found)) == [100, 200]
    for piece in found:
        assert (order[piece] < 200).all() or (order[piece] >= 200).all()


def test_an_overlap_much_longer_than_those_around_it_joins_nothing() -> None:
    # a lone chart just outside of one cloud has its nearest ones in both
    points = torch.cat([cloud(200, 0.0, 4), cloud(200, 1.5, 5), torch.tensor([[1.25, 1.25, 1.25]])])
    atlas = Atlas.of(points)
    assert len(pieces(atlas, points)) == 2
    assert len(pieces(atlas, points, longest=100.0)) == 1


def test_a_few_charts_apart_stay_with_the_nearest_piece() -> None:
    points = torch.cat([cloud(200, 0.0, 6), cloud(200, 5.0, 7), cloud(12, 8.0, 8)])
    found = pieces(Atlas.of(points), points)
    assert [len(piece) for piece in found] == [200, 212]
    alone = torch.cat([points[:200], points[400:]])
    assert len(pieces(Atlas.of(alone), alone, least=0.1)) == 1
