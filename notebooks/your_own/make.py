"""Make the frames and tables of notebook 11 again: `python notebooks/your_own/make.py FOLDER`.

All of it is rendered and drawn by this laboratory: no robot was driven and no animal kept.
"""

import sys
from pathlib import Path

import cv2
import numpy as np
import pandas as pd

from arena import Arena, Brownian, Camera, Disc, explore
from arena.angles import wrap_angle
from cogmap.experiments.own_data.real_camera import RealCamera

HERE = Path(__file__).parent
SEED = 0

FRAMES = 500
STATIONS = {
    "kitchen": (-2.8, -2.2),
    "hall": (2.7, -1.9),
    "office": (2.4, 2.3),
    "stairs": (-2.2, 2.4),
}
"""Where they stand, m."""

SAMPLES, HZ = 12_000, 20
METRES_PER_PIXEL = 0.0025
LOST = -1.0
"""What the tracker writes for all that it does not know."""


def make(folder: Path) -> None:
    """Write both data sets into a folder."""
    rng = np.random.default_rng(SEED)
    make_robot(folder / "robot", rng)
    make_rat(folder / "rat", rng)


def make_robot(folder: Path, rng: np.random.Generator) -> None:
    """Write frames of a camera that looks all around, the strength of four stations, and the truth."""
    walk = explore(Arena.load("furnished"), Brownian(), Camera.panoramic(180, 30), views=FRAMES, seed=SEED)
    camera = RealCamera(tilt=np.deg2rad(2), exposure=0.2, blur=0.6, noise=0.02)
    frames = folder / "frames"
    frames.mkdir(parents=True, exist_ok=True)
    for number, frame in enumerate(camera.photograph(walk.views, rng)):
        cv2.imwrite(f"{frames}/{number:04}.jpg", frame[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, 85])
    poses = walk.require("poses")
    away = np.linalg.norm(poses[:, None, :2] - np.array([*STATIONS.values()]), axis=2)
    decibels = -40 - 25 * np.log10(away) + rng.normal(0, 2, away.shape)
    write(folder / "signals.csv", {"t": walk.times, **dict(zip(STATIONS, decibels.T, strict=True))}, 2)
    x, y, heading = poses.T
    write(folder / "poses.csv", {"t": walk.times, "x": x, "y": y, "heading_deg": np.rad2deg(heading)}, 3)


def make_rat(folder: Path, rng: np.random.Generator) -> None:
    """Write ten minutes of a track as a camera above the box has it, and spikes of ideal Poisson cells."""
    folder.mkdir(parents=True, exist_ok=True)
    walk = Brownian(
        speed=0.2, speed_spread=0.05, run_length=0.5, shyness=0.2, view_every_m=0.01, view_every_rad=0.05
    )
    box = Arena.load(HERE / "rat" / "box.toml")
    went = walk.walk(box, Disc(radius=0.04), SAMPLES, rng)
    times = np.arange(SAMPLES) / HZ
    x, y, turned = (
        np.interp(times, went.times, along) for along in (*went.poses[:, :2].T, np.unwrap(went.poses[:, 2]))
    )
    write_spikes(folder / "spikes.csv", times, np.stack([x, y], axis=1), turned, rng)
    # Down and clockwise, as images have it; a light on the head is found within a pixel or so.
    jitter = rng.normal(0, 0.8, (2, SAMPLES))
    clockwise = np.rad2deg(-turned) + rng.normal(0, 3, SAMPLES)
    track = np.stack([x / METRES_PER_PIXEL, -y / METRES_PER_PIXEL, clockwise % 360])
    track[:2] += jitter
    # For a moment the light seems to be its image in a wall.
    for start in rng.integers(SAMPLES - 5, size=6):
        track[:2, start : start + 3] = np.array([[612.0], [31.0]]) + rng.normal(0, 0.8, (2, 3))
    for start in rng.integers(SAMPLES - 20, size=25):
        track[:, start : start + rng.integers(2, 20)] = LOST
    named = dict(zip(("x", "y", "head_deg"), track, strict=True))
    write(folder / "track.csv", {"frame": np.arange(SAMPLES), **named}, 1)


def write_spikes(
    path: Path, times: np.ndarray, positions: np.ndarray, headings: np.ndarray, rng: np.random.Generator
) -> None:
    """Draw the spikes of 16 place cells, 6 head-direction cells, and 2 that know neither."""
    along, up = np.meshgrid(0.425 + 0.25 * np.arange(4), -0.975 + 0.25 * np.arange(4))
    fields = np.stack([along.ravel(), up.ravel()], axis=1) + rng.uniform(-0.05, 0.05, (16, 2))
    square = ((positions[:, None] - fields) ** 2).sum(axis=2)
    directions = np.deg2rad(60) * np.arange(6)
    rates = {
        f"p{cell + 1:02}": 0.1 + 15 * np.exp(-apart / (2 * 0.1**2)) for cell, apart in enumerate(square.T)
    }
    rates |= {
        f"h{cell + 1}": 0.1 + 10 * np.exp(4 * (np.cos(wrap_angle(headings - direction)) - 1))
        for cell, direction in enumerate(directions)
    }
    rates |= {"u1": np.full(len(times), 1.0), "u2": np.full(len(times), 2.0)}
    spikes = []
    for cell, rate in rates.items():
        count = rng.poisson(rate / HZ)
        when = np.repeat(times, count) + rng.uniform(0, 1 / HZ, count.sum())
        spikes.append(pd.DataFrame({"cell": cell, "t": np.sort(when).round(3)}))
    table = pd.concat(spikes).sort_values("t", kind="stable")
    table.to_csv(path, index=False, lineterminator="\n")


def write(path: Path, columns: dict[str, np.ndarray], digits: int) -> None:
    """Write a table with so many digits behind the point."""
    pd.DataFrame(columns).round(digits).to_csv(path, index=False, lineterminator="\n")


if __name__ == "__main__":
    make(Path(sys.argv[1]))
