"""NWB export: a recording with its cells in the format in which physiologists share such data."""

import hashlib
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from arena import Recording
from arena.atomic import check_absent
from cogmap.atomic import atomic_write, user_path
from cogmap.cells import poisson_spikes
from cogmap.cells.sessions.samples import sample_durations
from cogmap.errors import CogmapError
from cogmap.inputs import Whole, checked_count
from cogmap.map.cognitive_map import CognitiveMap

RESOLUTION = 1e-6
"""Of spike times, s."""


def export_nwb(recording: Recording, cmap: CognitiveMap, out: str | Path, *, seed: Whole = 0) -> None:
    """Write where the body was, how fast every cell fired and when it spiked, as a new NWB file.

    The cells look at the views. In each view a cell spikes n ~ Poisson(λ T) times, spread evenly over how
    long the view lasts, T, which is until the next, or twice the median of that where this is shorter.

    Parameters
    ----------
    recording
        With poses; the times must increase.
    cmap
        The map whose cells look.
    out
        The file; it must not exist. It takes this name only when it is whole.
    seed
        Of the spikes.

    Raises
    ------
    CogmapError
        When pynwb is missing, the recording does not suit map or format, something is at the path already, or
        it cannot be written.

    References
    ----------
    Rübel et al. (2022), The Neurodata Without Borders ecosystem for neurophysiological data science.
    """
    try:
        import pynwb  # noqa: PLC0415
    except ImportError:
        raise CogmapError(
            "writing NWB needs pynwb, which is not installed; run `pip install 'cogmap[nwb]'`"
        ) from None
    out = user_path(out)
    check_absent(out, CogmapError)
    if recording.poses is None:
        raise CogmapError("the recording has no poses to export; use one that kept them")
    if len(recording.times) < 2 or not (np.diff(recording.times) > 0).all():
        raise CogmapError(
            "the times of the recording do not increase; give two views or more, in their order"
        )
    lasting = sample_durations(recording.times)
    rng = np.random.default_rng(checked_count("seed", seed, 0))
    activity = cmap.perceive(recording.views)
    rates = {name: getattr(activity, name).astype(float) for name in ("place", "heading")}
    spikes = {name: _spike_times(cells, recording.times, lasting, rng) for name, cells in rates.items()}
    file = _lay_out(recording, rates, spikes)
    with atomic_write(out) as fresh, pynwb.NWBHDF5IO(fresh, "w") as disk:
        disk.write(file)


def _spike_times(
    rates: Float[np.ndarray, "views cells"],
    times: Float[np.ndarray, " views"],
    lasting: Float[np.ndarray, " views"],
    rng: np.random.Generator,
) -> list[Float[np.ndarray, " spikes"]]:
    """Draw the times of each cell's spikes, s."""
    counts = poisson_spikes(rates * lasting[:, None], rng, peak=None, seconds=1.0)
    ends = np.minimum(np.append(times[1:], np.inf), times + lasting)
    digits, trains = -round(np.log10(RESOLUTION)), []
    for count in counts.T:
        start, end = np.repeat(times, count), np.repeat(ends, count)
        when = (start + np.repeat(lasting, count) * rng.random(count.sum())).round(digits)
        # What rounding carries into the view before or after is counted there by whoever reads it.
        when += RESOLUTION * (when < start) - RESOLUTION * (when >= end)
        trains.append(np.sort(when.round(digits)))
    return trains


def _lay_out(
    recording: Recording,
    rates: dict[str, Float[np.ndarray, "views _"]],
    spikes: dict[str, list[Float[np.ndarray, "_"]]],
) -> Any:
    """Put everything where the format wants it."""
    import pynwb  # noqa: PLC0415

    poses = np.asarray(recording.poses)
    file = pynwb.NWBFile(
        session_description="Simulated: a body explores a room and its cells look. The date is nominal.",
        identifier=hashlib.sha256(b"".join(part.tobytes() for part in (poses, *rates.values()))).hexdigest(),
        # The format asks for a date, and a simulation has none.
        session_start_time=datetime(2000, 1, 1, tzinfo=UTC),
        experiment_description="Place cells and head-direction cells that emerged from sight and smell.",
        keywords=["place cells", "head-direction cells", "simulation"],
        experimenter="cogmap, simulation",
        institution="none, this is a simulation",
        subject=pynwb.file.Subject(
            subject_id="explorer",
            description="A simulated body, no animal: the species is that of the unidentified.",
            species="http://purl.obolibrary.org/obo/NCBITaxon_32644",
            sex="U",
            age="P0D/",
        ),
    )
    behavior = file.create_processing_module("behavior", "Where the body truly was.")
    position = pynwb.behavior.SpatialSeries(
        name="position",
        description="x and y of the body.",
        data=poses[:, :2],
        timestamps=recording.times,
        unit="meters",
        reference_frame="origin in the middle of the room, x to the right, y up",
    )
    heading = pynwb.behavior.SpatialSeries(
        name="heading",
        description="Where the body faced.",
        data=poses[:, 2],
        timestamps=position,
        unit="radians",
        reference_frame="0 along x, counter-clockwise",
    )
    behavior.add(pynwb.behavior.Position(spatial_series=position))
    behavior.add(pynwb.behavior.CompassDirection(spatial_series=heading))
    cells = file.create_processing_module("misc", "How fast the cells of the map fired, view by view.")
    file.add_unit_column("cell_type", "Population of the cell: place or heading.")
    for kind, fired in rates.items():
        cells.add(
            pynwb.TimeSeries(
                name=f"{kind}_rates",
                description=f"Rates of the {kind} cells, a column for each in the order of its units.",
                data=fired.astype(np.float32),
                timestamps=position,
                unit="hertz",
            )
        )
        for train in spikes[kind]:
            file.add_unit(spike_times=train, cell_type=kind)
    file.units.resolution = RESOLUTION
    return file
