"""Vocabulary of visual words: typical descriptors, and which of them a descriptor resembles most."""

import cv2
import numpy as np
from jaxtyping import Float32, Int

EXAMPLES = 25_000
"""Most descriptors that are clustered."""
CHUNK = 2048
"""Descriptors compared with all words at a time; the products stay in the cache."""


def learn_words(
    descriptors: Float32[np.ndarray, "spots features"], count: int, seed: int
) -> Float32[np.ndarray, "words features"]:
    """Find cluster centres by k-means; of fewer different descriptors than `count`, each is a word.

    The same seed gives the same bits. Of more than `EXAMPLES` descriptors so many are taken, evenly spread.

    References
    ----------
    Arthur & Vassilvitskii (2007), k-means++: the advantages of careful seeding.
    """
    chosen = np.linspace(0, len(descriptors) - 1, min(len(descriptors), EXAMPLES)).astype(int)
    examples = descriptors[chosen]
    distinct = np.unique(examples, axis=0)
    if len(distinct) <= count:
        return distinct
    cv2.setRNGSeed(int(np.random.SeedSequence(seed).generate_state(1)[0] >> 1))
    # More than ten rounds of k-means hardly change how well words tell places.
    stop = (cv2.TERM_CRITERIA_MAX_ITER, 10, 0.0)
    labels = np.empty((len(examples), 1), np.int32)
    return np.asarray(cv2.kmeans(examples, count, labels, stop, 1, cv2.KMEANS_PP_CENTERS)[2])


def nearest_words(
    descriptors: Float32[np.ndarray, "spots features"], words: Float32[np.ndarray, "words features"]
) -> Int[np.ndarray, "spots"]:
    """Find the word at the smallest Euclidean distance from each descriptor."""
    # The nearest has the largest x·w − ½|w|²: one product of matrices for many descriptors.
    half = 0.5 * np.square(words).sum(axis=1)
    products = np.empty((CHUNK, len(words)), np.float32)
    found = np.empty(len(descriptors), int)
    for first in range(0, len(descriptors), CHUNK):
        chunk = descriptors[first : first + CHUNK]
        score = np.matmul(chunk, words.T, out=products[: len(chunk)])
        score -= half
        found[first : first + CHUNK] = score.argmax(axis=1)
    return found
