"""Views of a real camera: they form the ring they should, and are placed better than by the nearest."""

import numpy as np
import pytest

import cogmap
from arena import Arena, Camera
from cogmap.experiments.own_data.real_camera import RealCamera, crops
from cogmap.features import BagOfWords, image_codes

KNOWN = slice(0, 200)
ASKED = slice(200, 300)


class Spin:
    """Small views that a camera takes while it spins on the spot."""

    def __init__(self) -> None:
        rng = np.random.default_rng(0)
        camera, here = Camera.panoramic(1024, 250), np.array([[0.3, -0.2, 0.0]])
        ideal = camera.render(Arena.load("furnished"), here)
        panorama = RealCamera(blur=1.0, noise=0.03, quality=60).photograph(ideal, rng)[0]
        self.yaws = rng.uniform(-np.pi, np.pi, 300)
        self.views = crops(panorama, self.yaws, width=120, height=90)
        self.words = BagOfWords(200, 50).fit_transform(self.views)

    def errors(self, found: cogmap.navigation.Location) -> tuple[float, float]:
        """Mean errors of what is located and of the nearest, rad."""
        off = np.angle(np.exp(1j * (self.yaws[KNOWN][found.indices] - self.yaws[ASKED][:, None])))
        read = np.abs((found.weights * off).sum(axis=1))
        return float(read.mean()), float(np.abs(off[:, 0]).mean())


@pytest.fixture(scope="module")
def spin() -> Spin:
    return Spin()


def test_crops_of_a_photograph_form_a_ring(spin: Spin) -> None:
    assert cogmap.betti(spin.words.toarray(), max_dimension=1).numbers == (1, 1)


def test_words_and_image_codes_place_them_far_better_than_the_nearest(spin: Spin) -> None:
    codes = image_codes(spin.views)
    localiser = cogmap.Localiser(spin.words[KNOWN], codes=codes[KNOWN])
    missed, nearest = spin.errors(localiser.locate(spin.words[ASKED], codes=codes[ASKED]))
    assert localiser.weighing.regressed
    assert missed < 0.25 * nearest


def test_words_alone_place_them_no_worse_than_the_nearest(spin: Spin) -> None:
    localiser = cogmap.Localiser(spin.words[KNOWN])
    missed, nearest = spin.errors(localiser.locate(spin.words[ASKED]))
    assert not localiser.weighing.regressed
    assert missed <= nearest
    regressed = cogmap.Localiser(spin.words[KNOWN], neighbours=60)
    assert spin.errors(regressed.locate(spin.words[ASKED]))[0] > nearest
