import numpy as np

from arena import Arena, Brownian, Camera, explore
from cogmap.experiments.controls.odour_ablation import PLACES, smell


def test_noiseless_smells_are_the_concentrations_of_the_sources_asked_for() -> None:
    room = Arena.load("furnished")
    walk = explore(room, Brownian(), Camera.panoramic(90, 15), views=50)
    assert [source.position for source in room.sources] == list(PLACES[:3])
    smelt = smell(room, walk, count=3, noise=0.0, seed=0)
    np.testing.assert_allclose(smelt, room.odours.concentration(walk.poses[:, :2]), rtol=1e-6)
    np.testing.assert_allclose(smell(room, walk, count=2, noise=0.0, seed=0), smelt[:, :2])
    noisy = np.log(smell(room, walk, count=4, noise=0.3, seed=0)[:, :3] / smelt)
    np.testing.assert_allclose(noisy.std(), 0.3, rtol=0.2)
