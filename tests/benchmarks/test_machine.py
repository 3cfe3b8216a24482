import platform
from pathlib import Path

from benchmarks.machine import processor


def test_processor_is_named_as_linux_does_or_by_its_kind(tmp_path: Path) -> None:
    told = tmp_path / "cpuinfo"
    told.write_text("processor\t: 0\nmodel name\t: Abacus 3: wood\n\nmodel name\t: Other\n")
    assert processor(told) == "Abacus 3: wood"
    assert processor(tmp_path / "none") == platform.machine()
