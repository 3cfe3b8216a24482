"""Bags of visual words: a view as the set of words it shows."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, TypeVar

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float32, UInt8
from joblib import Parallel, cpu_count, delayed
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import normalize
from sklearn.utils import gen_batches
from sklearn.utils.validation import check_is_fitted
from tqdm import tqdm

from cogmap.features.descriptors import Descriptors, keypoints, patches
from cogmap.features.vocabulary import learn_words, nearest_words
from cogmap.inputs import checked_count, checked_views
from cogmap.threads import one_thread

Images = UInt8[np.ndarray, "images height width 3"]
Rows = Float32[np.ndarray, "_ _"]
"""Words or descriptors, (words, features) or (spots, features); each kind has its own number of both."""
Result = TypeVar("Result")

BLOCK = 64
"""Views that a worker is given at a time."""
SAMPLE = 1024
"""Views whose descriptors are clustered, in blocks spread evenly over all."""


class BagOfWords(TransformerMixin, BaseEstimator):
    r"""Visual words: which of `words` textures and `colours` colourings occur in each view.

    Words are typical descriptors: cluster centres of the `keypoints` (RootSIFT) and of the `patches` (colour)
    of a sample of views. Every descriptor is taken for the word nearest to it. Word i has the value

    .. math:: u_i = \log(N / n_i)

    in the views where it occurs, which are n_i of the N views learnt from, and 0 in the others. Rows are then
    scaled to length one, so that their dot product is their cosine; a view that shows only what every view
    shows is a row of zeros.

    Views are read block by block and may lie on disk, and each is described once. The result depends on the
    seed alone, not on the number of workers.

    Parameters
    ----------
    words, colours
        Words of each kind; there are fewer when there are fewer different descriptors.
    seed
        Draws the first cluster centres.
    workers
        Threads; as many as cores when None.
    progress
        Whether to show a bar on stderr.

    Attributes
    ----------
    vocabulary_ : float32 (words, 128)
        Textures.
    palette_ : float32 (colours, 12)
        Colourings.
    idf_ : float32 (words + colours,)
        log N / n; 0 for a word that no view shows.

    Raises
    ------
    CogmapError
        For views that are not uint8 images (views, height, width, 3) and for counts below one.

    References
    ----------
    Sivic & Zisserman (2003), Video Google: a text retrieval approach to object matching in videos.
    """

    def __init__(
        self,
        words: int = 800,
        colours: int = 200,
        *,
        seed: int = 0,
        workers: int | None = None,
        progress: bool = False,
    ) -> None:
        self.words = words
        self.colours = colours
        self.seed = seed
        self.workers = workers
        self.progress = progress

    def fit(self, X: Any, y: object = None) -> "BagOfWords":
        """Learn the words of views, and how rare each is."""
        self.fit_transform(X, y)
        return self

    def fit_transform(self, X: Any, y: object = None) -> sp.csr_array:
        """Learn the words of views, and give those that each shows: float32 (views, words + colours)."""
        del y
        X = checked_views(X)
        counts = checked_count("words", self.words), checked_count("colours", self.colours)
        seed = checked_count("seed", self.seed, 0)
        blocks = list(gen_batches(X.shape[0], BLOCK))
        sample = blocks[:: -(-len(blocks) * BLOCK // SAMPLE)]
        rest = [block for block in blocks if block not in sample]
        with self._bar(X) as bar, one_thread():
            described = list(self._over(_describe, X, sample, bar))
            kinds = (np.concatenate([item.values for item in kind]) for kind in zip(*described, strict=True))
            self.vocabulary_, self.palette_ = (
                learn_words(kind, count, seed) for kind, count in zip(kinds, counts, strict=True)
            )
            shown = [_show(item, self._words) for item in described]
            shown = [*shown, *self._over(partial(_read, words=self._words), X, rest, bar)]
        order = np.argsort([block.start for block in (*sample, *rest)])
        shown = sp.vstack([shown[block] for block in order], format="csr")
        occurrences = np.bincount(shown.indices, minlength=shown.shape[1])
        self.idf_ = np.log(X.shape[0] / np.maximum(occurrences, 1), dtype=np.float32)
        self.idf_[occurrences == 0] = 0
        return self._weigh(shown)

    def transform(self, X: Any) -> sp.csr_array:
        """Give the words that each view shows: float32 (views, words + colours)."""
        check_is_fitted(self)
        X = checked_views(X)
        with self._bar(X) as bar, one_thread():
            blocks = list(gen_batches(X.shape[0], BLOCK))
            shown = list(self._over(partial(_read, words=self._words), X, blocks, bar))
        return self._weigh(sp.vstack(shown, format="csr"))

    @property
    def _words(self) -> tuple[Rows, Rows]:
        return self.vocabulary_, self.palette_

    def _bar(self, X: Any) -> "tqdm[Any]":
        return tqdm(total=X.shape[0], unit="view", disable=not self.progress)

    def _over(
        self, work: Callable[[Images], Result], X: Any, blocks: list[slice], bar: "tqdm[Any]"
    ) -> Iterator[Result]:
        """Work on blocks of views, in order."""
        # OpenCV and BLAS release the interpreter: threads save carrying views to other processes.
        crew = Parallel(self.workers or cpu_count(), return_as="generator", prefer="threads")
        results = crew(delayed(_on)(work, X, block) for block in blocks)
        for block, result in zip(blocks, results, strict=True):
            bar.update(block.stop - block.start)
            yield result

    def _weigh(self, shown: sp.csr_array) -> sp.csr_array:
        rows = sp.csr_array((self.idf_[shown.indices], shown.indices, shown.indptr), shape=shown.shape)
        rows.eliminate_zeros()
        return sp.csr_array(normalize(rows, copy=False))


def _on(work: Callable[[Images], Result], X: Any, block: slice) -> Result:
    return work(np.asarray(X[block]))


def _describe(images: Images) -> tuple[Descriptors, Descriptors]:
    return keypoints(images), patches(images)


def _read(images: Images, words: tuple[Rows, Rows]) -> sp.csr_array:
    return _show(_describe(images), words)


def _show(described: tuple[Descriptors, Descriptors], words: tuple[Rows, Rows]) -> sp.csr_array:
    """Tell which words occur in each image."""
    rows, columns, offset = [], [], 0
    for (values, counts), vocabulary in zip(described, words, strict=True):
        if len(vocabulary):
            rows.append(np.repeat(np.arange(len(counts)), counts))
            columns.append(offset + nearest_words(values, vocabulary))
            offset += len(vocabulary)
    spots = np.concatenate(rows), np.concatenate(columns)
    return sp.csr_array((np.ones(len(spots[0]), bool), spots), shape=(len(described[0].counts), offset))
