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

    Where a code does not suffice it grows (`grown`): the components that it has stay as they are, and the
    same rule lets new ones learn what those leave.

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
        self.fixed: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.left: Tensor = nn.Buffer(torch.full((), torch.nan))
        self.enough: Tensor = nn.Buffer(torch.full((), torch.nan))

    def __len__(self) -> int:
        return len(self.weight)

    def forward(self, x: Float[Tensor, "views features"]) -> Float[Tensor, "views components"]:
        """Project onto the components learnt so far."""
        return torch.addmm(self.weight @ self.mean, x, self.weight.T, beta=-1)

    def partial_fit(self, x: Float[Tensor, "views features"]) -> None:
        """Take one Hebbian step on a batch."""
        self.steps += 1
        step, fixed = int(self.steps), int(self.fixed)
        if not fixed:  # those who stand on the code have its mean in theirs
            # a rate of 1 / n makes it the mean of all batches; the first sets it, whatever it began with
            self.mean += (x.mean(dim=0) - self.mean) / step
        y = self(x)
        self._measure(x, y, step)
        rate = 0.5 / (1 + step / 40)
        # a mean over the batch, so that the shorter one at the end of an epoch has the same rate
        share = rate / len(x)
        # what is kept of the weights, less the strict triangle: what earlier neurons explain. One product for
        # both, and all rows step from the same weights
        kept = torch.diag((1 - rate) * self.variance) - share * torch.tril(y.T @ y, diagonal=-1)
        fresh = y[:, fixed:]
        drive = torch.addmm(kept[fixed:] @ self.weight, fresh.T, x, alpha=share)
        # ⟨y (x − mean)ᵀ⟩ without a centred copy of x, which would take as long as the products
        drive.addr_(fresh.sum(dim=0), self.mean, alpha=-share)
        # unit rows by division and not by Oja's quadratic term, which diverges for rates near 1 / variance
        variance = drive.norm(dim=1)
        self.variance[fixed:] = variance
        self.weight[fixed:] = drive / variance[:, None].clamp(min=1e-12)

    def off(
        self, x: Float[Tensor, "views features"], y: Float[Tensor, "views components"]
    ) -> Float[Tensor, "views"]:
        """Square of what the code leaves of each view: its distance from the span of the components."""
        energy, told = (x - self.mean).square().sum(dim=1), self.orthonormal(y).square().sum(dim=1)
        return (energy - told).clamp(min=0)

    def orthonormal(self, y: Float[Tensor, "views components"]) -> Float[Tensor, "views components"]:
        """Give codes on orthonormal components of which the first n span what the first n of the code do."""
        # W = L Q with Q orthonormal, so that W Wᵀ = L Lᵀ, and y = W (x − mean) is L⁻¹ y on the rows of Q
        overlap = (self.weight @ self.weight.T).double()
        # rows that have hardly parted yet depend on each other; what they tell apart is rounding
        overlap.diagonal().add_(1e-4)
        factor = torch.linalg.cholesky(overlap).to(y)
        parts: Tensor = torch.linalg.solve_triangular(factor, y.T, upper=False)
        return parts.T

    def grown(self, components: int, *, generator: torch.Generator) -> "Sanger":
        """Give a code that has these components, fixed, and so many more, which have learnt nothing yet."""
        known, features = self.weight.shape
        other = Sanger(features, known + components, generator=generator)
        other.mean = self.mean.clone()
        other.enough = self.enough.clone() if int(self.fixed) else self.left.clone()
        other.weight[:known], other.variance[:known] = self.weight, self.variance
        other.fixed.fill_(known)
        return other.to(self.weight.device)

    def cut(self) -> None:
        """Keep the fewest new components that leave no more of views than before the code first grew."""
        # the last ones first: what is left without them grows by their variances
        left = self.left + self.variance.flip(0).cumsum(0)
        spare = min(int((left <= self.enough).sum()), len(self) - int(self.fixed))
        if spare:
            self.left = left[spare - 1].clone()
            self.weight, self.variance = (part[:-spare].contiguous() for part in (self.weight, self.variance))

    def _measure(
        self, x: Float[Tensor, "views features"], y: Float[Tensor, "views components"], step: int
    ) -> None:
        """Keep a running mean of what is left, over the last 20 batches."""
        left = self.off(x, y).mean()
        # the first batch sets it
        self.left = left if step == 1 else self.left + max(1 / step, 1 / 20) * (left - self.left)
