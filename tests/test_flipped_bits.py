"""What has suffered on disk is refused, or nothing that is read of it has changed."""

import pytest

from tests.flipped import Judge, write_all


@pytest.fixture(scope="module")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Judge:
    return Judge(write_all(tmp_path_factory.mktemp("written"), views=90))


def test_two_hundred_flipped_bits(judge: Judge, capfd: pytest.CaptureFixture[str]) -> None:
    found = judge.flip(200, seed=0, check_every=8)
    assert found.total() == 200
    # what is never read is in what describes the folder of signals
    assert sum(count for (_, verdict), count in found.items() if verdict == "harmless") <= 20
    assert capfd.readouterr() == ("", "")


def test_files_that_are_lost_cut_or_strange(judge: Judge) -> None:
    for kind, file in judge.files:
        sound = file.read_bytes()
        for damaged in (None, sound[: len(sound) // 2], sound[:-1], sound + b"\0"):
            if damaged is None:
                file.unlink()
            else:
                file.write_bytes(damaged)
            never_read = file.parent.name == "signals"
            only_space = damaged is not None and file.suffix == ".json" and damaged.strip() == sound.strip()
            assert judge.verdict(kind) == ("harmless" if never_read or only_space else "refused"), file
            file.write_bytes(sound)
        beside = file.with_name(f"{file.name}.copy")
        beside.write_bytes(sound)
        assert judge.verdict(kind) == "harmless"
        beside.unlink()


def test_files_that_have_changed_places(judge: Judge) -> None:
    of_one = [(kind, one, file) for kind, one in judge.files for other, file in judge.files if other == kind]
    swapped = 0
    for kind, one, file in of_one:
        never_read = "signals" in {one.parent.name, file.parent.name}
        if one < file and one.name == file.name and not never_read:
            contents = one.read_bytes(), file.read_bytes()
            one.write_bytes(contents[1])
            file.write_bytes(contents[0])
            assert judge.verdict(kind) == "refused", (one, file)
            one.write_bytes(contents[0])
            file.write_bytes(contents[1])
            swapped += 1
    assert swapped > 5
