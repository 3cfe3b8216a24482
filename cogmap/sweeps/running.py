"""A point of a sweep, done by whichever process."""

import json
import threading
import warnings
from pathlib import Path

from cogmap.crew import Wording
from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.experiments.registry import Experiment, experiments, run_experiment
from cogmap.portable import arithmetic
from cogmap.sweeps.ledger import KEPT, MARK, Ledger, Record, disk_errors, is_full_disk
from cogmap.sweeps.points import Point
from cogmap.sweeps.table import comparable

WORDING = Wording("a point", KEPT)
"""How a crew speaks of them."""
_alone = threading.Lock()
"""One point at a time in a process: they set the number of threads for all of it."""


def do(point: Point, *, ledger: Ledger, chosen: Experiment, again: bool) -> None:
    """Do the experiment of a point and put down what comes of it, unless this has been done.

    Parameters
    ----------
    point
        What to do.
    ledger
        Where what it finds is put down.
    chosen
        The experiment; a worker's own catalogue may not have it.
    again
        Whether to do it once more if it has failed.

    Raises
    ------
    CogmapError
        When this cannot be put down; whatever the experiment raises is put down.
    """
    if not (ledger.folder / MARK).exists():
        raise CogmapError(
            f"a worker finds no sweep in {ledger.folder}; choose a folder that all workers share"
        )
    with disk_errors(ledger.folder), _alone, ledger.lock(point):
        if ledger.lacks(point, again=again):
            experiments().setdefault(point.experiment, chosen)
            ledger.write(point, _outcome(point, ledger.walks) | {"arithmetic": arithmetic()})


def _outcome(point: Point, walks: Path) -> Record:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedMapWarning)  # the table says which maps are not trusted
            found = run_experiment(
                point.experiment,
                room=point.room if point.any_room else None,
                views=point.views,
                seed=point.seed,
                library=walks,
                **point.overrides,
            )
        return {"metrics": json.loads(json.dumps(comparable(found.metrics)))}
    except Exception as error:  # noqa: BLE001  whatever a point raises is its outcome
        if is_full_disk(error):
            raise CogmapError(f"there is no space left on a disk; {KEPT}") from None
        return {"error": " ".join(f"{type(error).__name__}: {error}".split())}
