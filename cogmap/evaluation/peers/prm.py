"""OMPL's probabilistic roadmap (PRM), the peer that knows the room, in a process of its own."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from arena import Arena, Arm
from cogmap.errors import CogmapError
from cogmap.inputs import check_array


def prm_paths(
    arena: Arena,
    pairs: Float[np.ndarray, "pairs 2 3"],
    *,
    radius: float,
    milestones: int,
    seed: int = 0,
    patience: float = 600.0,
) -> list[Float[np.ndarray, "_ 3"] | None] | None:
    """Plan in SE(2) with the arena's own collision check, on one roadmap for all queries.

    OMPL reports its leaks at exit, which is why it has a process of its own.

    Parameters
    ----------
    arena
        The room.
    pairs
        Poses (start, goal): x, y in m and heading in rad.
    radius
        Of the body, m.
    milestones
        Of the roadmap: as many as there are views, for a fair comparison.
    seed
        Of OMPL. The last milestones still depend on the clock.
    patience
        After which the planner is given up, s.

    Returns
    -------
    A path of poses for each pair, or None where there is none; None when `ompl` is not installed.

    Raises
    ------
    CogmapError
        For poses that are not finite, and when the planner fails.

    References
    ----------
    Şucan, Moll & Kavraki (2012), The Open Motion Planning Library.
    """
    check_array("pairs", pairs.reshape(-1, 3), (None, 3))
    return _asked(arena, pairs, patience, radius=radius, milestones=milestones, seed=seed)


def prm_joint_paths(
    arena: Arena,
    pairs: Float[np.ndarray, "pairs 2 joints"],
    *,
    arm: Arm,
    milestones: int,
    seed: int = 0,
    patience: float = 600.0,
) -> list[Float[np.ndarray, "_ joints"] | None] | None:
    """Plan over the joints of an arm without limits, edges checked at 1°; the rest as `prm_paths` does.

    Parameters
    ----------
    arena, arm
        The room, and what must touch nothing in it.
    pairs
        Postures (start, goal), rad.
    milestones, seed, patience
        See `prm_paths`.
    """
    check_array("pairs", pairs.reshape(-1, pairs.shape[-1]), (None, len(arm.axes)))
    return _asked(arena, pairs, patience, arm=arm.model_dump(), milestones=milestones, seed=seed)


def _asked(
    arena: Arena, pairs: Float[np.ndarray, "pairs 2 axes"], patience: float, **order: Any
) -> list[Float[np.ndarray, "_ axes"] | None] | None:
    if importlib.util.find_spec("ompl") is None:
        return None
    order |= {"arena": arena.to_toml(), "pairs": pairs.tolist()}
    with tempfile.TemporaryDirectory() as folder:
        request, response = Path(folder) / "asked.json", Path(folder) / "answered.json"
        request.write_text(json.dumps(order), encoding="utf-8")
        command = [sys.executable, "-m", "cogmap.evaluation.peers.ompl_worker", str(request), str(response)]
        try:
            ended = subprocess.run(command, capture_output=True, text=True, timeout=patience, check=False)  # noqa: S603
        except subprocess.TimeoutExpired:
            raise CogmapError(f"OMPL was not done after {patience:g} s; ask for fewer milestones") from None
        if not response.is_file():
            raise CogmapError(f"OMPL failed with code {ended.returncode}: {ended.stderr.strip()[-500:]}")
        paths = json.loads(response.read_text(encoding="utf-8"))
    return [None if path is None else np.array(path) for path in paths]
