"""Resolution of a Betti number: whether its bars stand so clear of the threshold that the count is sure."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

Over = Float[np.ndarray, "_"]
"""π of bars over their threshold, in falling order: what counts is above 1."""

MARGINS = {0: (1.2, 0.9), 1: (1.2, 0.9), 2: (1.2, 0.97)}
"""Per dimension, the least of a bar that counts and the most of one that does not, over the threshold.

One pair each, calibrated on clouds of known holes (`cogmap.evaluation.betti_calibration`).
"""


def doubt(dimension: int, number: int, draws: Sequence[Over], checks: Sequence[tuple[int, Over]]) -> str:
    """Say in one sentence why a Betti number is not resolved; the empty one when it is.

    In every draw the bars that count must stand well over the threshold and the next well under it, and a
    graph of other neighbours must count as many. Neither can expose a real short cut: where two places look
    alike their views *are* near to each other, in every draw, in every half, in every graph.

    Parameters
    ----------
    dimension
        Of homology.
    number
        Of the bars that count, by the majority.
    draws
        Bars of every draw of landmarks.
    checks
        Other numbers of neighbours, and the bars in their graphs.
    """
    least, most = MARGINS[dimension]
    # Nothing stands before the first bar, and nothing is left of one that is not there.
    lines = [np.concatenate([[np.inf], bars, np.zeros(number + 1)]) for bars in draws]
    weakest, strongest = min(bars[number] for bars in lines), max(bars[number + 1] for bars in lines)
    if weakest < least:
        return f"its weakest bar is {weakest:.2f} of the threshold, and only from {least} on it is sure"
    if strongest > most:
        return f"a bar that does not count is {strongest:.2f} of the threshold, and only to {most} it is sure"
    for neighbours, bars in checks:
        counted = int(np.count_nonzero(bars > 1))
        if counted != number:
            return f"with {neighbours} neighbours it is {counted}"
    return ""
