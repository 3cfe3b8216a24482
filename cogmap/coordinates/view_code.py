"""The code of views by whatever eye: receptors that suit it, then components by Hebbian learning."""

from __future__ import annotations

from typing import Any, get_args

import cv2
import numpy as np
import torch
from jaxtyping import Float32
from sklearn.utils import gen_batches
from torch import Tensor

from cogmap.features.image_codes import HEIGHT, WIDTH, image_codes
from cogmap.features.seam import Eye, wraps_around
from cogmap.inputs import check_choice, checked_count, checked_views
from cogmap.threads import one_thread
from neurons.layers.retina import Retina
from neurons.layers.sanger import Sanger

BATCH = 256
"""Views learnt together; fixed, so that the same seed gives the same code."""
STEPS = 600
"""Batches from which the components are learnt, so many times as few views must be shown again: of 260, two
neurons were once found to have the same component."""
COLUMNS = 45
"""Of the retina, 8° each."""
ACUITY, SURROUND, POOL = 2.5, 8.0, 1.5
"""Its blurs in columns: almost twice those of a `CognitiveMap`. Codes of views that have nothing in common
are all equally far from each other; the more is blurred, the farther from each other are poses whose views
have something, and the fewer views show which are near."""
BLUR = 0.8
"""Of an image code, in its pixels: a thin link that has moved by its width is still where it was."""


class ViewCode:
    """Receptors and principal components, by which views that differ little in pose lie near each other.

    A panorama is seen by a retina (`neurons.layers.retina.Retina`), whose receptive fields run around the
    seam; any other picture as a small blurred one (`image_codes`), because gain control would amplify the
    still background that a fixed camera sees most of. Components are Sanger's in both cases.

    Parameters
    ----------
    components
        Of the code.
    eye
        "panorama" or "perspective"; told from the views themselves when None (`wraps_around`).
    seed
        Of the initial weights and the order of views.

    Attributes
    ----------
    eye_
        Which it is.
    view_shape_
        (height, width, 3) of the views.
    """

    def __init__(self, components: int = 60, *, eye: Eye | None = None, seed: int = 0) -> None:
        self.components = components
        self.eye = eye
        self.seed = seed

    def fit(self, views: Any) -> ViewCode:
        """Learn components of views, (views, height, width, 3) uint8, in an array or lazy.

        Raises
        ------
        CogmapError
            For views that are not uint8 images, an unknown eye, no components.
        """
        views = checked_views(views)
        components = checked_count("components", self.components)
        if self.eye is not None:
            check_choice("eye", self.eye, get_args(Eye))
        self.eye_: Eye = self.eye or ("panorama" if wraps_around(views) else "perspective")
        self.view_shape_ = tuple(views.shape[1:])
        with one_thread():
            seen = torch.cat([self._see(views[rows]) for rows in gen_batches(views.shape[0], BATCH)])
            generator = torch.Generator().manual_seed(self.seed)
            self._layer = Sanger(seen.shape[1], components, generator=generator)
            order = np.random.default_rng(self.seed)
            while int(self._layer.steps) < STEPS:
                for rows in torch.from_numpy(order.permutation(len(seen))).split(BATCH):
                    self._layer.partial_fit(seen[rows])
        return self

    def transform(self, views: Any) -> Float32[np.ndarray, "views components"]:
        """Give the code of views of the same shape.

        Raises
        ------
        CogmapError
            For other views than it was fitted to.
        """
        views = checked_views(views, self.view_shape_)
        with one_thread():
            parts = [self._layer(self._see(views[rows])) for rows in gen_batches(views.shape[0], BATCH)]
            return torch.cat(parts).numpy()

    def state(self) -> dict[str, Tensor]:
        """Give the weights of the components by name."""
        return dict(self._layer.state_dict())

    def restore(self, eye: Eye, view_shape: tuple[int, ...], state: dict[str, Tensor]) -> ViewCode:
        """Take over what another code has learnt."""
        self.eye_, self.view_shape_ = eye, view_shape
        components, features = state["weight"].shape
        self._layer = Sanger(features, components, generator=torch.Generator())
        self._layer.load_state_dict(state)
        return self

    def _see(self, views: Any) -> Tensor:
        pixels = np.ascontiguousarray(views)
        if self.eye_ == "perspective":
            pictures = image_codes(pixels).reshape(-1, HEIGHT, WIDTH, 3)
            return torch.from_numpy(
                np.stack([cv2.GaussianBlur(one, (0, 0), BLUR).ravel() for one in pictures])
            )
        height, width, _ = self.view_shape_
        retina = Retina(
            height,
            width,
            rows=min(15, height),
            columns=min(COLUMNS, width),
            acuity=ACUITY,
            surround=SURROUND,
            pool=POOL,
        )
        seen: Tensor = retina(torch.from_numpy(pixels))
        return seen
