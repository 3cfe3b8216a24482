"""Poses, the truth about views: as columns of tables, and beside what was read."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from arena.angles import wrap_angle


def pose_columns(poses: Float[np.ndarray, "views 3"], prefix: str = "") -> dict[str, np.ndarray]:
    """Columns of a table, `x_m`, `y_m` and `heading_rad`, their names behind a prefix."""
    return dict(zip((f"{prefix}x_m", f"{prefix}y_m", f"{prefix}heading_rad"), poses.T, strict=True))


def pose_errors(
    read: Float[np.ndarray, "views 3"], truth: Float[np.ndarray, "views 3"], prefix: str = ""
) -> dict[str, np.ndarray]:
    """Columns of a table, `position_error_m` and, the short way round, `heading_error_deg`."""
    return {
        f"{prefix}position_error_m": np.linalg.norm((read - truth)[:, :2], axis=1),
        f"{prefix}heading_error_deg": np.rad2deg(np.abs(wrap_angle((read - truth)[:, 2]))),
    }
