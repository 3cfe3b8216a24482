from collections.abc import Callable

import numpy as np
import pytest
import torch
from scipy.optimize import minimize_scalar
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.synchronisation import Compass, synchronise
from neurons.errors import NeuronsError
from neurons.layers.charts import Charts

Tiling = tuple[Tensor, Charts]


def with_random_signs(axes: Tensor) -> Tensor:
    signs = torch.randint(2, (len(axes), 1), generator=torch.Generator().manual_seed(3))
    return axes * (2.0 * signs - 1)


def agreement(phases: Tensor, headings: Tensor) -> float:
    """Mean resultant length of phases and headings, up to a rotation and a mirror."""
    return max(abs(torch.exp(1j * (phases + side * headings)).mean().item()) for side in (-1, 1))


@pytest.fixture(scope="module")
def compass(tiling: Tiling, turning: Callable[[Tensor], Tensor]) -> Compass:
    pose, charts = tiling
    return synchronise(charts.centres, with_random_signs(turning(pose)), Atlas.of(charts.centres))


def test_phases_are_headings(compass: Compass, tiling: Tiling, radius: float) -> None:
    pose, _ = tiling
    assert agreement(compass.phases, pose[:, 2]) > 0.999
    assert compass.scale == pytest.approx(1 / radius, rel=0.03)
    assert 0.99 < compass.eigenvalue <= 1 + 1e-9


def test_axes_turn_the_same_way(
    compass: Compass, tiling: Tiling, turning: Callable[[Tensor], Tensor]
) -> None:
    pose, _ = tiling
    side = (compass.axes * turning(pose)).sum(dim=1)
    torch.testing.assert_close(side.abs(), torch.ones(len(pose)))
    assert side.unique_consecutive().round().unique().numel() == 1
    assert compass.sign_agreement > 0.999


def test_phases_grow_along_the_axes(compass: Compass, tiling: Tiling) -> None:
    _, charts = tiling
    k, j = Atlas.of(charts.centres).edges.T
    step = compass.scale * (compass.axes[k] * (charts.centres[j] - charts.centres[k])).sum(dim=1)
    error = torch.angle(torch.exp(1j * (compass.phases[j] - compass.phases[k] - step)))
    assert error.abs().median() < 0.05


def test_mirrored_world(compass: Compass, tiling: Tiling, turning: Callable[[Tensor], Tensor]) -> None:
    pose, charts = tiling
    flip = torch.tensor([1.0, 1.0, 1.0, -1.0])
    centres = charts.centres * flip
    mirrored = synchronise(centres, with_random_signs(turning(pose)) * flip, Atlas.of(centres))
    assert agreement(mirrored.phases, pose[:, 2]) > 0.999
    assert mirrored.scale == pytest.approx(compass.scale, rel=1e-3)
    assert mirrored.sign_agreement > 0.999


def test_units_of_the_code_do_not_matter(
    compass: Compass, tiling: Tiling, turning: Callable[[Tensor], Tensor]
) -> None:
    pose, charts = tiling
    large = synchronise(100 * charts.centres, turning(pose), Atlas.of(100 * charts.centres))
    assert large.scale == pytest.approx(compass.scale / 100, rel=1e-3)
    assert agreement(large.phases, pose[:, 2]) > 0.999


def test_sign_agreement_counts_frustrated_overlaps() -> None:
    """A Möbius band: axes leaning across it come back reversed after one turn."""
    angle = torch.linspace(0, 2 * torch.pi, 201)[:-1]
    around = torch.stack([angle.cos(), angle.sin(), torch.zeros(200)], dim=1)
    across = (angle / 2).cos()[:, None] * around + (angle / 2).sin()[:, None] * torch.tensor([0.0, 0, 1])
    along = torch.stack([-angle.sin(), angle.cos(), torch.zeros(200)], dim=1)
    tilted = across + 0.3 * along
    axes = tilted / tilted.norm(dim=1, keepdim=True)
    atlas = Atlas.of(around)
    k, j = atlas.edges.T.numpy()
    n = axes.double().numpy()
    found = synchronise(around, axes, atlas)
    product = np.einsum("ec,ec->e", found.axes.double().numpy()[k], found.axes.double().numpy()[j])
    trusted = product.sum() / np.abs(np.einsum("ec,ec->e", n[k], n[j])).sum()
    assert found.sign_agreement == pytest.approx(trusted, abs=1e-5)
    assert found.sign_agreement < 0.999


def test_same_scale_as_dense_eigenvalues() -> None:
    """An oval of uneven charts; λ(c) from numpy's dense solver, its maximum from scipy."""
    angle = 2 * np.pi * np.sort(np.random.default_rng(0).uniform(size=40))
    oval = np.column_stack([2 * np.cos(angle), np.sin(angle)])
    n = np.column_stack([-2 * np.sin(angle), np.cos(angle)])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    centres = torch.from_numpy(oval).float()
    atlas = Atlas.of(centres)
    found = synchronise(centres, torch.from_numpy(n).float(), atlas)
    overlap = np.zeros((40, 40))
    overlap[tuple(atlas.edges.T.numpy())] = 1
    overlap += overlap.T
    degree = overlap.sum(axis=1)
    omega = 0.5 * np.einsum("kjc,kjc->kj", oval[None] - oval[:, None], n[:, None] + n[None])

    def disagreement(scale: float) -> float:
        matrix = overlap * np.exp(-1j * scale * omega) / np.sqrt(np.outer(degree, degree))
        return -float(np.linalg.eigvalsh(matrix)[-1])

    best = minimize_scalar(disagreement, bounds=(0.9 * found.scale, 1.1 * found.scale), method="bounded")
    assert found.scale == pytest.approx(best.x, rel=2e-3)
    assert found.eigenvalue == pytest.approx(-best.fun, abs=1e-5)
    length = np.linalg.norm(np.diff(oval, axis=0, append=oval[:1]), axis=1).sum()
    assert found.scale == pytest.approx(2 * np.pi / length, rel=0.15)


@pytest.mark.parametrize("bend", [0.05, 1.0])
def test_patch_without_a_loop(bend: float) -> None:
    """The eigenvalue only falls along an arc."""
    x, y, angle = torch.rand(700, 3, generator=torch.Generator().manual_seed(4)).T * torch.tensor(
        [[1], [1], [bend]]
    )
    nought = torch.zeros(700)
    centres = torch.stack([x, y, angle.sin() / bend, angle.cos() / bend], dim=1)
    axes = torch.stack([nought, nought, angle.cos(), -angle.sin()], dim=1)
    with pytest.raises(NeuronsError, match="no loop of charts"):
        synchronise(centres, with_random_signs(axes), Atlas.of(centres))


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_straight_patch(noise: float) -> None:
    """Without noise the eigenvalue is 1 at every scale, give or take rounding."""
    generator = torch.Generator().manual_seed(5)
    centres = torch.rand(700, 3, generator=generator)
    axes = torch.tensor([0.0, 0.0, 1.0]) + noise * torch.randn(700, 3, generator=generator)
    with pytest.raises(NeuronsError, match="no loop of charts"):
        synchronise(centres, axes / axes.norm(dim=1, keepdim=True), Atlas.of(centres))


def test_atlas_in_two_pieces(tiling: Tiling, turning: Callable[[Tensor], Tensor]) -> None:
    pose, charts = tiling
    centres = charts.centres.clone()
    centres[600:, 0] += 50
    with pytest.raises(NeuronsError, match="falls into 2 pieces"):
        synchronise(centres, turning(pose), Atlas.of(centres))


@pytest.mark.parametrize("mirror", [False, True])
def test_a_compass_is_turned_and_mirrored_to_headings_that_are_known(compass: Compass, mirror: bool) -> None:  # noqa: FBT001
    known = 0.7 + (-compass.phases if mirror else compass.phases)
    turned = compass.turned_to(known)
    torch.testing.assert_close((turned.phases - known).cos(), torch.ones(len(known)), atol=1e-5, rtol=0)
    side = -1 if mirror else 1
    # so that headings change from chart to chart as before, the other way round in a mirror
    torch.testing.assert_close(turned.turning, side * compass.turning)
    assert (turned.scale, turned.eigenvalue) == (compass.scale, compass.eigenvalue)
