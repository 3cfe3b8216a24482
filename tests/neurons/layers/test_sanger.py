import numpy as np
import pytest
import torch
from torch import Tensor

from neurons.layers.sanger import Sanger

FEATURES, COMPONENTS = 200, 12


def data(views: int = 4000, seed: int = 0) -> Tensor:
    """Views with a decaying spectrum around a mean, in no particular basis."""
    rng = np.random.default_rng(seed)
    basis = np.linalg.qr(rng.normal(size=(FEATURES, FEATURES)))[0]
    spread = 0.8 ** np.arange(FEATURES) + 0.01
    x = (rng.normal(size=(views, FEATURES)) * spread) @ basis + rng.normal(size=FEATURES)
    return torch.from_numpy(x).float()


def learnt(x: Tensor, *, epochs: int, seed: int = 1) -> Sanger:
    layer = Sanger(FEATURES, COMPONENTS, generator=torch.Generator().manual_seed(seed))
    order = torch.Generator().manual_seed(2)
    for _ in range(epochs):
        for batch in x[torch.randperm(len(x), generator=order)].split(100):
            layer.partial_fit(batch)
    return layer


@pytest.fixture(scope="module")
def x() -> Tensor:
    return data()


@pytest.fixture(scope="module")
def layer(x: Tensor) -> Sanger:
    return learnt(x, epochs=12)


def test_same_components_as_singular_vectors(x: Tensor, layer: Sanger) -> None:
    centred = (x - x.mean(dim=0)).double().numpy()
    _, values, vectors = np.linalg.svd(centred, full_matrices=False)
    w = layer.weight.double().numpy()
    subspace = np.linalg.qr(w.T)[0]
    captured = np.square(centred @ subspace).sum()
    assert captured >= 0.995 * np.square(values[:COMPONENTS]).sum()
    np.testing.assert_allclose(w @ w.T, np.eye(COMPONENTS), atol=0.05)
    assert (np.abs(np.sum(w * vectors[:COMPONENTS], axis=1)) > 0.99).all()
    np.testing.assert_allclose(layer.variance, np.square(values[:COMPONENTS]) / len(x), rtol=0.1)


def test_code_is_centred_and_ordered(x: Tensor, layer: Sanger) -> None:
    code = layer(x)
    torch.testing.assert_close(code, (x - layer.mean) @ layer.weight.T)
    variance = code.var(dim=0)
    assert (variance[1:] < variance[:-1]).all()


def test_mean_is_that_of_the_batches() -> None:
    x = data(600)
    layer = learnt(x, epochs=1)
    torch.testing.assert_close(layer.mean, x.mean(dim=0), atol=1e-5, rtol=0)
    assert int(layer.steps) == 6


def test_same_generator_same_bits() -> None:
    x = data(500)
    first, again, other = learnt(x, epochs=1), learnt(x, epochs=1), learnt(x, epochs=1, seed=3)
    assert torch.equal(first.weight, again.weight)
    assert not torch.equal(first.weight, other.weight)


def test_a_code_that_grows_keeps_what_it_has_and_learns_what_is_left(layer: Sanger) -> None:
    other = data(seed=5)
    grown = layer.grown(COMPONENTS, generator=torch.Generator().manual_seed(4))
    order = torch.Generator().manual_seed(6)
    for _ in range(12):
        for batch in other[torch.randperm(len(other), generator=order)].split(100):
            grown.partial_fit(batch)
    torch.testing.assert_close(grown.weight[:COMPONENTS], layer.weight, rtol=0, atol=0)
    torch.testing.assert_close(grown.mean, layer.mean, rtol=0, atol=0)
    beyond = (other - layer.mean) - layer(other) @ layer.weight
    best = np.square(np.linalg.svd(beyond.double().numpy(), compute_uv=False)[:COMPONENTS]).sum()
    new = grown.weight[COMPONENTS:].double().numpy()
    captured = np.square(beyond.double().numpy() @ np.linalg.qr(new.T)[0]).sum()
    assert captured > 0.99 * best
    assert float(grown.off(other, grown(other)).mean()) == pytest.approx(float(grown.left), rel=0.1)


def test_a_grown_code_is_cut_to_what_leaves_no_more_than_before(x: Tensor, layer: Sanger) -> None:
    grown = layer.grown(COMPONENTS, generator=torch.Generator().manual_seed(4))
    for _ in range(3):
        for batch in x.split(100):
            grown.partial_fit(batch)
    assert float(grown.enough) == float(layer.left)
    # as if the old ones had left more: some of the new ones are spared, and no more
    grown.enough = grown.left + grown.variance[-5:].sum()
    whole = grown.weight.clone()
    grown.cut()
    assert len(grown) == 2 * COMPONENTS - 5
    torch.testing.assert_close(grown.weight, whole[:-5])
    assert float(grown.left) == pytest.approx(float(grown.enough))
    grown.enough.fill_(torch.inf)
    grown.cut()
    assert len(grown) == COMPONENTS
