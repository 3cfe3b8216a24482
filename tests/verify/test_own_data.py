"""`make verify`: views as real cameras deliver them, three seeds each, figures with their bars."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import cogmap
from arena import Arena, Brownian, Camera, explore
from cogmap.evaluation.located import turned_poses
from cogmap.experiments.own_data.real_camera import RealCamera, crops
from cogmap.experiments.paper.localisation import interpolated_poses
from cogmap.experiments.poses import pose_errors
from cogmap.features import BagOfWords, image_codes
from cogmap.graph.neighbour_graph import neighbour_graph
from cogmap.shape import circular_coordinate

pytestmark = pytest.mark.full

SEEDS = (0, 1, 2)
ROOM = Arena.load("furnished")


def medians(read: np.ndarray, truth: np.ndarray, prefix: str) -> dict[str, float]:
    errors = pose_errors(read, truth, prefix)
    return {f"{key.replace('_error', '_median')}": float(np.median(part)) for key, part in errors.items()}


def agreement(phases: np.ndarray, angles: np.ndarray) -> float:
    return float(max(abs(np.exp(1j * (phases - sign * angles)).mean()) for sign in (1, -1)))


def evenly(angles: np.ndarray) -> np.ndarray:
    """Angles by their ranks, as circular coordinates are."""
    return np.asarray(2 * np.pi * np.argsort(np.argsort(angles)) / len(angles))


@cache
def spin(seed: int) -> dict[str, Any]:
    """600 crops of a photographed panorama, at random yaws: 400 are remembered."""
    rng = np.random.default_rng(seed)
    here = np.append(rng.uniform([-1.5, -1], [1.5, 1]), 0.0)
    ideal = Camera.panoramic(2048, 500).render(ROOM, here[None])
    panorama = RealCamera(blur=2.0, noise=0.05, quality=60).photograph(ideal, rng)[0]
    yaws = rng.uniform(-np.pi, np.pi, 600)
    views = crops(panorama, yaws)
    poses = np.column_stack([np.tile(here[:2], (600, 1)), yaws])
    words, codes, known, asked = (
        BagOfWords().fit_transform(views),
        image_codes(views),
        slice(400),
        slice(400, 600),
    )
    shape = cogmap.betti(words.toarray())
    phases = circular_coordinate(neighbour_graph(words, 25, metric="cosine")).phase
    figures: dict[str, Any] = {
        "betti": list(shape.numbers),
        "pieces_and_loop_resolved": all(shape.resolved[:2]),
        "void_resolved": shape.resolved[2],
        "resultant": agreement(phases, yaws),
        "resultant_of_ranks": agreement(phases, evenly(yaws)),
        # of even coordinates no more can be had from random yaws
        "resultant_at_most": agreement(evenly(yaws), yaws),
    }
    for name, given in (("words", None), ("words_and_codes", codes)):
        localiser = cogmap.Localiser(words[known], codes=None if given is None else given[known])
        found = localiser.locate(words[asked], codes=None if given is None else given[asked])
        errors = medians(interpolated_poses(found, poses[known]), poses[asked], f"{name}_")
        nearest = medians(poses[known][found.indices[:, 0]], poses[asked], "nearest_")
        figures |= errors | nearest
        figures[f"{name}_over_nearest"] = (
            errors[f"{name}_heading_median_deg"] / nearest["nearest_heading_median_deg"]
        )
    return figures


@cache
def run(seed: int, tilt: float) -> dict[str, Any]:
    """Panoramas of a run: 400 are remembered, 100 between them are placed."""
    rng = np.random.default_rng(seed)
    walk = explore(ROOM, Brownian(), Camera.panoramic(), views=500, seed=seed)
    real = RealCamera(tilt=np.deg2rad(tilt), exposure=0.2, blur=0.8, noise=0.02)
    views, poses = real.photograph(walk.views, rng), walk.require("poses")
    known, asked = np.split(rng.permutation(500), [400])
    found = cogmap.Localiser.for_panoramas(views[known]).locate(views[asked])
    nearest = poses[known][found.indices[:, 0]]
    nearest = np.column_stack([nearest[:, :2], nearest[:, 2] + found.turns[:, 0]])
    errors = medians(turned_poses(found, poses[known]), poses[asked], "")
    figures: dict[str, Any] = errors | medians(nearest, poses[asked], "nearest_")
    figures["position_over_nearest"] = errors["position_median_m"] / figures["nearest_position_median_m"]
    figures["heading_over_nearest"] = errors["heading_median_deg"] / figures["nearest_heading_median_deg"]
    return figures


@pytest.mark.parametrize("seed", SEEDS)
def test_crops_of_a_photograph(seed: int, judge: Callable[..., None]) -> None:
    bars = [
        ("betti", "=", [1, 1, 0]),
        ("pieces_and_loop_resolved", "=", True),
        ("void_resolved", "≥", 0),
        ("resultant_of_ranks", "≥", 0.999),
        ("resultant", "≥", 0.996),
        ("resultant_at_most", "≥", 0),
        ("words_and_codes_over_nearest", "≤", 0.5),
        ("words_over_nearest", "≤", 1.0),
    ]
    said = [(key, "≥", 0) for key in spin(seed) if key.endswith("deg")]
    judge(f"spin seed {seed}", spin(seed), bars + said)


@pytest.mark.parametrize("tilt", [0.0, 2.0])
@pytest.mark.parametrize("seed", SEEDS)
def test_panoramas_of_a_run(seed: int, tilt: float, judge: Callable[..., None]) -> None:
    bars = [
        ("position_over_nearest", "≤", 0.5),
        ("heading_over_nearest", "≤", 1.1),
        ("position_median_m", "≤", 0.05),
        ("heading_median_deg", "≤", 0.5),
        ("nearest_position_median_m", "≥", 0),
        ("nearest_heading_median_deg", "≥", 0),
    ]
    judge(f"run seed {seed} tilt {tilt:g}°", run(seed, tilt), bars)
