"""The retina: low acuity and contrast gain control of a strip, all around or with borders."""

import torch
from jaxtyping import Float, Int, UInt8
from torch import Tensor, nn

from neurons.errors import NeuronsError


def _gaussian(columns: int, sigma: float, *, wrap: bool) -> Float[Tensor, "columns columns"]:
    """Matrix that blurs columns, around a ring or up to the borders; the weights of each sum to one."""
    offset = torch.arange(columns, dtype=torch.float64)
    distance = torch.minimum(offset, columns - offset) if wrap else offset
    # in double precision, so that rows sum to one as exactly as float32 can say
    kernel = torch.exp(-0.5 * (distance / sigma) ** 2)
    # far below rounding; float32 would hold it as subnormals, with which products take fifty times as long
    kernel[kernel < 1e-20] = 0
    index = torch.arange(columns)[:, None] - torch.arange(columns)[None]
    if wrap:
        return (kernel / kernel.sum())[index % columns].float()
    weights = kernel[index.abs()]
    # columns of the matrix are receptors, as strips are multiplied from the left
    return (weights / weights.sum(dim=0)).float()


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

    where G_σ blurs along azimuth with a Gaussian of σ columns: around the ring of a panorama, or, without
    `wrap`, up to the borders of a picture, where what would lie beyond weighs nothing. The gain control makes
    turning and walking move the output of a panorama in orthogonal directions, whatever fills the view.
    Fixed: nothing is learnt here.

    Parameters
    ----------
    height, width
        Pixels of a view.
    rows, columns
        Receptors; 90 columns are 4° each.
    acuity, surround, pool
        Blurs in columns.
    wrap
        Whether the last column continues in the first, as in a panorama.
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
        wrap: bool = True,
    ) -> None:
        super().__init__()
        if height < rows or width < columns:
            raise NeuronsError(
                f"views are {height}×{width} pixels; the retina needs at least {rows}×{columns}: "
                "record with a larger camera"
            )
        self.features = rows * 3 * columns
        self.floor, self.faintest = floor, faintest
        # whole pixels of a receptor are summed as integers, which is exact and fast; fractions are weighed
        self.block = (
            height // rows if height % rows == 0 else 1,
            width // columns if width % columns == 0 else 1,
        )
        down, across = self.block
        # both blurs in one matrix, as their difference is linear: one product per view
        blur = _gaussian(columns, acuity, wrap=wrap)
        differences = blur - _gaussian(columns, surround, wrap=wrap)
        # not saved with a map: they follow from the size of its views
        self.average: Tensor = nn.Buffer(_area_average(height // down, rows), persistent=False)
        across_mean = _area_average(width // across, columns) / (down * across)
        self.centre_surround: Tensor = nn.Buffer(across_mean.T @ differences, persistent=False)
        self.pooling: Tensor = nn.Buffer(_gaussian(columns, pool, wrap=wrap), persistent=False)
        self.blur: Tensor = nn.Buffer(blur, persistent=False)

    def forward(self, views: UInt8[Tensor, "views height width 3"]) -> Float[Tensor, "views features"]:
        """Turn views into normalised strips, rows × colours × columns."""
        strips = self.blur.new_empty(len(views), self.features)
        # 2 MB, 32 views of 60 × 360; more leave the processor's cache
        batches = views.split(min(32, 1 + 2_000_000 // views.shape[1:].numel()))
        # made once for all batches: memory fresh from the system costs more time than what is done in it
        (down, across), (most, height, width, _) = self.block, batches[0].shape
        wide = torch.int16 if down * across <= 128 else torch.int32  # two bytes hold a sum of 128 pixels
        sums = views.new_empty(2, most, height // down, 3 * width, dtype=wide)
        pixels = strips.new_empty(most, height // down, 3, width // across)
        lines = strips.new_empty(most, len(self.average) * 3, len(self.blur))
        for batch, out in zip(batches, strips.split(len(batches[0])), strict=True):
            n = len(batch)
            self._average(batch, sums[:, :n], pixels[:n])
            self._look(pixels[:n], lines[:n], out)
        return strips

    def _average(
        self,
        views: UInt8[Tensor, "batch height width 3"],
        sums: Int[Tensor, "2 batch rows bytes"],
        out: Float[Tensor, "batch rows 3 pixels"],
    ) -> None:
        """Sum blocks of pixels, and part the colours."""
        down, across = self.block
        total, other = sums
        first, *others = views.flatten(2).unflatten(1, (-1, down)).unbind(2)
        total.copy_(first)
        for line in others:
            total += other.copy_(line)
        # at every byte and not at every block: what is contiguous is added many times as fast
        total, other = total.flatten(), other.flatten()
        ends = len(total) - 3 * (across - 1)
        beside = total
        for pixel in range(1, across):
            beside = torch.add(beside[:ends], total[3 * pixel :][:ends], out=other[:ends])
        step = (out.shape[1] * 3 * across * out.shape[3], 3 * across * out.shape[3], 1, 3 * across)
        out.copy_(beside.as_strided(out.shape, step))

    def _look(
        self,
        pixels: Float[Tensor, "batch rows 3 pixels"],
        lines: Float[Tensor, "batch lines columns"],
        out: Float[Tensor, "batch features"],
    ) -> None:
        if pixels.shape[1] > len(self.average):
            pixels = (self.average @ pixels.flatten(2)).unflatten(2, pixels.shape[2:])
        torch.mm(pixels.flatten(0, 2), self.centre_surround, out=lines.flatten(0, 1))
        # over rows and colours alike: one gain per column, so that a view keeps its colours;
        # pooled before the root: squares add up across columns, their roots do not
        contrast = (lines.square().mean(dim=1, keepdim=True) @ self.pooling).sqrt()
        # never 0: even a view of one colour is divided by `faintest`
        lines /= contrast + self.floor * contrast.mean(dim=2, keepdim=True) + self.faintest
        # one product for all lines of the batch: a product for each view would pay for its start each time
        torch.mm(lines.flatten(0, 1), self.blur, out=out.view(-1, len(self.blur)))
