import numpy as np
import pytest

from cogmap.experiments.acting import imagination
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.registry import run_experiment


def test_dreams_are_measured_beside_what_is_seen(dreamer: Dreamer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imagination, "TARGETS", 20)
    monkeypatch.setattr(imagination, "WAYS", 1)
    result = run_experiment("imagination", views=200, room=dreamer.trial.conditions.room)
    figures, table = result.metrics, result.tables["dreams"]
    medians = table.groupby("method")["psnr_db"].median()
    assert table["method"].value_counts().eq(20).all()
    assert set(imagination.METHODS) | {"mean view", "nearest by true pose", "warp, from outside"} == set(
        medians.index
    )
    assert figures["psnr_median_db"] == medians["warp"] > medians["turned"] > medians["mean view"]
    assert figures["decoder_psnr_db"] == medians["decoder"] > medians["mean view"] + 2
    assert figures["psnr_p05_db"] < figures["psnr_median_db"]
    assert 0.9 < figures["ssim_mean"] <= 1
    assert figures["dream_position_median_m"] < figures["outside_position_median_m"] < 0.1
    assert figures["dream_heading_median_deg"] < figures["outside_heading_median_deg"] < 3
    assert figures["relaxed_position_median_m"] < 0.1
    assert figures["replay_r2"] > 0.5
    assert np.isfinite([figures["blend_ms"], figures["warp_ms"]]).all()
    assert result.figures.keys() == result.captions.keys() == {"dreams", "errors", "film"}
