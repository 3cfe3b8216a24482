import math

import numpy as np
import pytest
import torch

from neurons.angles import mean_angle, wrap_angle


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_half_a_turn_is_pi(dtype: torch.dtype) -> None:
    half = torch.tensor([math.pi, -math.pi], dtype=dtype)
    wrapped = wrap_angle(half)
    assert wrapped.dtype == dtype
    assert wrapped.equal(half[:1].expand(2))


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_wrapped_angles_agree_with_the_argument_of_the_unit_vector(dtype: torch.dtype) -> None:
    angle = torch.linspace(-20, 20, 4001, dtype=dtype)
    wrapped = wrap_angle(angle)
    assert (wrapped > torch.tensor(-math.pi, dtype=dtype)).all()
    assert (wrapped <= torch.tensor(math.pi, dtype=dtype)).all()
    np.testing.assert_allclose(
        np.exp(1j * wrapped.double().numpy()), np.exp(1j * angle.double().numpy()), atol=4e-6
    )


def test_unknown_angles_stay_unknown() -> None:
    assert wrap_angle(torch.tensor([torch.nan])).isnan().all()


def test_the_mean_of_angles_around_pi_is_pi() -> None:
    angle = torch.tensor([[math.pi - 0.2, 0.2 - math.pi, 1.0], [0.1, 0.3, 1.0]])
    mean = mean_angle(angle, torch.tensor([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]))
    torch.testing.assert_close(mean.abs(), torch.tensor([math.pi, 0.2]))
