"""Travels: pairs of poses, motor babbling, and the scores of the journeys between the pairs."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import Arena, Babble, Camera, Disc, explore
from arena.acting import Journeys, journeys
from arena.eye.base import Eye
from arena.motions.policy import Policy
from cogmap.control import MotorModel
from cogmap.control.percept import Percept
from cogmap.evaluation.shortest import shortest_lengths
from cogmap.experiments.poses import pose_columns, pose_errors
from cogmap.map.cognitive_map import CognitiveMap

BABBLED = 400
"""Decisions of motor babbling."""
CLEAR = 0.05
"""How far (m) starts and goals are from contact at least."""
MOST_STEPS = 400
"""Decisions after which a journey is ended."""
BABBLING_SEED, JOURNEY_SEED = 2000, 3000
"""Added to the seed."""


def babble(room: Arena, eye: Eye, percept: Percept | CognitiveMap, body: Disc, seed: int) -> MotorModel:
    """Learn what commands do, from what is perceived while they are given at random."""
    spell = explore(room, Babble(), eye, body=body, views=BABBLED, seed=seed + BABBLING_SEED)
    seen = percept.perceive(np.asarray(spell.views))
    return MotorModel().partial_fit(spell.require("commands")[:-1], seen[:-1], seen[1:])


def draw_poses(room: Arena, radius: float, count: int, rng: np.random.Generator) -> Float[np.ndarray, "_ 3"]:
    """Draw poses (m and rad) of a disc that are `CLEAR` of contact."""
    places = room.sample_free(count, radius + CLEAR, rng)
    return np.column_stack([places, rng.uniform(-np.pi, np.pi, count)])


def travel(
    room: Arena, policy: Policy, eye: Eye, starts: Float[np.ndarray, "pairs 3"], *, body: Disc, seed: int
) -> Journeys:
    """Let explorers go by a policy until they stop, all at once."""
    return journeys(room, policy, eye, starts, body=body, most_steps=MOST_STEPS, seed=seed + JOURNEY_SEED)


def scored(room: Arena, gone: Journeys, goals: Float[np.ndarray, "pairs 3"], body: Disc) -> pd.DataFrame:
    """Measure journeys, a row each: where from and whither, how far off they ended, their way, contacts."""
    starts, ends = gone.poses[0], gone.poses[-1]
    way = np.linalg.norm(np.diff(gone.poses[:, :, :2], axis=0), axis=2).sum(axis=0)
    shortest = shortest_lengths(room, np.stack([starts[:, :2], goals[:, :2]], axis=1), body.radius)
    return pd.DataFrame(
        {
            **pose_columns(starts, "start_"),
            **pose_columns(goals, "goal_"),
            **pose_columns(ends, "end_"),
            **pose_errors(ends, goals),
            "way_m": way,
            "shortest_m": shortest,
            "seconds": gone.times[gone.steps],
            "touched": gone.touched.any(axis=0),
        }
    )


def summary(table: pd.DataFrame) -> dict[str, float]:
    """Sum up journeys: shares that reached the goal, and their ways beside the shortest."""
    off, turned = table["position_error_m"], table["heading_error_deg"]
    return {
        "within_5cm_2deg": float(((off <= 0.05) & (turned <= 2)).mean()),
        "within_2cm_1deg": float(((off <= 0.02) & (turned <= 1)).mean()),
        "position_median_m": float(off.median()),
        "heading_median_deg": float(turned.median()),
        "path_ratio_median": float((table["way_m"] / table["shortest_m"]).median()),
        "touching": float(table["touched"].mean()),
        "seconds_median": float(table["seconds"].median()),
    }


def noisy(camera: Camera, noise: float) -> Camera:
    """Give a camera with this standard deviation of sensor noise, as a share of the range."""
    return camera.model_copy(update={"noise": noise})
