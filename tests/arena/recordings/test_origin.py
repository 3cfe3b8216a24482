import llvmlite.binding as llvm
import numpy as np
import pytest

from arena.recordings.origin import origin, unlike


def test_origin_names_versions_and_the_level_of_the_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    assert origin()["numpy"] == np.__version__
    for found, level in [
        ({"sse4.2": True}, "v2"),
        ({"avx2": True, "fma": True}, "v3"),
        ({"avx2": True, "fma": False}, "v2"),
        ({"avx2": True, "fma": True, "avx512bw": True}, "v4"),
    ]:
        monkeypatch.setattr(llvm, "get_host_cpu_features", lambda found=found: found)
        monkeypatch.setattr("platform.machine", lambda: "x86_64")
        assert origin()["processor"] == f"x86-64-{level}"


def test_what_differs_is_said() -> None:
    assert not unlike(origin())
    assert unlike({**origin(), "pymunk": "6.0"}) == f"pymunk 6.0 (here {origin()['pymunk']})"
    assert unlike({}).startswith("numpy unknown (here ")
