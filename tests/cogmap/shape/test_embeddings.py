from typing import get_args

import numpy as np
import pytest
import scipy.sparse as sp
from sklearn.preprocessing import normalize

from cogmap.shape.embeddings import Embedding, Method, embedding


@pytest.mark.parametrize("method", get_args(Method))
def test_all_have_one_face_and_see_the_ring(method: Method) -> None:
    angle = np.random.default_rng(0).uniform(-np.pi, np.pi, 400)
    apart = np.abs(np.angle(np.exp(1j * (angle[:, None] - np.linspace(0, 2 * np.pi, 50, endpoint=False)))))
    X = normalize(sp.csr_array(np.maximum(1 - apart, 0), dtype=np.float32))
    model = embedding(method, 2, neighbours=10)
    assert isinstance(model, Embedding)
    for places, truth in ((model.fit_transform(X), angle), (model.transform(X[:50]), angle[:50])):
        assert places.shape == (len(truth), 2)
        seen = np.arctan2(places[:, 1], places[:, 0])
        assert max(abs(np.mean(np.exp(1j * (seen - sign * truth)))) for sign in (1, -1)) > 0.99
