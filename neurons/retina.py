"""The retina: low acuity and contrast gain control of a panoramic strip."""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn

from neurons.errors import NeuronsError


def _circular_gaussian(columns: int, sigma: float) -> Float[Tensor, "columns columns"]:
    """Circulant matrix that blurs a ring of columns; each row sums to one."""
    offset = torch.arange(columns, dtype=torch.float64)
    distance = torch.minimum(offset, columns - offset)
    kernel = torch.exp(-0.5 * (distance / sigma) ** 2)
    index = (torch.arange(columns)[:, None] - torch.arange(columns)[None]) % columns
    return (kernel / kernel.sum())[index].float()


class Retina(nn.Module):
    """Centre-surround receptive fields along azimuth with divisive contrast normalisation.

    A view is averaged down to `rows` × `columns`, Y = G_acuity x − G_surround x, and the output is

        G_acuity [ Y / (s + floor · ⟨s⟩) ],   s² = G_pool ⟨Y²⟩ over rows and colours,

    where G_σ blurs around the ring with a Gaussian of σ columns. The gain control makes turning and walking move the
    output in orthogonal directions, whatever fills the view. Fixed, nothing is learnt here.

    Parameters
    ----------
    rows, columns
        Receptors; 90 columns are 4° each.
    acuity, surround, pool
        Blurs in columns.
    floor
        Fraction of the mean contrast added to the local one, so that an empty wall is not amplified to noise.

    References
    ----------
    Heeger (1992), Normalization of cell responses in cat striate cortex. Visual Neuroscience 9.
    """

    centre_surround: Tensor
    pooling: Tensor
    blur: Tensor

    def __init__(
        self,
        rows: int = 15,
        columns: int = 90,
        *,
        acuity: float = 2.0,
        surround: float = 10.0,
        pool: float = 4.0,
        floor: float = 0.1,
    ) -> None:
        super().__init__()
        self.rows, self.columns, self.floor = rows, columns, floor
        blur = _circular_gaussian(columns, acuity)
        self.register_buffer("blur", blur, persistent=False)
        self.register_buffer(
            "centre_surround", blur - _circular_gaussian(columns, surround), persistent=False
        )
        self.register_buffer("pooling", _circular_gaussian(columns, pool), persistent=False)

    @property
    def features(self) -> int:
        """Length of the output, rows × 3 × columns."""
        return self.rows * 3 * self.columns

    def forward(self, views: UInt8[Tensor, "views height width 3"]) -> Float[Tensor, "views features"]:
        """Turn views into normalised strips.

        Raises
        ------
        NeuronsError
            When a view has fewer pixels than the retina has receptors.
        """
        height, width = views.shape[1:3]
        if height < self.rows or width < self.columns:
            raise NeuronsError(
                f"views are {height}×{width} pixels; the retina needs at least {self.rows}×{self.columns}: "
                "record with a larger panoramic camera"
            )
        image = views.permute(0, 3, 1, 2).float()
        strip = nn.functional.adaptive_avg_pool2d(image, (self.rows, self.columns))
        strip = strip.transpose(1, 2).reshape(len(views), self.rows * 3, self.columns) @ self.centre_surround
        contrast = (strip.square().mean(dim=1, keepdim=True) @ self.pooling).sqrt()
        gain = contrast + self.floor * contrast.mean(dim=2, keepdim=True) + 1e-6
        return (strip / gain @ self.blur).flatten(1)
