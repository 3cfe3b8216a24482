from arena.recordings.judged import judged, lost_as


def test_a_plain_track_is_not_spoken_of() -> None:
    assert judged({}) == judged({"samples": 9, "gaps": 0, "clipped": 0, "trimmed": 0, "missing": 0}) == ""
    assert judged({"at_maximum": [3, 4]}) == ""


def test_all_that_was_judged_is_said() -> None:
    notes = {
        "samples": 900, "blank": 1, "missing": 2, "unlikely": 3, "too_fast": 4, "left_out": 5, "doubtful": 5,
        "gaps": 6, "interpolated": 7, "longest_gap_s": 0.25, "trimmed": 8, "clipped": 9,
        "fitted_scale": 0.01, "y_down": True,
    }  # fmt: skip
    assert judged(notes) == (
        "of 900 samples 15 are lost (1 blank, 2 missing as told, 3 unlikely, 4 too fast, 5 left out by the "
        "fit); 6 gaps bridged by 7 samples, the longest of 0.25 s; 8 trimmed from the ends; 9 clipped to the "
        "room; scaled by 0.01 to fit; y turned upwards"
    )
    assert lost_as(notes).startswith("1 blank, 2 missing")


def test_scales() -> None:
    assert judged({"metres_per_unit": [0.5, 0.5], "doubtful": 2}) == "2 doubtful ones kept; scaled by 0.5 m"
    assert judged({"metres_per_unit": [0.5, 0.25]}) == "scaled by 0.5 and 0.25 m"
