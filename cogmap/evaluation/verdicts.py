"""Verdicts on what a map says of itself: whether an answer that it stands by is right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

Verdict = Literal["right", "unresolved", "WRONG"]
"""An answer stood by that is right; one not stood by, right or not; one stood by that is wrong."""

MOST = {"heading": ("heading_median_deg", 5.0), "place": ("position_median_m", 0.10)}
"""By answer: its figure in `cogmap.score`, and what it may come to in a map that is right."""


def figure_verdict(answer: str, figures: Mapping[str, float], *, trusted: bool) -> Verdict:
    """Judge `heading` or `place` by the figures of `cogmap.score`; a figure that is missing is wrong."""
    key, most = MOST[answer]
    if not trusted:
        return "unresolved"
    return "right" if figures.get(key, float("inf")) <= most else "WRONG"


def betti_verdict(numbers: Sequence[int], resolved: Sequence[bool], expected: Sequence[int]) -> Verdict:
    """Judge Betti numbers, each of which is resolved or not: one that is and is not as expected is wrong."""
    if any(sure and found != true for found, sure, true in zip(numbers, resolved, expected, strict=True)):
        return "WRONG"
    return "right" if all(resolved) else "unresolved"


def worst(verdicts: Sequence[Verdict]) -> Verdict:
    """Judge several answers together: right when all are, wrong when one is."""
    return next((verdict for verdict in ("WRONG", "unresolved") if verdict in verdicts), "right")
