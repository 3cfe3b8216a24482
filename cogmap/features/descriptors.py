"""Descriptors of spots of an image: SIFT around keypoints, colours of patches."""

from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float32, Int, UInt8


class Descriptors(NamedTuple):
    """Spots of several images, image after image."""

    values: Float32[np.ndarray, "spots features"]
    counts: Int[np.ndarray, "images"]
    """How many spots each image has."""


def keypoints(images: UInt8[np.ndarray, "images height width 3"]) -> Descriptors:
    """RootSIFT of the keypoints of the grey images: √(SIFT / its sum), 128 features of Euclidean length 1.

    An image without texture has none.

    References
    ----------
    Lowe (2004), Distinctive image features from scale-invariant keypoints. Arandjelović & Zisserman (2012),
    Three things everyone should know to improve object retrieval.
    """
    sift = cv2.SIFT_create()  # type: ignore[attr-defined]
    found = [sift.detectAndCompute(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), None)[1] for image in images]
    none = np.empty((0, sift.descriptorSize()), np.float32)
    values = np.concatenate([none, *(item for item in found if item is not None)])
    # A descriptor may be all zero.
    values /= np.maximum(values.sum(axis=1, keepdims=True), 1)
    return Descriptors(np.sqrt(values), np.array([0 if item is None else len(item) for item in found]))


def patches(images: UInt8[np.ndarray, "images height width 3"]) -> Descriptors:
    """Colours of patches of 32×32 pixels, every 16 pixels: the means of their four quarters in CIELAB.

    An image smaller than a patch is stretched to one.
    """
    cells = np.stack([_cells(image) for image in images])
    quarters = [cells[:, :-1, :-1], cells[:, :-1, 1:], cells[:, 1:, :-1], cells[:, 1:, 1:]]
    values = np.concatenate(quarters, axis=3)
    spots = values.reshape(-1, values.shape[3])
    return Descriptors(spots, np.full(len(images), len(spots) // len(images)))


def _cells(image: UInt8[np.ndarray, "height width 3"]) -> Float32[np.ndarray, "rows columns 3"]:
    # A patch of 32 pixels is four cells; patches overlap by half.
    rows, columns = (max(2, round(2 * size / 32)) for size in image.shape[:2])
    mean = cv2.resize(image, (columns, rows), interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.cvtColor(mean.astype(np.float32) / 255, cv2.COLOR_RGB2LAB))
