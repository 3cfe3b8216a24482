"""`make verify`: of clouds of known holes no Betti number is resolved and wrong, and most are resolved."""

import sys

import pandas as pd
import pytest

from cogmap.evaluation.betti_calibration import calibrate

pytestmark = pytest.mark.full

CLOUDS = 200


def test_resolved_numbers_are_right() -> None:
    rows = pd.DataFrame(calibrate(CLOUDS))
    wrong = rows[~rows["right"] & rows["resolved"]]
    told = rows[rows["kind"] != "alike, sight"]
    share = (told["right"] & told["resolved"]).groupby(told["dimension"]).mean()
    sys.stdout.write(f"right and resolved: {share.round(3).to_dict()}; wrong and resolved: {len(wrong)}\n")
    assert wrong.empty, wrong.to_string()
    assert (share >= 0.9).all()
