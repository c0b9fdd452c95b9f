"""What was measured: a tool's force in time, and what moved under it.

Everything is in SI here; `reading` crosses the border from files.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray

DEPTH = "displacement"
"""Name of the series every record has: how deep the tool stands."""


@dataclass(frozen=True, kw_only=True)
class Readings:
    """One kind of reading at its times.

    Attributes:
        name: as tables call it.
        time: [s], shape (n,).
        value: [m], shape (n,); how far a face is pushed in, or a component of a marker's displacement.
        layer: whose upper face; None means the top one.
        places: of markers on the block [m], shape (n, 2); None where the lowest point of the face was read.
        axis: 0, 1 or 2: the component that markers give.
    """

    name: str
    time: FloatArray
    value: FloatArray
    layer: str | None = None
    places: FloatArray | None = None
    axis: int = 2

    @property
    def has_offset(self) -> bool:
        """Whether its zero was set by hand: a depth's is, a marker's is its place in the first picture."""
        return self.places is None

    @property
    def range(self) -> float:
        """Largest minus smallest value [m]."""
        return float(np.ptp(self.value))


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """A record of one press.

    Attributes:
        source: name of the file.
        time: [s], ascending, shape (n,).
        force: along the tool's axis, positive pressing in [N], shape (n,).
        series: what moved; the first is the tool's depth.
    """

    source: str
    time: FloatArray
    force: FloatArray
    series: tuple[Readings, ...]

    @property
    def peak(self) -> float:
        """Largest force [N]."""
        return float(self.force.max())

    @property
    def duration(self) -> float:
        """Time from the first row to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def interval(self) -> float:
        """Median time between rows [s]."""
        return float(np.median(np.diff(self.time)))
