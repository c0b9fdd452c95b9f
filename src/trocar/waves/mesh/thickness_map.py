"""A thickness that varies over a block, from a file: a table of numbers, an array, or a grey picture.

As seen from above: rows go from the largest y to y = 0, columns from x = 0 to the largest x, and the outermost values
lie on the block's edges; between them it is bilinear.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError
from scipy.interpolate import RegularGridInterpolator

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.units import MILLIMETRE

_MOST = 4096  # rows and columns
_NEEDS_RANGE = "say what black and white mean: pass black_mm and white_mm"


def thickness_map(
    path: Path | str,
    size: tuple[float, float],
    *,
    black_mm: float | None = None,
    white_mm: float | None = None,
) -> Callable[[FloatArray, FloatArray], FloatArray]:
    """Return a thickness [m] as a function of x and y [m], from a file.

    Args:
        path: a .csv or .npy file of thicknesses in mm, or a .png picture.
        size: sides of the block [m].
        black_mm: of a picture: the thickness that black means [mm].
        white_mm: and white [mm].

    Raises:
        InputError: the file cannot be read, or is no table of finite numbers.
    """
    path = Path(path)
    kind = path.suffix.lower()
    try:
        if kind == ".csv":
            rows = path.read_text(encoding="utf-8").splitlines() or [""]
            table = np.array([[float(value) for value in row.split(",")] for row in rows if row.strip()])
        elif kind == ".npy":
            table = np.load(path, allow_pickle=False)
        elif kind == ".png":
            if black_mm is None or white_mm is None:
                raise InputError(str(path), "a range of thicknesses for a picture", "none", _NEEDS_RANGE)
            with Image.open(path) as picture:
                grey = np.asarray(
                    picture.convert("F" if picture.mode.startswith("I") else "L"), dtype=np.float64
                )
                full = 65535.0 if picture.mode.startswith("I") else 255.0
            table = black_mm + grey / full * (white_mm - black_mm)
        else:
            raise InputError(str(path), "a .csv, .npy or .png file", path.suffix or "no ending")
    except (OSError, ValueError, UnidentifiedImageError) as error:
        reason = (
            error.strerror if isinstance(error, OSError) and error.strerror else str(error).splitlines()[0]
        )
        raise InputError(
            str(path), f"a whole {kind} file of numbers, as many in each row", reason or type(error).__name__
        ) from None
    if not (
        table.ndim == 2
        and min(table.shape) >= 2
        and max(table.shape) <= _MOST
        and table.dtype.kind in "fiu"
        and np.isfinite(table).all()
    ):
        raise InputError(
            str(path), f"2 to {_MOST} rows and columns of finite numbers", f"{table.shape} of {table.dtype}"
        )
    x, y = (np.linspace(0.0, side, count) for side, count in zip(size, table.shape[::-1], strict=True))
    values = MILLIMETRE * np.asarray(table, dtype=np.float64)[::-1].T
    between = RegularGridInterpolator((x, y), values)

    def thickness(at_x: FloatArray, at_y: FloatArray) -> FloatArray:
        at = np.clip(np.stack([at_x, at_y], axis=-1), 0.0, size)
        return np.asarray(between(at), dtype=np.float64)

    return thickness
