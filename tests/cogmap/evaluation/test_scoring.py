from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.evaluation.ground_truth import GroundTruth
from cogmap.evaluation.scoring import score
from cogmap.map.activity import Activity

SOURCES = np.array([[-1.5, -1.0], [1.6, 0.9], [1.2, -1.1]])
HALF = np.array([1.8, 1.3])
BLUR = 0.05
"""Standard deviation of the metric map along each axis, m."""


def walk(views: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(-HALF, HALF, (views, 2)), rng.uniform(-np.pi, np.pi, views)])


def ideal(poses: np.ndarray, error: float = 0.03, seed: int = 0) -> Activity:
    """Cells that know place and heading, the heading with a von Mises error of about `error` rad."""
    rng = np.random.default_rng(seed)
    centres = np.stack(np.meshgrid(np.linspace(-1.7, 1.7, 12), np.linspace(-1.2, 1.2, 9)), -1).reshape(-1, 2)
    preferred = np.linspace(-np.pi, np.pi, 60, endpoint=False)
    phase = np.angle(np.exp(1j * (poses[:, 2] + rng.vonmises(0, 1 / error**2, len(poses)))))
    away = poses[:, None, :2] - centres
    return Activity(
        place=(10 * np.exp(-np.sum(away**2, axis=2) / (2 * 0.25**2))).astype(np.float32),
        heading=(10 * np.exp(5 * (np.cos(phase[:, None] - preferred) - 1))).astype(np.float32),
        phase=phase.astype(np.float32),
        odour=-np.linalg.norm(poses[:, None, :2] - SOURCES, axis=2).astype(np.float32),
        position=(poses[:, :2] + rng.normal(0, BLUR, (len(poses), 2))).astype(np.float32),
    )


@pytest.fixture(scope="module")
def train() -> tuple[Activity, np.ndarray]:
    poses = walk(8000, 0)
    return ideal(poses), poses


@pytest.fixture(scope="module")
def poses() -> np.ndarray:
    return walk(5000, 1000)


def test_ideal_population_scores_high(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    record = score(ideal(poses, seed=1), poses, train=train)
    assert set(record) == {
        "position_median_m", "position_p95_m", "heading_median_deg", "heading_p95_deg", "heading_resultant",
        "place_cells_passing", "place_coverage", "heading_cells_passing", "metric_map_r2",
        "metric_map_median_m",
    }  # fmt: skip
    assert all(type(value) is float for value in record.values())
    assert record["position_median_m"] < record["position_p95_m"] < 0.06
    # The quantiles of |N(0, 0.03 rad)|.
    assert record["heading_median_deg"] == pytest.approx(np.rad2deg(0.6745 * 0.03), rel=0.05)
    assert record["heading_p95_deg"] == pytest.approx(np.rad2deg(1.96 * 0.03), rel=0.05)
    assert record["heading_resultant"] == pytest.approx(np.exp(-(0.03**2) / 2), abs=1e-4)
    assert record["place_cells_passing"] == 1
    assert record["place_coverage"] > 0.99
    assert record["heading_cells_passing"] == 1
    # A Rayleigh variable, and the variance of a uniform one.
    assert record["metric_map_median_m"] == pytest.approx(BLUR * np.sqrt(2 * np.log(2)), rel=0.05)
    assert record["metric_map_r2"] == pytest.approx(1 - 2 * BLUR**2 / np.sum(HALF**2 / 3), abs=1e-4)


@pytest.mark.parametrize("mirror", [False, True])
def test_a_metric_map_counts_after_one_similarity_of_the_training_views(
    train: tuple[Activity, np.ndarray],
    poses: np.ndarray,
    mirror: bool,  # noqa: FBT001
) -> None:
    def moved(activity: Activity, shift: float = 5.0) -> Activity:
        z = activity.position @ np.array([1, 1j])
        z = (2 + 1j) * (z.conj() if mirror else z) + shift
        return replace(activity, position=np.stack([z.real, z.imag], axis=1).astype(np.float32))

    activity = ideal(poses, seed=1)
    known = moved(train[0]), train[1]
    expected = score(activity, poses, train=train)
    assert score(moved(activity), poses, train=known) == pytest.approx(expected, abs=1e-5)
    beside = score(moved(activity, 5.0 + np.sqrt(5)), poses, train=known)  # 1 m away
    assert beside["metric_map_median_m"] == pytest.approx(1, abs=0.01)
    assert beside["metric_map_r2"] < expected["metric_map_r2"] - 0.5


def test_without_a_metric_map_its_figures_are_left_out(
    train: tuple[Activity, np.ndarray], poses: np.ndarray
) -> None:
    activity = ideal(poses)
    none = replace(activity, position=np.full_like(activity.position, np.nan))
    record = score(none, poses, train=train)
    assert not {name for name in record if name.startswith("metric_map")}
    assert record["position_median_m"] > 0


def test_shuffled_population_fails(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    shuffled = ideal(poses[np.random.default_rng(0).permutation(len(poses))])
    record = score(shuffled, poses, train=train)
    assert record["position_median_m"] > 1
    assert record["heading_median_deg"] == pytest.approx(90, abs=5)
    assert record["heading_resultant"] < 0.05
    assert record["place_cells_passing"] == record["place_coverage"] == record["heading_cells_passing"] == 0


@pytest.mark.parametrize("sign", [1, -1])
def test_rotation_and_mirror_of_the_phase_do_not_matter(
    train: tuple[Activity, np.ndarray], poses: np.ndarray, sign: int
) -> None:
    def turned(activity: Activity) -> Activity:
        return replace(activity, phase=np.angle(np.exp(1j * (sign * activity.phase + 2.0))))

    activity = ideal(poses, seed=1)
    expected = score(activity, poses, train=train)
    assert score(turned(activity), poses, train=(turned(train[0]), train[1])) == pytest.approx(
        expected, abs=1e-4
    )


def test_frame_comes_from_the_training_views(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    activity = ideal(poses, seed=1)
    off = replace(activity, phase=np.angle(np.exp(1j * (activity.phase + np.float32(0.5)))))
    record = score(off, poses, train=train)
    assert record["heading_median_deg"] == pytest.approx(np.rad2deg(0.5), abs=0.2)
    assert record["heading_resultant"] > 0.999
    mirrored = score(replace(activity, phase=-activity.phase), poses, train=train)
    assert mirrored["heading_resultant"] < 0.05


def test_silent_cells_count_against(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    activity = ideal(poses, seed=1)
    silenced = replace(
        activity,
        place=activity.place * (np.arange(108) % 2 == 0),
        heading=activity.heading * (np.arange(60) % 4 == 0),
    )
    record = score(silenced, poses, train=train)
    assert record["place_cells_passing"] == 0.5
    assert record["heading_cells_passing"] == 0.25


def test_coverage_is_of_the_reachable_area(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    activity = ideal(poses, seed=1)
    along = np.stack(np.meshgrid(np.arange(-1.79, 5.4, 0.02), np.arange(-1.29, 1.3, 0.02)), -1).reshape(-1, 2)
    assert score(activity, poses, train=train, reachable=along)["place_coverage"] == pytest.approx(
        0.5, abs=0.01
    )
    left = along[along[:, 0] < 0]
    assert score(activity, poses, train=train, reachable=left)["place_coverage"] > 0.99
    # The training views, not the scored ones alone, say what is reachable.
    half = poses[:, 0] < 0
    seen = score(ideal(poses[half]), poses[half], train=train)["place_coverage"]
    assert 0.45 < seen < 0.7


def test_bad_input_is_refused(train: tuple[Activity, np.ndarray], poses: np.ndarray) -> None:
    activity = ideal(poses)
    with pytest.raises(CogmapError, match="poses has shape"):
        score(activity, poses[:10], train=train)
    with pytest.raises(CogmapError, match="training poses has shape"):
        score(activity, poses, train=(train[0], train[1][:10]))
    with pytest.raises(CogmapError, match="poses is not finite"):
        score(activity, poses * np.nan, train=train)
    with pytest.raises(CogmapError, match="phase is not finite"):
        score(replace(activity, phase=np.where(poses[:, 0] < 0, np.nan, activity.phase)), poses, train=train)


def test_without_a_compass_what_applies_is_left(
    train: tuple[Activity, np.ndarray], poses: np.ndarray
) -> None:
    activity = ideal(poses)
    blind = replace(
        activity, phase=np.full(len(poses), np.nan), heading=activity.heading * np.float32(np.nan)
    )
    seeing = score(activity, poses, train=train)
    applies = {key: value for key, value in seeing.items() if not key.startswith("heading")}
    assert score(blind, poses, train=train) == {**applies, "heading_cells_passing": 0.0}


def test_cells_that_have_been_measured_are_not_measured_again(
    train: tuple[Activity, np.ndarray], poses: np.ndarray
) -> None:
    activity = ideal(poses, seed=1)
    truth = GroundTruth(train[1], poses, poses[:, :2])
    cells = truth.measure(activity.place), truth.measure(activity.heading)
    assert score(activity, poses, train=train, cells=cells) == score(activity, poses, train=train)
    none = truth.measure(0 * activity.place), truth.measure(0 * activity.heading)
    record = score(activity, poses, train=train, cells=none)
    assert record["place_cells_passing"] == record["place_coverage"] == record["heading_cells_passing"] == 0


def test_a_refined_map_is_scored_beside_its_charts(
    train: tuple[Activity, np.ndarray], poses: np.ndarray
) -> None:
    (plain_train, poses_train), plain = train, ideal(poses, seed=1)
    exact = {"phase": poses[:, 2], "position": poses[:, :2]}
    exact_train = {"phase": poses_train[:, 2], "position": poses_train[:, :2]}
    refined = replace(plain, **exact, plain=plain)
    record = score(
        refined, poses, train=(replace(plain_train, **exact_train, plain=plain_train), poses_train)
    )
    alone = score(plain, poses, train=train)
    for name in ("heading_median_deg", "heading_p95_deg", "metric_map_r2", "metric_map_median_m"):
        assert record[f"plain_{name}"] == alone[name]
    assert record["heading_median_deg"] < 1e-6
    assert record["metric_map_median_m"] < 1e-6


def test_poses_may_be_lists_and_frames(train: tuple[Activity, np.ndarray]) -> None:
    poses = walk(500, 3)
    activity = ideal(poses)
    known, there = train
    frame = pd.DataFrame(there, columns=["x", "y", "heading"])
    assert score(activity, poses.tolist(), train=(known, frame)) == score(activity, poses, train=train)
    with pytest.raises(CogmapError, match=r"headings go from .* look like degrees"):
        score(activity, poses * [1, 1, 180 / np.pi], train=train)
