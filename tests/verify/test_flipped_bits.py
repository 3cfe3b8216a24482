"""`make verify`: 10,000 single flipped bits in all that is written, of which none may be believed."""

import sys
from pathlib import Path

import pytest

from tests.flipped import Judge, write_all

pytestmark = pytest.mark.full

FLIPS, VIEWS = 10_000, 300
"""Two shards."""


def test_ten_thousand_flipped_bits(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    judge = Judge(write_all(tmp_path, views=VIEWS))
    found = judge.flip(FLIPS, seed=19, check_every=10)
    assert capfd.readouterr() == ("", "")
    lines = [f"{kind}: {count} {verdict}" for (kind, verdict), count in sorted(found.items())]
    sys.stdout.write("\n".join([f"{FLIPS} flipped bits in {len(judge.files)} files, 0 believed", *lines, ""]))
    assert found.total() == FLIPS
    # only what describes the folder of signals to others, and is never read, may suffer unnoticed
    harmless = sum(count for (_, verdict), count in found.items() if verdict == "harmless")
    assert harmless <= 1.5 * FLIPS / len(judge.files)
