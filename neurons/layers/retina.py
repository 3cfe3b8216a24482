"""The retina: low acuity and contrast gain control of a panoramic strip."""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn

from neurons.errors import NeuronsError


def _circular_gaussian(columns: int, sigma: float) -> Float[Tensor, "columns columns"]:
    """Circulant matrix that blurs a ring of columns; each row sums to one."""
    offset = torch.arange(columns, dtype=torch.float64)
    distance = torch.minimum(offset, columns - offset)
    # in double precision, so that rows sum to one as exactly as float32 can say
    kernel = torch.exp(-0.5 * (distance / sigma) ** 2)
    index = (torch.arange(columns)[:, None] - torch.arange(columns)[None]) % columns
    return (kernel / kernel.sum())[index].float()


def _area_average(pixels: int, receptors: int) -> Float[Tensor, "receptors pixels"]:
    """Matrix that averages pixels over equal stretches of the image; each row sums to one."""
    edge = torch.linspace(0, pixels, receptors + 1, dtype=torch.float64)
    pixel = torch.arange(pixels, dtype=torch.float64)
    # stretches need not be whole pixels: a pixel counts by the part of it that lies inside
    overlap = torch.minimum(edge[1:, None], pixel + 1) - torch.maximum(edge[:-1, None], pixel)
    return (overlap.clamp(min=0) * receptors / pixels).float()


class Retina(nn.Module):
    """Centre-surround receptive fields along azimuth with divisive contrast normalisation.

    A view is averaged down to `rows` × `columns`, Y = G_acuity x − G_surround x, and the output is

        G_acuity [ Y / (s + floor · ⟨s⟩) ],   s² = G_pool ⟨Y²⟩ over rows and colours,

    where G_σ blurs around the ring with a Gaussian of σ columns. The gain control makes turning and walking
    move the output in orthogonal directions, whatever fills the view. Fixed: nothing is learnt here.

    Parameters
    ----------
    height, width
        Pixels of a view.
    rows, columns
        Receptors; 90 columns are 4° each.
    acuity, surround, pool
        Blurs in columns.
    floor
        Fraction of the mean contrast added to the local one, so that an empty wall is not amplified to noise.
    faintest
        Contrast (grey levels) that is amplified no further: above the rounding of float32, below any texture.

    Raises
    ------
    NeuronsError
        When a view has fewer pixels than the retina has receptors.

    References
    ----------
    Heeger (1992), Normalization of cell responses in cat striate cortex. Visual Neuroscience 9.
    """

    def __init__(
        self,
        height: int,
        width: int,
        *,
        rows: int = 15,
        columns: int = 90,
        acuity: float = 3.0,
        surround: float = 10.0,
        pool: float = 2.0,
        floor: float = 0.1,
        faintest: float = 0.002,
    ) -> None:
        super().__init__()
        if height < rows or width < columns:
            raise NeuronsError(
                f"views are {height}×{width} pixels; the retina needs at least {rows}×{columns}: "
                "record with a larger panoramic camera"
            )
        self.features = rows * 3 * columns
        self.floor, self.faintest = floor, faintest
        # both blurs in one matrix, as their difference is linear: one product per view
        blur = _circular_gaussian(columns, acuity)
        differences = blur - _circular_gaussian(columns, surround)
        # not saved with a map: they follow from the size of its views
        self.average: Tensor = nn.Buffer(_area_average(height, rows), persistent=False)
        centre_surround = _area_average(width, columns).T @ differences
        self.centre_surround: Tensor = nn.Buffer(centre_surround, persistent=False)
        self.pooling: Tensor = nn.Buffer(_circular_gaussian(columns, pool), persistent=False)
        self.blur: Tensor = nn.Buffer(blur, persistent=False)

    def forward(self, views: UInt8[Tensor, "views height width 3"]) -> Float[Tensor, "views features"]:
        """Turn views into normalised strips, rows × colours × columns."""
        # 16 views of 60 × 360 are 4 MB as floats; more leave the processor's cache
        return torch.cat([self._strips(batch) for batch in views.split(16)])

    def _strips(self, views: UInt8[Tensor, "batch height width 3"]) -> Float[Tensor, "batch features"]:
        # rows first: 60 become 15 before the product along azimuth, the larger one
        rows = self.average @ views.float().flatten(2)
        colours = rows.unflatten(2, (-1, 3)).transpose(2, 3).flatten(1, 2)
        strip = colours @ self.centre_surround
        # over rows and colours alike: one gain per column, so that a view keeps its colours;
        # pooled before the root: squares add up across columns, their roots do not
        contrast = (strip.square().mean(dim=1, keepdim=True) @ self.pooling).sqrt()
        # never 0: even a view of one colour is divided by `faintest`
        gain = contrast + self.floor * contrast.mean(dim=2, keepdim=True) + self.faintest
        return torch.flatten(strip / gain @ self.blur, start_dim=1)
