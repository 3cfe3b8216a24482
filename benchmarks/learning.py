"""How fast neurons see, learn and perceive, against memory, slow feature analysis and scikit-learn."""

import time

import numpy as np
import torch
from sklearn.decomposition import PCA, IncrementalPCA

from arena import Brownian, Camera, explore
from benchmarks.timing import ROOM, Figures, one_core, poses, versus
from cogmap import CognitiveMap
from cogmap.evaluation.peers.slow_features import slow_cells
from cogmap.threads import in_order, one_thread
from neurons.layers.retina import Retina
from neurons.layers.sanger import Sanger

VIEWS = 4000
WALKED = 17_000
ROUNDS = 3


def learning() -> Figures:
    """See, learn and perceive panoramas of 360×60 pixels, views per second.

    A map learns 17,000 views on all cores, all stages. The peer passes them through the same retina, takes
    principal components, as many as the map, slow features of their products, twice, and independent
    components of these. On one core, retina and `perceive` stand beside reading the same bytes once. The view
    code alone is timed until it captures 99 % of the variance that 60 components can, beside IncrementalPCA.
    """
    walk = explore(ROOM, Brownian(), Camera.panoramic(), views=WALKED, seed=0)
    cmap = CognitiveMap()
    learnt = mapping(cmap, walk.views, walk.odours)
    with one_core(), one_thread():
        some = walk.views[:VIEWS]
        retina, seen = Retina(*some.shape[1:3]), torch.from_numpy(some)

        def read() -> int:
            return int(some.sum() > 0) * VIEWS

        figures: Figures = {
            "retina": versus(lambda: len(retina(seen)), read, beside="views.sum()"),
            "perceive": versus(lambda: len(cmap.perceive(some).phase), read, beside="views.sum()"),
        }
    return {"map": learnt, **figures, **coding()}


def mapping(cmap: CognitiveMap, views: np.ndarray, odours: np.ndarray) -> Figures:
    """Learn a map, in turn with slow features of the same walk."""

    def learn() -> int:
        cmap.fit(views, odours)
        return len(views)

    def peer() -> int:
        with one_thread():
            retina, batches = Retina(*views.shape[1:3]), torch.from_numpy(views).split(256)
            strips = torch.cat(list(in_order(retina, batches))).numpy()
            codes = PCA(cmap.components, svd_solver="covariance_eigh").fit_transform(strips)
            return len(slow_cells(codes, codes)[0].rates)

    found = versus(learn, peer, ROUNDS, beside="slow features and ICA")
    return {**found, "seconds": len(views) / float(found["per_s"]), "stages_seconds": dict(cmap.seconds_)}


def coding() -> Figures:
    """Time until the view code has learnt, and IncrementalPCA's over it."""
    with one_thread():
        strips = Retina(60, 360)(torch.from_numpy(Camera.panoramic().render(ROOM, poses(VIEWS))))
        centred = strips - strips.mean(dim=0)
        best = torch.linalg.svdvals(centred)[:60].square().sum()

        def captured(weight: torch.Tensor) -> float:
            basis = torch.linalg.qr(weight.T).Q
            return float((centred @ basis).square().sum() / best)

        layer = Sanger(strips.shape[1], 60, generator=torch.Generator().manual_seed(0))
        started = time.perf_counter()
        spent = 0.0
        while captured(layer.weight) < 0.99:
            started = time.perf_counter()
            for batch in strips.split(256):
                layer.partial_fit(batch)
            spent += time.perf_counter() - started
        peer = IncrementalPCA(60)
        started, taken = time.perf_counter(), 0.0
        for batch in strips.split(256):
            started = time.perf_counter()
            peer.partial_fit(batch.numpy())
            taken += time.perf_counter() - started
            if captured(torch.from_numpy(peer.components_).float()) >= 0.99:
                break
    return {"sanger_seconds": spent, "incremental_pca_over_sanger": taken / spent}
