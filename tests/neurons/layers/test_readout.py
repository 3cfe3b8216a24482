from collections.abc import Callable

import numpy as np
import pytest
import torch
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.synchronisation import Compass
from neurons.layers.charts import Charts
from neurons.layers.readout import Readout

SLOPES = torch.tensor([[1.0, -0.5, 2.0], [0.3, 1.5, -1.0]])
OFFSETS = torch.tensor([0.5, -2.0, 1.0])
Tiling = tuple[Tensor, Charts]


def smell(pose: Tensor) -> Tensor:
    return OFFSETS + pose[:, :2] @ SLOPES


@pytest.fixture(scope="module")
def compass(tiling: Tiling, turning: Callable[[Tensor], Tensor], radius: float) -> Compass:
    pose, _ = tiling
    return Compass(turning(pose), 1 / radius, pose[:, 2], sign_agreement=1.0, eigenvalue=1.0)


@pytest.fixture(scope="module")
def settled(tiling: Tiling) -> Callable[[Compass | None], Readout]:
    pose, charts = tiling

    def solve(compass: Compass | None) -> Readout:
        jacobians = charts.tangents[:, :, :2] @ SLOPES
        readout = Readout(len(charts), 4, 3, 3)
        readout.solve(Atlas.of(charts.centres), compass, smell(pose), jacobians)
        return readout

    return solve


@pytest.fixture(scope="module")
def unseen(poses: Callable[[int, int], Tensor]) -> Tensor:
    return poses(500, 9)


def test_heading_and_odour_of_codes_held_out(
    tiling: Tiling,
    settled: Callable[[Compass | None], Readout],
    compass: Compass,
    unseen: Tensor,
    cylinder: Callable[[Tensor], Tensor],
) -> None:
    _, charts = tiling
    readout, codes = settled(compass), cylinder(unseen)
    *_, heading, odour = readout(charts, codes, readout.excite(charts, codes))
    error = torch.angle(torch.exp(1j * (heading - unseen[:, 2]))).rad2deg().abs()
    assert error.median() < 0.5
    assert error.max() < 3
    assert heading.abs().max() <= torch.pi
    torch.testing.assert_close(odour, smell(unseen), atol=1e-4, rtol=0)


@pytest.mark.parametrize("settings", [{}, {"winners": 5, "breadth": 0.3}])
def test_weights_are_gaussian_in_distance(
    tiling: Tiling,
    unseen: Tensor,
    cylinder: Callable[[Tensor], Tensor],
    settings: dict[str, float],
) -> None:
    _, charts = tiling
    readout, codes = Readout(len(charts), 4, 3, 3, **settings), cylinder(unseen)
    readout.spacing = Atlas.of(charts.centres).spacing
    chart, weight = readout.excite(charts, codes)
    torch.testing.assert_close(weight.sum(dim=1), torch.ones(len(codes)))
    assert chart.shape == (500, settings.get("winners", 8))
    distance = torch.cdist(codes.double(), charts.centres.double()).gather(1, chart).numpy()
    width = settings.get("breadth", 0.7) * Atlas.of(charts.centres).spacing.double().numpy()[chart.numpy()]
    activity = np.exp(-(distance**2) / (2 * width**2))
    np.testing.assert_allclose(weight, activity / activity.sum(axis=1, keepdims=True), atol=1e-4)


@pytest.mark.parametrize("tolerance", [1.4, 3.0, 1e9])
def test_charts_that_smell_of_another_place_fall_silent(tolerance: float) -> None:
    """Three charts of one place and two of another that looks the same: the more and the nearer decide."""
    charts = Charts(5, 4, 1, generator=torch.Generator().manual_seed(0))
    readout = Readout(5, 4, 1, 3, winners=5, tolerance=tolerance)
    readout.intercepts = torch.tensor([[0.0], [2.0], [0.1], [2.1], [-0.1]])
    readout.jacobians.zero_()
    readout.phases, readout.turning = torch.tensor([0.0, 3.0, 0.1, 3.0, -0.1]), torch.zeros(5, 4)
    charts.misfits = torch.tensor([1.0, 0.04])
    codes = torch.zeros(1, 4)
    chart, weight, heading, odour = readout(charts, codes, readout.excite(charts, codes))
    kin = np.exp(-0.5 * (readout.intercepts[:, 0].numpy() - 0.0) ** 2 / (tolerance**2 * 0.04))
    np.testing.assert_allclose(weight[0], (kin / kin.sum())[chart[0]], atol=1e-5)
    assert float(weight.sum()) == pytest.approx(1)
    if tolerance < 2:
        assert abs(float(odour)) < 0.01
        assert abs(float(heading)) < 0.01
    elif tolerance > 1e3:
        assert float(odour) == pytest.approx(float(readout.intercepts.mean()), abs=1e-4)


def test_no_compass_no_heading(
    tiling: Tiling,
    settled: Callable[[Compass | None], Readout],
    unseen: Tensor,
    cylinder: Callable[[Tensor], Tensor],
) -> None:
    _, charts = tiling
    readout, codes = settled(None), cylinder(unseen)
    *_, heading, odour = readout(charts, codes, readout.excite(charts, codes))
    assert heading.isnan().all()
    torch.testing.assert_close(odour, smell(unseen), atol=1e-4, rtol=0)
