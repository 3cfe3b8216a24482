"""How fast neurons learn, against scikit-learn and slow feature analysis."""

import time

import torch
from sklearn.decomposition import PCA, IncrementalPCA

from arena import Brownian, Camera, explore
from benchmarks.timing import ROOM, Figures, poses
from cogmap import CognitiveMap
from cogmap.evaluation.peers.slow_features import slow_cells
from cogmap.threads import one_thread
from neurons.layers.retina import Retina
from neurons.layers.sanger import Sanger

VIEWS = 4000
WALKED = 17_000


def learning() -> Figures:
    """Measure a whole map, and its code alone."""
    return {"map": mapping(), **coding()}


def mapping() -> Figures:
    """Seconds in which a map learns from 17,000 views, all stages, beside slow features of the same walk.

    Both start from views and pass them through the retina. The peer then takes principal components, as many
    as the map, slow features of their products, twice, and independent components of these.
    """
    walk = explore(ROOM, Brownian(), Camera.panoramic(), views=WALKED, seed=0)
    cmap = CognitiveMap()
    started = time.perf_counter()
    cmap.fit(walk.views, walk.odours)
    spent = time.perf_counter() - started
    started = time.perf_counter()
    with one_thread():
        strips = Retina(60, 360)(torch.from_numpy(walk.views)).numpy()
        codes = PCA(cmap.components, svd_solver="covariance_eigh").fit_transform(strips)
        slow_cells(codes, codes)
    taken = time.perf_counter() - started
    return {
        "seconds": spent,
        "stages": dict(cmap.seconds_),
        "slow_features_seconds": taken,
        "over_slow_features": spent / taken,
    }


def coding() -> Figures:
    """Time to 99 % of the variance that 60 components can capture, IncrementalPCA's over Sanger's."""
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
