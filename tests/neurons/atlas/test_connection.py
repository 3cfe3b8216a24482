from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
import torch
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.connection import LearntConnection
from neurons.atlas.synchronisation import Compass, synchronise
from neurons.layers.charts import Charts

SLOPES = torch.tensor([[1.0, -0.5, 2.0], [0.3, 1.5, -1.0]])
CURL = 0.15


class Swirl(NamedTuple):
    """Charts whose heading axes lean along a walk around the middle of the room: a connection with curl."""

    plain: Compass
    centres: Tensor
    gradients: Tensor
    smells: Tensor
    atlas: Atlas


@pytest.fixture(scope="module")
def swirl(tiling: tuple[Tensor, Charts], turning: Callable[[Tensor], Tensor]) -> Swirl:
    pose, charts = tiling
    axes = turning(pose)
    axes[:, 0] -= CURL * (pose[:, 1] - 0.5)
    axes[:, 1] += CURL * (pose[:, 0] - 0.5)
    gradients = torch.nn.functional.pad(SLOPES, (0, 0, 0, 2)).expand(len(pose), 4, 3)
    atlas = Atlas.of(charts.centres)
    plain = synchronise(charts.centres, axes, atlas)
    return Swirl(plain, charts.centres, gradients, pose[:, :2] @ SLOPES, atlas)


@pytest.fixture(scope="module")
def found(swirl: Swirl) -> Compass:
    return LearntConnection(rounds=4).refine(*swirl)


def resultant(compass: Compass, headings: Tensor) -> float:
    return max(abs(torch.exp(1j * (compass.phases + side * headings)).mean().item()) for side in (-1, 1))


def test_walking_that_turns_the_compass_is_learnt(
    swirl: Swirl, found: Compass, tiling: tuple[Tensor, Charts]
) -> None:
    pose, _ = tiling
    plain = swirl.plain
    assert 1 - found.eigenvalue < 0.3 * (1 - plain.eigenvalue)
    assert 1 - resultant(found, pose[:, 2]) < 0.5 * (1 - resultant(plain, pose[:, 2]))
    # what remains of walking in the turning covector
    sideways = [each.turning[:, :2].norm(dim=1).mean() for each in (found, plain)]
    assert sideways[0] < 0.5 * sideways[1]
    assert (found.scale, found.sign_agreement) == (plain.scale, plain.sign_agreement)
    assert plain.walking is None


def test_overlaps_that_are_wrong_count_less(swirl: Swirl, found: Compass) -> None:
    # one overlap in fifty joins charts that only look alike
    rng = torch.Generator().manual_seed(5)
    count = len(swirl.centres)
    wrong = torch.randint(count, (len(swirl.atlas.edges) // 50, 2), generator=rng).sort(dim=1).values
    wrong = wrong[wrong[:, 0] < wrong[:, 1]]
    atlas = replace(swirl.atlas, edges=torch.cat([swirl.atlas.edges, wrong]))
    misled = LearntConnection(rounds=4).refine(*swirl[:4], atlas)
    assert found.walking is not None
    assert misled.walking is not None
    off = (misled.walking - found.walking).norm() / found.walking.norm()
    assert off < 0.25, off


def test_agreement_is_told_of_all_overlaps_alike(swirl: Swirl, found: Compass) -> None:
    k, j = swirl.atlas.edges.T
    step = (0.5 * (swirl.centres[j] - swirl.centres[k]) * (found.turning[k] + found.turning[j])).sum(dim=1)
    k, j = k.numpy(), j.numpy()
    degree = np.bincount(np.r_[k, j])
    entry = np.exp(-1j * step.double().numpy()) / np.sqrt(degree[k] * degree[j])
    matrix = csc_array((np.r_[entry, entry.conj()], (np.r_[k, j], np.r_[j, k])), shape=(len(degree),) * 2)
    (value,), vector = eigsh(matrix, k=1, sigma=1.01, v0=np.sqrt(degree))
    assert found.eigenvalue == pytest.approx(value, abs=1e-5)
    apart = np.exp(1j * found.phases.double().numpy()) * vector[:, 0].conj()
    assert abs((apart / abs(apart)).mean()) > 0.999
