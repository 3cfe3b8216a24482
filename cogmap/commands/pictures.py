"""The command about pictures that were taken elsewhere."""

import os
import sys
from typing import Annotated

import cv2
from cyclopts import Parameter

from arena import Recording
from arena.recordings.lens import Kind
from cogmap.commands.common import Json, MaybePath, UserPath, tell


def _import(
    source: UserPath,
    /,
    *,
    out: UserPath,
    kind: Kind | None = None,
    width: int | None = None,
    height: int | None = None,
    ahead: float = 0.0,
    clockwise: bool = True,
    mirror: Annotated[tuple[float, float, float, float] | None, Parameter(negative="")] = None,
    times: MaybePath = None,
    rate: float | None = None,
    poses: MaybePath = None,
    signals: MaybePath = None,
    columns: Annotated[list[str] | None, Parameter(negative="", consume_multiple=True)] = None,
    log: Annotated[bool, Parameter(negative="")] = False,
    as_json: Json = False,
) -> None:
    """Make a recording of a folder of pictures or a video; a killed import goes on when called again.

    Examples: `cogmap import frames/ --out rec.zarr --rate 10`;
    `cogmap import run.mp4 --out rec.zarr --kind equirectangular --width 360 --height 60`;
    `cogmap import frames/ --out rec.zarr --times t.csv --signals wifi.csv --log --poses tracked.csv`;
    `cogmap import omni/ --out rec.zarr --kind mirror --mirror 320 240 60 220 --no-clockwise --width 360`.

    Parameters
    ----------
    source
        Folder of JPEG or PNG pictures, taken in natural order, or a video.
    out
        Folder of the recording.
    kind
        What the pictures show; unless told, they are taken as they are.
    width, height
        Of the views, pixels; unless told, those of the pictures, or 6:1 out of equirectangular ones.
    ahead
        Where straight ahead is: ° to the right of the middle column, or clockwise from the top of a mirror's
        ring.
    clockwise
        Whether what is to the right is on the right; mostly not where a camera looks up into a mirror.
    mirror
        x and y of the ring's centre and the radii of the lowest and the highest row, pixels.
    times
        Table of when the pictures were taken: a column t (s), or only one. All tables are CSV or Parquet.
    rate
        Pictures a second, in place of times.
    poses
        Table of x, y (m), heading (rad) or heading_deg, for scoring only.
    signals
        Table of what knows place and not heading, such as the strength of Wi-Fi stations; a column each.
    columns
        Which columns of it to take; all but times unless told.
    log
        The signals are decibels.
    """
    # Of what cannot be read there is a sentence: OpenCV and its reader of videos need not say it, too.
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    recording = Recording.from_images(
        source,
        out=out,
        kind=kind,
        width=width,
        height=height,
        ahead=ahead,
        clockwise=clockwise,
        mirror=mirror,
        times=times,
        rate=rate,
        poses=poses,
        signals=signals,
        columns=columns,
        log=log,
        progress=sys.stderr.isatty(),
    )
    told = {
        "recording": str(out),
        "views": len(recording),
        "height": recording.views.shape[1],
        "width": recording.views.shape[2],
        "seconds": float(recording.times[-1] - recording.times[0]),
        "odorants": 0 if recording.odours is None else recording.odours.shape[1],
        "poses": recording.poses is not None,
    }
    tell(told, as_json=as_json)
