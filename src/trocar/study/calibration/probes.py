"""Where a measurement looks at the block: the distinct places and components behind its rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from trocar.model import FloatArray
from trocar.study.calibration.measurement import Measurement
from trocar.tissues.tissue import Tissue


@dataclass(frozen=True, kw_only=True)
class Probes:
    """What is read, and by which row.

    Attributes:
        points: rest positions [m], shape (q, 3).
        faces: place of the layer in the tissue, shape (q,).
        axes: component of the displacement, shape (q,).
        signs: -1 where a depth is read, else 1, shape (q,).
        which: probe of each row, all series one after another, shape (n,).
        time: of each row [s], shape (n,).
        parts: the rows of each series.
    """

    points: FloatArray
    faces: npt.NDArray[np.intp]
    axes: npt.NDArray[np.intp]
    signs: FloatArray
    which: npt.NDArray[np.intp]
    time: FloatArray
    parts: tuple[slice, ...]

    def read(self, displacement: Callable[[FloatArray, int], FloatArray]) -> FloatArray:
        """Return what every probe reads [m], shape (q,).

        Args:
            displacement: of points [m], shape (n, 3), on a layer's upper face; shape (n, 3).
        """
        result = np.empty(len(self.points))
        for face in np.unique(self.faces):
            here = self.faces == face
            moved = displacement(self.points[here], int(face))
            result[here] = moved[np.arange(len(moved)), self.axes[here]]
        return self.signs * result

    def moved(self, lowest: FloatArray, far: float) -> bool:
        """Return whether a depth is read away from its face's lowest point.

        Args:
            lowest: point of each layer's upper face [m], shape (layers, 3).
            far: how far away is away [m].
        """
        depths = self.signs < 0
        apart = self.points[depths] - lowest[self.faces[depths]]
        return bool((np.linalg.norm(apart, axis=1) > far).any())


def probes(measurement: Measurement, tissue: Tissue, lowest: FloatArray) -> Probes:
    """Return the probes of a measurement.

    A depth is read where the face is lowest: round a maximum a small shift changes nothing of first order.

    Args:
        measurement: whose rows.
        tissue: its layers.
        lowest: point of each layer's upper face [m], shape (layers, 3).
    """
    spots: list[tuple[float, float, int, int, float]] = []
    known: dict[tuple[float, float, int, int, float], int] = {}
    which: list[int] = []
    parts = []
    for series in measurement.series:
        face = tissue.index(series.layer)
        if series.places is None:
            keys = [(float(lowest[face, 0]), float(lowest[face, 1]), face, 2, -1.0)] * len(series.time)
        else:
            keys = [(float(x), float(y), face, series.axis, 1.0) for x, y in series.places]
        for key in keys:
            if key not in known:
                known[key] = len(spots)
                spots.append(key)
        parts.append(slice(len(which), len(which) + len(keys)))
        which += [known[key] for key in keys]
    return Probes(
        points=np.array([[x, y, 0.0] for x, y, *_ in spots]),
        faces=np.array([spot[2] for spot in spots], dtype=np.intp),
        axes=np.array([spot[3] for spot in spots], dtype=np.intp),
        signs=np.array([spot[4] for spot in spots]),
        which=np.array(which, dtype=np.intp),
        time=np.concatenate([series.time for series in measurement.series]),
        parts=tuple(parts),
    )
