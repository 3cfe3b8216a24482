"""What was judged of a track, in one sentence."""

from collections.abc import Mapping

LOST = {
    "blank": "blank",
    "missing": "missing as told",
    "unlikely": "unlikely",
    "too_fast": "too fast",
    "left_out": "left out by the fit",
}
"""Notes that count lost samples, each sample once, and how they are called."""


def lost_as(notes: Mapping[str, object]) -> str:
    """Say how many samples are lost as what: "3 blank, 12 missing as told"; nothing where none is."""
    return ", ".join(f"{notes[kind]} {words}" for kind, words in LOST.items() if notes.get(kind))


def judged(notes: Mapping[str, object]) -> str:
    """Say what the notes of a track, or of the walk that replays it, tell of it; nothing for a plain one.

    >>> judged({"samples": 900, "blank": 2, "missing": 12, "trimmed": 1, "clipped": 4})
    'of 900 samples 14 are lost (2 blank, 12 missing as told); 1 trimmed from the ends; 4 clipped to the room'
    """
    said = []
    lost = sum(int(str(notes.get(kind, 0))) for kind in LOST)
    if lost:
        samples = f"of {notes['samples']} samples " if "samples" in notes else ""
        said.append(f"{samples}{lost} are lost ({lost_as(notes)})")
    if notes.get("gaps"):
        said.append(
            f"{notes['gaps']} gaps bridged by {notes['interpolated']} samples, "
            f"the longest of {notes['longest_gap_s']:.3g} s"
        )
    if notes.get("trimmed"):
        said.append(f"{notes['trimmed']} trimmed from the ends")
    if notes.get("clipped"):
        said.append(f"{notes['clipped']} clipped to the room")
    if notes.get("doubtful") and not notes.get("left_out"):
        said.append(f"{notes['doubtful']} doubtful ones kept")
    if "fitted_scale" in notes:
        said.append(f"scaled by {notes['fitted_scale']:.4g} to fit")
    if "metres_per_unit" in notes:
        along = " and ".join(f"{metres:.4g}" for metres in dict.fromkeys(notes["metres_per_unit"]))  # type: ignore[call-overload]
        said.append(f"scaled by {along} m")
    if notes.get("y_down"):
        said.append("y turned upwards")
    return "; ".join(said)
