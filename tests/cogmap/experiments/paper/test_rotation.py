import numpy as np
import pytest

from cogmap.experiments.paper.rotation import correlation, predict_headings

RNG = np.random.default_rng(0)
HEADINGS = RNG.uniform(-np.pi, np.pi, 2000)
RING = np.column_stack([np.cos(HEADINGS), np.sin(HEADINGS), 0.3 * np.cos(2 * HEADINGS)])


def test_a_network_reads_headings_off_a_ring() -> None:
    fit = predict_headings(RING, HEADINGS, 0)
    assert fit["split"].value_counts().to_dict() == {"training": 1350, "validation": 270, "test": 180}
    assert fit["view"].is_unique
    np.testing.assert_array_equal(fit["heading_rad"], HEADINGS[fit["view"]])
    test = fit[fit["split"] == "test"]
    assert correlation(test) > 0.9999
    assert test["error_rad"].abs().median() < np.deg2rad(0.5)
    assert correlation(test) == pytest.approx(
        np.corrcoef(test["heading_rad"], test["heading_rad"] + test["error_rad"])[0, 1]
    )


def test_it_finds_nothing_where_there_is_nothing() -> None:
    fit = predict_headings(RNG.normal(size=(600, 3)), HEADINGS[:600], 0)
    test = fit[fit["split"] == "test"]
    assert abs(correlation(test)) < 0.95
    assert test["error_rad"].abs().median() > 1


def test_the_same_seed_trains_the_same_network() -> None:
    one, same = (predict_headings(RING[:300], HEADINGS[:300], 4) for _ in range(2))
    assert one.equals(same)
