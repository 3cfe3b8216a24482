from collections.abc import Callable
from typing import NamedTuple

import pytest
import torch
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.connection import LearntConnection
from neurons.atlas.synchronisation import Compass, synchronise
from neurons.errors import NeuronsError
from neurons.layers.charts import Charts

SLOPES = torch.tensor([[1.0, -0.5, 2.0], [0.3, 1.5, -1.0]])


class Swirl(NamedTuple):
    """Charts whose heading axes lean along a walk around the middle of the room: a connection with curl."""

    centres: Tensor
    axes: Tensor
    gradients: Tensor
    smells: Tensor
    atlas: Atlas


@pytest.fixture(scope="module")
def swirl(tiling: tuple[Tensor, Charts], turning: Callable[[Tensor], Tensor]) -> Swirl:
    pose, charts = tiling
    axes = turning(pose)
    axes[:, 0] -= 1.2 * (pose[:, 1] - 0.5)
    axes[:, 1] += 1.2 * (pose[:, 0] - 0.5)
    gradients = torch.nn.functional.pad(SLOPES, (0, 0, 0, 2)).expand(len(pose), 4, 3)
    return Swirl(charts.centres, axes, gradients, pose[:, :2] @ SLOPES, Atlas.of(charts.centres))


def resultant(compass: Compass, headings: Tensor) -> float:
    return max(abs(torch.exp(1j * (compass.phases + side * headings)).mean().item()) for side in (-1, 1))


def test_walking_that_turns_the_compass_is_learnt(swirl: Swirl, tiling: tuple[Tensor, Charts]) -> None:
    pose, _ = tiling
    plain = synchronise(swirl.centres, swirl.axes, swirl.atlas)
    first, second = LearntConnection(rounds=4).compasses(*swirl)
    for found in (first, second):
        assert 1 - found.eigenvalue < 0.3 * (1 - plain.eigenvalue)
        assert resultant(found, pose[:, 2]) > resultant(plain, pose[:, 2])
        # what remains of walking in the turning covector
        sideways = [each.turning[:, :2].norm(dim=1).mean() for each in (found, plain)]
        assert sideways[0] < 0.4 * sideways[1]
    assert first.scale == plain.scale
    assert plain.walking is None


def test_agreement_is_told_of_all_overlaps_alike(swirl: Swirl) -> None:
    found = next(LearntConnection(rounds=2).compasses(*swirl))
    k, j = swirl.atlas.edges.T
    step = (0.5 * (swirl.centres[j] - swirl.centres[k]) * (found.turning[k] + found.turning[j])).sum(dim=1)
    matrix = torch.zeros(len(swirl.centres), len(swirl.centres), dtype=torch.cdouble)
    matrix[k, j] = torch.polar(torch.ones_like(step), -step).to(torch.cdouble)
    degree = torch.bincount(swirl.atlas.edges.flatten()).sqrt()
    trusted = torch.linalg.eigvalsh((matrix + matrix.mH) / (degree[:, None] * degree))[-1]
    assert found.eigenvalue == pytest.approx(float(trusted), abs=1e-5)


def test_no_compass_where_no_loop_closes(swirl: Swirl) -> None:
    straight = torch.cat([swirl.smells, torch.zeros(len(swirl.smells), 1)], dim=1)
    axes = torch.tensor([0.0, 0.0, 0.0, 1.0]).expand(len(straight), 4)
    with pytest.raises(NeuronsError, match="no loop"):
        synchronise(straight, axes, swirl.atlas)
    assert not list(LearntConnection().compasses(straight, axes, *swirl[2:]))
