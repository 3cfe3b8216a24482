"""Digests: what descriptions and arrays were when they were written, in a few characters."""

import hashlib
import json
from typing import Any

import google_crc32c
import numpy as np
from jaxtyping import Shaped


def digest(described: Any) -> str:
    """Give the SHA-256 of what JSON has said, whatever its spaces and the order of its keys."""
    text = json.dumps(described, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def checksum(values: Shaped[np.ndarray, "..."]) -> str:
    """Give the CRC-32C of an array's bytes, which no single bit can flip without changing."""
    return f"{google_crc32c.value(values.tobytes()):08x}"
