from collections.abc import Callable

import pytest
import torch
from torch import Tensor

from neurons.atlas.ambiguity import far_share, poses_told
from neurons.atlas.atlas import Atlas
from neurons.layers.charts import Charts


@pytest.fixture(scope="module")
def edges(tiling: tuple[Tensor, Charts]) -> Tensor:
    return Atlas.of(tiling[1].centres).edges


def test_what_a_sense_tells_apart_is_near(tiling: tuple[Tensor, Charts], edges: Tensor) -> None:
    pose, charts = tiling
    assert far_share(charts.centres, edges) == 0
    assert far_share(poses_told(pose[:, :2], pose[:, 2], edges), edges) == 0


@pytest.mark.parametrize(
    ("smell", "least"),
    [
        (lambda place: (place - 0.5).abs(), 0.2),
        (lambda place: place[:, :1], 0.3),
        (torch.ones_like, 0.6),
    ],
    ids=["folded", "of one source", "none"],
)
def test_smells_that_mean_several_places(
    tiling: tuple[Tensor, Charts], edges: Tensor, smell: Callable[[Tensor], Tensor], least: float
) -> None:
    pose, _ = tiling
    assert far_share(poses_told(smell(pose[:, :2]), pose[:, 2], edges), edges, far=3) > least


def test_smell_and_heading_count_in_units_of_their_change_across_an_overlap(
    tiling: tuple[Tensor, Charts], edges: Tensor
) -> None:
    pose, _ = tiling
    k, j = edges.T
    told = poses_told(7 * pose[:, :2], pose[:, 2], edges)
    apart = (told[k] - told[j])[:, :2].norm(dim=1).median()
    turned = (told[k] - told[j])[:, 2:].norm(dim=1).median()
    torch.testing.assert_close(torch.stack([apart, turned]), torch.ones(2), atol=1e-3, rtol=1e-3)


def test_headings_that_are_made_up(tiling: tuple[Tensor, Charts], edges: Tensor) -> None:
    pose, _ = tiling
    # half a room, mapped as if it were all: the two poses of each view smell of their own place
    heading = torch.where(pose[:, 0] > 0.5, pose[:, 2], -pose[:, 2])
    folded = torch.stack([(pose[:, 0] - 0.5).abs(), pose[:, 1]], dim=1)
    assert far_share(poses_told(folded, heading, edges), edges, far=3) > 0.1


def test_steps_and_shares_are_counted() -> None:
    # a chain of ten charts, of which the last looks like the first
    edges = torch.stack([torch.arange(9), torch.arange(1, 10)], dim=1)
    told = torch.arange(10.0)[:, None]
    told[9] = 0.1
    assert far_share(told, edges, nearest=1, far=8) == pytest.approx(2 / 10)
    assert far_share(told, edges, nearest=1, far=9) == 0


def test_nothing_is_known_without_a_compass(tiling: tuple[Tensor, Charts], edges: Tensor) -> None:
    pose, _ = tiling
    blind = torch.full((len(pose),), torch.nan)
    assert far_share(poses_told(pose[:, :2], blind, edges), edges) != far_share(pose, edges)
