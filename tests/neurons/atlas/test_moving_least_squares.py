import numpy as np
import pytest
import torch
from sklearn.linear_model import Ridge

from neurons.atlas.moving_least_squares import FLATNESS, affine, apart, ties
from neurons.layers.place_cells import PlaceCells

CELLS = 25


@pytest.fixture(scope="module")
def cells() -> PlaceCells:
    place = PlaceCells(CELLS, 1, 3)
    place.centres = torch.randn(CELLS, 3, generator=torch.Generator().manual_seed(1))
    place.covariances = 0.5 * torch.eye(3).repeat(CELLS, 1, 1)
    return place


def test_affine_maps_are_what_the_stiff_prior_leaves(cells: PlaceCells) -> None:
    rng = torch.Generator().manual_seed(0)
    start, slope = torch.randn(1, generator=rng).double(), torch.randn(3, generator=rng).double()
    mapped = start + cells.centres.double() @ slope
    projection = affine(cells)
    torch.testing.assert_close(projection @ mapped, mapped)
    assert float(projection.trace()) == pytest.approx(4)
    torch.testing.assert_close(projection @ projection, projection)


def test_around_a_cell_the_map_goes_on_as_its_neighbours_lie(cells: PlaceCells) -> None:
    rng = torch.Generator().manual_seed(0)
    positions, centres = torch.randn(CELLS, generator=rng).double(), cells.centres.double()
    found = ties(cells) @ positions
    torch.testing.assert_close(found[:, 0], positions)
    near = cells.share(cells.centres).double()
    for cell in (0, 20):
        weight = (near + near.T)[cell].clone()
        weight[cell] = 0
        weight /= weight.sum()
        beside = centres - centres[cell]
        spread = float((weight[:, None] * beside.square()).sum() / 3)
        slope = Ridge(FLATNESS * spread, fit_intercept=False)
        slope.fit(beside, positions - positions[cell], sample_weight=weight)
        np.testing.assert_allclose(found[cell, 1:], slope.coef_, rtol=1e-6)


def test_the_prior_is_how_far_neighbours_lie_apart(cells: PlaceCells) -> None:
    positions = torch.randn(CELLS, generator=torch.Generator().manual_seed(0)).double()
    form = apart(cells)
    near = cells.share(cells.centres).double()
    near = near + near.T
    near.fill_diagonal_(0)
    between = (near * (positions - positions[:, None]).square()).sum() / 2 / near.sum(dim=1).mean()
    # and, very little, that they lie about 0
    wanted = float(between) + 1e-6 * float(positions.square().sum())
    assert float(positions @ form @ positions) == pytest.approx(wanted)
