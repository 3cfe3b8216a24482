import hashlib

import google_crc32c
import numpy as np

from arena.recordings.digests import checksum, digest


def test_digest_is_of_what_is_said_and_not_of_how() -> None:
    assert digest({"b": [1, 2.5], "a": "Ä"}) == digest({"a": "Ä", "b": [1, 2.5]})
    assert digest({"a": None}) == hashlib.sha256(b'{"a":null}').hexdigest()
    assert len({digest(told) for told in ({"a": 1}, {"a": 1.0}, {"a": "1"}, {"b": 1}, [1], {"a": -0.0})}) == 6


def test_checksum_is_of_the_bytes_in_order() -> None:
    values = np.arange(6.0).reshape(2, 3)
    assert checksum(values) == f"{google_crc32c.value(values.tobytes()):08x}"
    assert checksum(values.T) != checksum(values)
    assert checksum(values[:, ::2]) == checksum(values[:, ::2].copy())
    assert checksum(np.empty((0, 2))) == "00000000"
