"""Principal components by Hebbian learning: Sanger's rule."""

import torch
from jaxtyping import Float
from torch import Tensor, nn


class Sanger(nn.Module):
    """A layer of linear neurons that learns the leading principal components, in order.

    Sanger's rule on batches, y = W (x − mean), with LT the strictly lower triangle:

        ΔW = η Λ⁻¹ (⟨y xᵀ⟩ − LT⟨y yᵀ⟩ W − Λ W),   then each row of W is scaled to unit length.

    Λ holds each neuron's output variance λ, learnt as the length of λw + η(…): the rate divided by it makes
    weak components converge as fast as strong ones. η falls from a half as 1 / n, n in batches, after the
    first 40.

    Parameters
    ----------
    features, components
        Inputs and outputs.
    generator
        Draws the initial weights.

    References
    ----------
    Sanger (1989), Optimal unsupervised learning in a single-layer linear feedforward neural network. Neural
    Networks 2.
    Weng, Zhang & Hwang (2003), Candid covariance-free incremental principal component analysis. IEEE PAMI 25
    (the rate).
    """

    def __init__(self, features: int, components: int, *, generator: torch.Generator) -> None:
        super().__init__()
        initial = torch.linalg.qr(torch.randn(features, components, generator=generator)).Q.T
        self.mean: Tensor = nn.Buffer(torch.zeros(features))
        self.weight: Tensor = nn.Buffer(initial.contiguous())
        self.variance: Tensor = nn.Buffer(torch.zeros(components))
        self.steps: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))

    def forward(self, x: Float[Tensor, "views features"]) -> Float[Tensor, "views components"]:
        """Project onto the components learnt so far."""
        return torch.addmm(self.weight @ self.mean, x, self.weight.T, beta=-1)

    def partial_fit(self, x: Float[Tensor, "views features"]) -> None:
        """Take one Hebbian step on a batch."""
        self.steps += 1
        step = int(self.steps)
        # a rate of 1 / n makes it the mean of all batches; the first sets it, whatever it began with
        self.mean += (x.mean(dim=0) - self.mean) / step
        y = self(x)
        rate = 0.5 / (1 + step / 40)
        # a mean over the batch, so that the shorter one at the end of an epoch has the same rate
        share = rate / len(x)
        # what is kept of the weights, less the strict triangle: what earlier neurons explain. One product for
        # both, and all rows step from the same weights
        kept = torch.diag((1 - rate) * self.variance) - share * torch.tril(y.T @ y, diagonal=-1)
        drive = torch.addmm(kept @ self.weight, y.T, x, alpha=share)
        # ⟨y (x − mean)ᵀ⟩ without a centred copy of x, which would take as long as the products
        drive.addr_(y.sum(dim=0), self.mean, alpha=-share)
        # unit rows by division and not by Oja's quadratic term, which diverges for rates near 1 / variance
        self.variance = drive.norm(dim=1)
        self.weight = drive / self.variance[:, None].clamp(min=1e-12)
