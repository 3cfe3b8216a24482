from collections.abc import Callable

import numpy as np
import pytest
import torch
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.heading_axis import heading_axes
from neurons.layers.charts import Charts

SOURCES = torch.tensor([[-0.3, 0.2], [0.6, 1.4], [1.2, -0.4]])
Tiling = tuple[Tensor, Charts]


def gradients(place: Tensor) -> Tensor:
    """Gradients (x, y) of log odours, minus the distances to the sources."""
    toward = SOURCES - place[:, None]
    return (toward / toward.norm(dim=2, keepdim=True)).mT


def jacobians(tiling: Tiling, sources: slice = slice(None)) -> Tensor:
    pose, charts = tiling
    return charts.tangents[:, :, :2] @ gradients(pose[:, :2])[:, :, sources]


def degrees_apart(axes: Tensor, exact: Tensor) -> Tensor:
    cosine = (axes * exact).sum(dim=1).abs() / axes.norm(dim=1)
    return cosine.clamp(max=1).acos().rad2deg()


def test_turning_does_not_change_the_smell(tiling: Tiling, turning: Callable[[Tensor], Tensor]) -> None:
    pose, charts = tiling
    axes = heading_axes(charts.tangents, jacobians(tiling), Atlas.of(charts.centres)).axes
    assert degrees_apart(axes, turning(pose)).max() < 1
    torch.testing.assert_close(axes.norm(dim=1), torch.ones(len(pose)))


def test_pooling_sees_past_a_single_odorant(tiling: Tiling, turning: Callable[[Tensor], Tensor]) -> None:
    pose, charts = tiling
    change = jacobians(tiling)
    for source in range(3):
        change[source::3, :, [other for other in range(3) if other != source]] = 0
    axes = heading_axes(charts.tangents, change, Atlas.of(charts.centres)).axes
    assert degrees_apart(axes, turning(pose)).median() < 8
    change[::10] = 0
    axes = heading_axes(charts.tangents, change, Atlas.of(charts.centres)).axes
    assert axes.isfinite().all()
    assert degrees_apart(axes, turning(pose))[::10].median() < 8


def test_steep_neighbours_do_not_outvote(tiling: Tiling) -> None:
    _, charts = tiling
    atlas, change = Atlas.of(charts.centres), jacobians(tiling)
    factor = torch.rand(len(change), 1, 1, generator=torch.Generator().manual_seed(0)) * 100 + 1
    plain, scaled = (heading_axes(charts.tangents, each, atlas).axes for each in (change, factor * change))
    assert degrees_apart(plain, scaled).max() < 0.1


def test_a_sense_that_knows_turning_is_told(tiling: Tiling) -> None:
    """Noise of slopes is not shared by neighbours; a change that is felt is."""
    _, charts = tiling
    atlas, change = Atlas.of(charts.centres), jacobians(tiling)
    noise = 0.1 * torch.randn(change.shape, generator=torch.Generator().manual_seed(1))
    assert heading_axes(charts.tangents, change + noise, atlas).felt < 0.2
    turned = torch.cat([change + noise, charts.tangents[:, :, 2:]], dim=2)
    assert heading_axes(charts.tangents, turned, atlas).felt > 0.4


def by_loops(tangents: np.ndarray, jacobian: np.ndarray, pool: np.ndarray) -> np.ndarray:
    gradient = [u.T @ j / np.linalg.norm(j) for u, j in zip(tangents, jacobian, strict=True)]
    axes = []
    for k, u in enumerate(tangents):
        change = sum((u @ gradient[j]) @ (u @ gradient[j]).T for j in pool[k])
        axes.append(np.linalg.eigh(change)[1][:, 0] @ u)
    averaged = []
    for k, u in enumerate(tangents):
        lines = sum(np.outer(u @ axes[j], u @ axes[j]) for j in pool[k])
        averaged.append(np.linalg.eigh(lines)[1][:, -1] @ u)
    return np.array(averaged)


@pytest.mark.parametrize("seed", [0, 1])
def test_same_as_loops_on_noise(seed: int) -> None:
    generator = torch.Generator().manual_seed(seed)
    centres = torch.randn(40, 6, generator=generator)
    tangents = torch.linalg.qr(torch.randn(40, 6, 3, generator=generator)).Q.mT
    noise = torch.randn(40, 3, 4, generator=generator)
    atlas = Atlas.of(centres)
    axes = heading_axes(tangents, noise, atlas).axes.numpy()
    trusted = by_loops(tangents.double().numpy(), noise.double().numpy(), atlas.pool.numpy())
    assert np.median(np.abs(np.sum(axes * trusted, axis=1)) / np.linalg.norm(trusted, axis=1)) > 0.9999
