"""Diagnosis of a map: four verdicts, each trusted or not and why."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Protocol, runtime_checkable


@runtime_checkable
class Counted(Protocol):
    """Betti numbers with what is not resolved of them, as `cogmap.Betti` has it."""

    @property
    def numbers(self) -> tuple[int, ...]:
        """Pieces, loops, voids."""

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why a number is not resolved, by dimension; empty where it is."""


@dataclass(frozen=True)
class Verdict:
    """Whether one kind of answer can be trusted."""

    reason: str = ""
    """Why not, in a sentence; empty when it can."""

    @property
    def trusted(self) -> bool:
        """Whether nothing speaks against it."""
        return not self.reason


@dataclass(frozen=True)
class Diagnosis:
    """Verdicts on what a map says.

    Attributes
    ----------
    heading
        Whether `Activity.phase` and head-direction cells tell where a view heads.
    place
        Whether `Activity.odour` and place cells tell where it was seen.
    metric_map
        Whether `Activity.position` lays places out.
    topology
        Whether the Betti numbers of the map are those of the room.
    """

    heading: Verdict
    place: Verdict
    metric_map: Verdict
    topology: Verdict

    def __str__(self) -> str:
        verdicts = {field.name.replace("_", " "): getattr(self, field.name) for field in fields(self)}
        return "\n".join(f"{name}: {told.reason or 'trusted'}" for name, told in verdicts.items())


def combined(found: Mapping[int, Diagnosis]) -> Diagnosis:
    """Put the diagnoses of rooms together: by each verdict all of them are trusted, or it says which not."""

    def verdict(kind: str) -> Verdict:
        told = {room: getattr(diagnosis, kind).reason for room, diagnosis in found.items()}
        return Verdict("; ".join(f"room {room}: {reason}" for room, reason in told.items() if reason))

    return Diagnosis(**{field.name: verdict(field.name) for field in fields(Diagnosis)})


def topology_verdict(homology: Mapping[str, Counted], *, turned: bool = True) -> Verdict:
    """Trust the Betti numbers of clouds when all of them are resolved; else say which is not, and why.

    Parameters
    ----------
    homology
        Betti numbers by the names of the clouds.
    turned
        Whether a loop of headings has closed. A camera that turns all round leaves a loop; of too few views
        none is counted, and nothing in the cloud tells: 400 over 4×3 m look like a ball without holes.
    """
    doubts = [
        f"H{dimension} of {name.replace('_', ' ')} is unresolved: {reason}"
        for name, found in homology.items()
        for dimension, reason in enumerate(found.reasons)
        if reason
    ]
    loopless = [name.replace("_", " ") for name, found in homology.items() if found.numbers[1:2] == (0,)]
    if loopless and not turned:
        doubts.append(
            f"no loop is counted in what is {' nor in what is '.join(loopless)}, and none of headings "
            "closes: the camera never turned all round, or these are too few views to show it; show it more"
        )
    return Verdict("; ".join(doubts))
