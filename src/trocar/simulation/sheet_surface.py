"""What a sheet looks like: the planes that `sheet_step.sheet_planes` writes, as they are."""

from __future__ import annotations

from typing import Any

import numpy as np

from trocar.model import FloatArray


def sheet_planes_shown(planes: FloatArray) -> dict[str, Any]:
    """Return `heights` u_z [m], (1, ny, nx), `in_plane` u_x and u_y [m], (2, ny, nx), and `cut`, (3, ny, nx).

    Args:
        planes: as `sheet_planes` writes them, shape (6, ny, nx).
    """
    return {
        "heights": planes[:1].astype(np.float32),
        "in_plane": planes[1:3].astype(np.float32),
        "cut": np.rint(255 * planes[3:]).astype(np.uint8),
    }
