"""Resolution of a Betti number: whether its bars stand so clear of the threshold that the count is sure."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

Over = Float[np.ndarray, "_"]
"""π of bars over their threshold, in falling order: what counts is above 1."""

MARGINS = {0: (1.2, 0.9), 1: (1.2, 0.9), 2: (1.1, 0.97)}
"""Per dimension, the least of a bar that counts and the most of one that does not, over the threshold.

One pair each, calibrated on clouds of known holes (`cogmap.evaluation.betti_calibration`).
"""


def doubt(dimension: int, number: int, draws: Sequence[Over], checks: Sequence[tuple[str, Over]]) -> str:
    """Say in one sentence why a Betti number is not resolved; the empty one when it is.

    In the median draw the bars that count must stand well over the threshold and the next well under it, and
    every other look must count as many. Nothing of this can expose a real short cut: where two places look
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
        How else it was looked at, as "with 25 neighbours", and the bars that were found.
    """
    least, most = MARGINS[dimension]
    # What stands before the first bar is sure, and of a bar that is not there nothing is left.
    lines = [np.concatenate([[np.inf], bars, np.zeros(number + 1)])[number : number + 2] for bars in draws]
    weakest, strongest = np.median(lines, axis=0)
    if weakest < least:
        return f"its weakest bar stands at {weakest:.2f} of the threshold, below {least}"
    if strongest > most:
        return f"a bar that does not count stands at {strongest:.2f} of the threshold, above {most}"
    for check, bars in checks:
        if (counted := int(np.count_nonzero(bars > 1))) != number:
            return f"{check} it is {counted}"
    return ""
