import numpy as np
import pytest
import torch
from sklearn.neighbors import NearestNeighbors
from torch import Tensor

from neurons.atlas.atlas import Atlas


@pytest.fixture
def centres() -> Tensor:
    return torch.randn(300, 5, generator=torch.Generator().manual_seed(0))


def neighbours(centres: Tensor, count: int) -> tuple[np.ndarray, np.ndarray]:
    points = centres.double().numpy()
    distance, index = NearestNeighbors(n_neighbors=count).fit(points).kneighbors(points)
    return distance, index


@pytest.mark.parametrize(("overlaps", "pool"), [(8, 12), (5, 3)])
def test_pool_same_as_scikit_learn(centres: Tensor, overlaps: int, pool: int) -> None:
    _, index = neighbours(centres, pool)
    np.testing.assert_array_equal(Atlas.of(centres, overlaps=overlaps, pool=pool).pool, index)


@pytest.mark.parametrize(("overlaps", "pool"), [(8, 12), (5, 3)])
def test_edges_join_each_overlapping_pair_once(centres: Tensor, overlaps: int, pool: int) -> None:
    _, index = neighbours(centres, overlaps + 1)
    trusted = {(min(k, j), max(k, j)) for k, row in enumerate(index.tolist()) for j in row[1:]}
    edges = [tuple(edge) for edge in Atlas.of(centres, overlaps=overlaps, pool=pool).edges.tolist()]
    assert all(k < j for k, j in edges)
    assert edges == sorted(trusted)


def test_spacing_is_root_mean_square_distance(centres: Tensor) -> None:
    distance, _ = neighbours(centres, 9)
    spacing = np.sqrt(np.mean(distance[:, 1:] ** 2, axis=1))
    np.testing.assert_allclose(Atlas.of(centres).spacing, spacing, rtol=1e-5)


def test_lattice_far_from_the_origin_has_its_spacing() -> None:
    k = torch.arange(100.0)
    ring = 1000 + torch.stack([torch.cos(2 * torch.pi * k / 100), torch.sin(2 * torch.pi * k / 100)], dim=1)
    atlas = Atlas.of(ring)
    chords = 2 * np.sin(np.pi * np.array([1, 2, 3, 4]) / 100)
    np.testing.assert_allclose(atlas.spacing, np.sqrt(np.mean(chords**2)), rtol=5e-3)
    assert len(atlas.edges) == 400


def test_few_charts_overlap_all() -> None:
    atlas = Atlas.of(torch.eye(4))
    assert atlas.pool.shape == (4, 4)
    assert len(atlas.edges) == 6
    torch.testing.assert_close(atlas.spacing, torch.full((4,), 2**0.5))
