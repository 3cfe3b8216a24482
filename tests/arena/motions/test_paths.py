from pathlib import Path

import numpy as np
import pytest

from arena.errors import ArenaError
from arena.motions.paths import read_joints


def write(folder: Path, text: str, name: str = "path.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("0,1,2\n1,,3\n", "row 3 has joint_1 = nan"),
        ("0,1,2\n0,1,3\n", "do not increase at row 3"),
        ("0,1\n", "row 2 has 2 cells, not 3"),
    ],
)
def test_joints_are_whole_and_in_order(tmp_path: Path, rows: str, said: str) -> None:
    head = "t,joint_1,joint_2\n"
    times, joints = read_joints(write(tmp_path, head + "0,1,2\n1,-1,3\n"), ["joint_1", "joint_2"])
    assert (times.tolist(), joints.tolist()) == ([0, 1], [[1, 2], [-1, 3]])
    with pytest.raises(ArenaError, match=said):
        read_joints(write(tmp_path, head + rows), ["joint_1", "joint_2"])


def test_joints_of_every_kind_of_file(tmp_path: Path) -> None:
    np.savez(tmp_path / "arm.npz", t=np.arange(2), joint_1=np.arange(2) + 0.5)
    for path in (tmp_path / "arm.npz", write(tmp_path, "t;joint_1\n0;0,5\n1;1,5\n", "arm.TXT")):
        times, joints = read_joints(path, ["joint_1"])
        assert (times.tolist(), joints.tolist()) == ([0, 1], [[0.5], [1.5]])
        with pytest.raises(ArenaError, match="no column joint_2; it must have t, joint_1, joint_2"):
            read_joints(path, ["joint_1", "joint_2"])
