import json
import re
from pathlib import Path

import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.pages.live import freezing
from cogmap.pages.live.freezing import HEADINGS, freeze, sampled_poses
from cogmap.pages.live.world import World


def test_a_frozen_page_is_one_file_that_asks_for_nothing(world: World, tmp_path: Path) -> None:
    out = freeze(world, tmp_path / "page.html", poses=16)
    text = out.read_text(encoding="utf-8")
    assert not re.search(r"https?://|@import|\bsrc=\"(?!data:)|url\(", text.split("thaw(document")[0])
    assert "default-src 'none'" in text
    told = re.search(r"thaw\(document\.getElementById\(\"page\"\), (.*)\);\n</script>", text)
    assert told is not None
    frozen = json.loads(told[1].replace("<\\/", "</"))
    assert len(frozen["frames"]) == 16
    assert "http" not in told[1]
    poses = np.array([frame["pose"] for frame in frozen["frames"]])
    np.testing.assert_allclose(poses, sampled_poses(world, 2), atol=1e-3)
    for frame in frozen["frames"]:
        assert frame["seen"].startswith("data:image/jpeg;base64,")
        assert all(0 <= near["view"] < len(frozen["held"]) for near in frame["near"])


def test_sampled_places_are_free_and_far_apart(world: World) -> None:
    poses = sampled_poses(world, 9)
    assert world.body.is_free(world.room, poses).all()
    places = poses[::HEADINGS, :2]
    apart = np.linalg.norm(places[:, None] - places, axis=2)[np.triu_indices(9, 1)]
    assert apart.min() > 0.5
    assert len(np.unique(np.round(poses[:, 2], 6))) == HEADINGS


def test_other_files_few_poses_and_large_pages_are_refused(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(CogmapError, match=r"let it end in \.html"):
        freeze(world, tmp_path / "page.pdf")
    with pytest.raises(CogmapError, match="at least 8"):
        freeze(world, tmp_path / "page.html", poses=7)
    monkeypatch.setattr(freezing, "LARGEST", 1000)
    with pytest.raises(CogmapError, match="give fewer than 8 poses"):
        freeze(world, tmp_path / "page.html", poses=8)
    assert list(tmp_path.iterdir()) == []
