import pytest
import torch

from neurons.layers.dimension import dimension_votes


def test_each_neighbourhood_votes_where_its_variances_fall_most() -> None:
    spectra = torch.tensor(
        [[0.9, 0.05, 0.03, 0.02], [0.45, 0.45, 0.05, 0.05], [0.5, 0.4, 0.06, 0.04], [0.3, 0.3, 0.3, 0.1]]
    )
    assert dimension_votes(spectra).tolist() == [0.25, 0.5, 0.25]


def test_what_is_below_the_floor_falls_no_further() -> None:
    """Noise of 1e-5 beside noise of 1e-9 is no gap."""
    assert dimension_votes(torch.tensor([[0.6, 0.4, 1e-5, 1e-9, 0.0]])).tolist() == pytest.approx(
        [0, 1, 0, 0]
    )
