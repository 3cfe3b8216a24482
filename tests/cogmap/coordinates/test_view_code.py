import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.coordinates import view_code
from cogmap.coordinates.view_code import ViewCode
from cogmap.errors import CogmapError
from cogmap.features.image_codes import image_codes


def test_components_of_blurred_pictures(ring: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_code, "BLUR", 1e-3)
    monkeypatch.setattr(view_code, "STEPS", 150)
    code = ViewCode(3).fit(ring)
    assert code.eye_ == "perspective"
    pictures = image_codes(ring)
    deviations = pictures - pictures.mean(axis=0)
    variance = np.square(np.linalg.svd(deviations, compute_uv=False)[:3]).sum()
    assert np.square(code.transform(ring)).sum() == pytest.approx(variance, rel=0.02)


def test_eye_is_told_from_the_views() -> None:
    rng = np.random.default_rng(0)
    poses = np.column_stack([rng.uniform(-1, 1, size=(200, 2)), rng.uniform(-np.pi, np.pi, size=200)])
    views = Camera.panoramic(45, 8).render(Arena.load("furnished"), poses)
    code = ViewCode(10).fit(views)
    assert code.eye_ == "panorama"
    assert ViewCode(10, eye="perspective").fit(views).eye_ == "perspective"
    np.testing.assert_array_equal(code.transform(views[150:]), code.transform(views)[150:])


def test_same_seed_gives_the_same(ring: np.ndarray) -> None:
    one, same, other = (ViewCode(4, seed=seed).fit(ring).transform(ring[:9]) for seed in (0, 0, 1))
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)


def test_bad_input_gets_one_sentence(ring: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="components is 0"):
        ViewCode(0).fit(ring)
    code = ViewCode(3).fit(ring)
    with pytest.raises(CogmapError, match="12×24 pixels"):
        code.transform(ring[:, :12])
