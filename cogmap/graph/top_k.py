"""Top k: the best of many candidates, kept while they stream by."""

import typing

import numpy as np

from cogmap.kernels import kernel


# Partitions by numpy take five times as long.
@kernel(nogil=True)
@typing.no_type_check
def offer(scores: np.ndarray, best: np.ndarray, names: np.ndarray, first: int, axis: int) -> None:
    """Offer each row of `scores`, or with `axis` 0 each column, to its ranking; the names count from `first`.

    A ranking is a row of `best`, scores in falling order, and of `names`. A candidate enters when it is
    better than the last, and then stands behind its equals.
    """
    # Row by row for both axes: scores lie in memory in this order, and down a column each is a cache miss.
    for row in range(scores.shape[0]):
        for column in range(scores.shape[1]):
            ranking, name = (row, column) if axis else (column, row)
            # Most candidates fail here, so that the ranking need not be a heap.
            if scores[row, column] > best[ranking, -1]:
                rank = best.shape[1] - 1
                # Strictly less: of equals the one that came first stays in front.
                while rank > 0 and best[ranking, rank - 1] < scores[row, column]:
                    best[ranking, rank] = best[ranking, rank - 1]
                    names[ranking, rank] = names[ranking, rank - 1]
                    rank -= 1
                best[ranking, rank] = scores[row, column]
                names[ranking, rank] = first + name
