"""Progress: how far a map has grown, and how long it will take."""

from __future__ import annotations

from tqdm import tqdm

COSTS = {
    "ways": 110.0,
    "code": 810.0,
    "codes": 410.0,
    "charts": 300.0,
    "olfaction": 190.0,
    "recalled": 190.0,
    "cells": 70.0,
    "metric_map": 105.0,
    "corrected_metric_map": 80.0,
    "afferents": 35.0,
}
"""What a view costs beside others, as measured in `docs/howto/many_explorers.md`: they tell the time left."""
USUAL = 100.0
"""What it costs in a stage that is not among them."""


class Progress:
    """A bar on stderr with the time left, in what all that is left costs."""

    def __init__(self, *, disable: bool) -> None:
        shown = "{desc}{percentage:3.0f}%|{bar}| {elapsed}, {remaining} left"
        self._bar = tqdm(total=0.0, disable=disable, bar_format=shown, smoothing=0.1)

    def close(self) -> None:
        """Leave the bar as it is."""
        self._bar.close()

    def expect(self, name: str, views: int) -> None:
        """Count on so many views more in a stage."""
        self._bar.total = (self._bar.total or 0.0) + COSTS.get(name, USUAL) * views

    def update(self, name: str, views: int) -> None:
        """Say that so many views more have passed."""
        self._bar.set_description(name, refresh=False)
        self._bar.update(COSTS.get(name, USUAL) * views)
