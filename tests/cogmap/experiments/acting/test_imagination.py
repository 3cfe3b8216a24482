import numpy as np
import pytest

from arena import Arena
from cogmap.experiments.acting import imagination
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.registry import run_experiment


def test_dreams_are_measured_beside_what_is_seen(
    dreamer: Dreamer, room: Arena, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(imagination, "TARGETS", 30)
    monkeypatch.setattr(imagination, "WAYS", 1)
    # few frames: four times as far from one to the next
    monkeypatch.setitem(dreamer.imagination.__dict__, "pace", 4 * dreamer.imagination.pace)
    result = run_experiment("imagination", views=200, room=room)
    figures, table = result.metrics, result.tables["dreams"]
    medians = table.groupby("method")["psnr_db"].median()
    peers = {"mean view", "nearest by true pose", "warp, from outside"}
    assert set(medians.index) == {*imagination.METHODS, *peers}
    assert table["method"].value_counts().eq(30).all()
    assert figures["psnr_median_db"] == medians["warp"] > medians["turned"] > medians["mean view"]
    assert figures["decoder_psnr_db"] == medians["decoder"] > medians["mean view"] + 2
    assert figures["psnr_p05_db"] < figures["psnr_median_db"]
    assert 0.9 < figures["ssim_mean"] <= 1
    assert figures["dream_position_median_m"] < figures["outside_position_median_m"] < 0.1
    assert figures["dream_heading_median_deg"] < figures["outside_heading_median_deg"] < 3
    assert figures["relaxed_position_median_m"] < 0.1
    assert figures["replay_r2"] < 1
    assert result.figures.keys() == result.captions.keys() == {"dreams", "errors", "film"}


def test_the_place_cells_of_a_dream_tell_where_it_led(dreamer: Dreamer) -> None:
    position = dreamer.trial.train.position
    across = np.quantile(position, [0.2, 0.8], axis=0).astype(float)
    way = dreamer.imagination.along(across, step=float(np.linalg.norm(across[1] - across[0])) / 10)
    assert len(way) == 11
    assert imagination.replay_r2(dreamer, [way]) > 0.8
