"""Calibration of resolved Betti numbers: how often they are right, and wrong, on clouds of known holes.

`python -m cogmap.evaluation.betti_calibration` prints the count for every kind of cloud.
"""

import sys
from collections.abc import Callable, Iterator
from typing import NamedTuple

import cyclopts
import numpy as np
import pandas as pd
from jaxtyping import Float
from tqdm import tqdm

from cogmap.evaluation.homology_of_map import seen_and_smelt
from cogmap.graph import nearest_points
from cogmap.shape.agreement import unless_aliased
from cogmap.shape.homology import Betti, betti

Points = Float[np.ndarray, "points coordinates"]
Sampler = Callable[[int, np.random.Generator], Points]

FEATURES = 30
NOSE = 0.1


class Cloud(NamedTuple):
    """Views of a space, and what is known of it."""

    space: str
    kind: str
    numbers: tuple[int, int, int]
    views: Points
    smells: Points | None
    """Of a space where two places look alike."""


def circle(points: int, rng: np.random.Generator, radius: float = 1.0) -> Points:
    """Draw from a circle."""
    angle = rng.uniform(-np.pi, np.pi, points)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def sphere(points: int, rng: np.random.Generator) -> Points:
    """Draw from the surface of a ball."""
    X = rng.normal(size=(points, 3))
    return np.asarray(X / np.linalg.norm(X, axis=1, keepdims=True))


def platform(holes: int, *, turning: bool) -> Sampler:
    """Make the sampler of a platform with pillars, turning on the spot or not."""
    middles = {0: (), 1: (0.0,), 2: (-0.95, 0.95)}[holes]

    def sample(points: int, rng: np.random.Generator) -> Points:
        xy = rng.uniform((-1.2 - 0.5 * holes, -1), (1.2 + 0.5 * holes, 1), (2 * points, 2))
        for middle in middles:
            xy = xy[np.hypot(xy[:, 0] - middle, xy[:, 1]) > 0.55]
        xy = xy[:points]
        return np.hstack([xy, circle(len(xy), rng, 0.6)]) if turning else xy

    return sample


def pieces(points: int, rng: np.random.Generator) -> Points:
    """Draw from a circle beside a platform."""
    ring, floor = circle(points // 2, rng), platform(0, turning=False)(points - points // 2, rng)
    return np.vstack([np.insert(ring, 2, 0.0, axis=1), np.insert(floor, 2, 3.0, axis=1)])


SPACES: dict[str, tuple[int, tuple[int, int, int], Sampler]] = {
    "platform": (2, (1, 0, 0), platform(0, turning=False)),
    "one pillar": (2, (1, 1, 0), platform(1, turning=False)),
    "two pillars": (2, (1, 2, 0), platform(2, turning=False)),
    "platform, turning": (3, (1, 1, 0), platform(0, turning=True)),
    "one pillar, turning": (3, (1, 2, 1), platform(1, turning=True)),
    "two pillars, turning": (3, (1, 3, 2), platform(2, turning=True)),
    "line": (1, (1, 0, 0), lambda points, rng: rng.uniform(-1, 1, (points, 1))),
    "circle": (1, (1, 1, 0), circle),
    "torus": (2, (1, 2, 1), lambda points, rng: np.hstack([circle(points, rng), circle(points, rng, 0.8)])),
    "sphere": (2, (1, 0, 1), sphere),
    "ball": (
        3,
        (1, 0, 0),
        lambda points, rng: sphere(points, rng) * rng.uniform(size=(points, 1)) ** (1 / 3),
    ),
    "pieces": (2, (2, 1, 0), pieces),
}
"""Dimension, Betti numbers and sampler of each space; the first six have places."""
KINDS = ("clean", "noisy", "uneven", "strays", "alike")


def draw(seed: int, *, crowd: tuple[int, int] = (1500, 5000)) -> Cloud:
    """Draw a cloud: the spaces take turns, then the kinds.

    A space is seen through smooth random features, and all but clean ones with noise up to the distance
    between neighbours. Uneven ones dwell here and there, strays lie on short cuts between any two of their
    points, and in those that are alike one place looks like another, but smells differently.

    Parameters
    ----------
    seed
        Of everything.
    crowd
        Fewest and most points in two dimensions; in three there are three times as many.
    """
    rng = np.random.default_rng([2026, seed])
    rounds, turn = divmod(seed, len(SPACES))
    name, kind = list(SPACES)[turn], KINDS[rounds % len(KINDS)]
    if kind == "alike" and turn >= 6:
        kind = "noisy"
    dimension, numbers, sampler = SPACES[name]
    points = int(np.exp(rng.uniform(*np.log(crowd)))) * (3 if dimension == 3 else 1)
    X = sampler(3 * points if kind == "uneven" else points, rng)
    if kind == "uneven":
        dwelling = np.exp(0.7 * np.sin(2 * X @ rng.normal(size=X.shape[1]) + rng.uniform(0, 2 * np.pi)))
        X = X[rng.choice(len(X), points, replace=False, p=dwelling / dwelling.sum())]
    look = _features(X.shape[1], rng)
    views, smells = look(X), None
    if kind == "alike":
        here, there = X[rng.choice(len(X), 2, replace=False), :2]
        views, smells = _alike(X, here, there, look), _smell(X, rng)
    if kind != "clean":
        spacing = np.median(nearest_points(views, 1).distances)
        views = views + rng.normal(scale=rng.uniform(0.1, 1) * spacing / np.sqrt(FEATURES), size=views.shape)
    if kind == "strays":
        ends = views[rng.integers(len(views), size=(2, len(views) // 200))]
        share = rng.uniform(size=(len(views) // 200, 1))
        views = np.vstack([views, share * ends[0] + (1 - share) * ends[1]])
    return Cloud(name, kind, numbers, views.astype(np.float32), smells)


def _features(coordinates: int, rng: np.random.Generator) -> Callable[[Points], Points]:
    """Lay a space into many dimensions, and add waves so that it is curved everywhere."""
    axes = np.linalg.qr(rng.normal(size=(FEATURES, coordinates)))[0].T
    waves, phases = rng.normal(size=(coordinates, FEATURES)), rng.uniform(0, 2 * np.pi, FEATURES)
    return lambda X: X @ axes + 0.7 * np.sqrt(coordinates / FEATURES) * np.cos(X @ waves + phases)


def _alike(
    X: Points, here: Float[np.ndarray, "2"], there: Float[np.ndarray, "2"], look: Callable[[Points], Points]
) -> Float[np.ndarray, "points features"]:
    """Let what is seen around one place be what is seen around another, the nearer to it the more."""
    moved = X.copy()
    moved[:, :2] += there - here
    apart = np.hypot(*(X[:, :2] - here).T)[:, None]
    share = np.clip(2 - apart / 0.25, 0, 1)
    return np.asarray(share * look(moved) + (1 - share) * look(X))


def _smell(X: Points, rng: np.random.Generator) -> Float[np.ndarray, "points odorants"]:
    """Log odours of three sources, as a noisy nose smells them."""
    sources = rng.uniform(-1, 1, (3, 2))
    apart = np.linalg.norm(X[:, None, :2] - sources, axis=2)
    return np.asarray(rng.normal(-apart, NOSE))


def judge(cloud: Cloud, *, landmarks: tuple[int, int] = (400, 150)) -> dict[str, Betti]:
    """Count the holes of a cloud, by sight and where it smells also by both senses."""
    found = betti(cloud.views, landmarks=landmarks)
    if cloud.smells is None:
        return {cloud.kind: found}
    joint = betti(seen_and_smelt(cloud.views, cloud.smells), landmarks=landmarks)
    return {"alike, sight": unless_aliased(found, joint), "alike, both senses": joint}


def calibrate(clouds: int = 200, *, first: int = 0) -> Iterator[dict[str, object]]:
    """Give a row per cloud and dimension: whether the number is right, whether resolved, and why not."""
    for seed in range(first, first + clouds):
        cloud = draw(seed)
        for kind, found in judge(cloud).items():
            for dimension, number in enumerate(cloud.numbers):
                yield {
                    "seed": seed,
                    "space": cloud.space,
                    "kind": kind,
                    "dimension": dimension,
                    "right": found.numbers[dimension] == number,
                    "resolved": found.resolved[dimension],
                    "reason": found.reasons[dimension],
                }


def main(clouds: int = 200, first: int = 0) -> None:
    """Print how many numbers of so many clouds are right or wrong and resolved, by dimension and by kind."""
    rows = pd.DataFrame(tqdm(calibrate(clouds, first=first), unit="number"))
    rows["right and resolved"] = rows["right"] & rows["resolved"]
    rows["wrong and resolved"] = ~rows["right"] & rows["resolved"]
    counts = rows.groupby(["dimension", "kind"])[["right", "right and resolved", "wrong and resolved"]]
    table = pd.concat([counts.mean().iloc[:, :2], counts.sum().iloc[:, 2]], axis=1).round(3)
    sys.stdout.write(table.to_string() + "\n")


if __name__ == "__main__":
    cyclopts.run(main)
