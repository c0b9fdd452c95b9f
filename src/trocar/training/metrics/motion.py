"""A recorded motion made ready for derivatives: filtered, on one time step, and a spline through it.

Every metric that differentiates sees the same motion: low-passed by a 4th-order Butterworth filter run forwards and
backwards (zero phase), 6 Hz, at the rate it was recorded at, then resampled to 100 Hz. The filter is part of each
metric's definition: the smoothness of one and the same knot changes threefold between 3 and 10 Hz. Derivatives are
those of the interpolating quintic spline, not differences, which lose a twentieth of a reach's jerk at its ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.signal import butter, sosfiltfilt

from trocar.errors import InputError
from trocar.model import FloatArray

RATE = 100.0  # [Hz] of the motion that is measured
CUTOFF, ORDER = 6.0, 4  # [Hz] of the Butterworth filter, and its order; run twice
_PADDING = 0.5  # [s] by which the motion is continued beyond its ends, mirrored through them, for the filter
SHORTEST = 0.1  # [s]
_FINER = 5  # points of an integral to a sample: between samples a derivative is a low polynomial


@dataclass(frozen=True, kw_only=True)
class SmoothPath:
    """One filtered coordinate, or several together, on a step of 1/`RATE`.

    Attributes:
        times: [s], shape (n,).
        places: shape (n, d), in any unit; the others follow it.
        spline: through them.
    """

    times: FloatArray
    places: FloatArray
    spline: BSpline

    @property
    def duration(self) -> float:
        """From first to last sample [s]."""
        return float(self.times[-1] - self.times[0])

    @property
    def length(self) -> float:
        """Length of the polygon through all samples."""
        return float(np.linalg.norm(np.diff(self.places, axis=0), axis=1).sum())

    @property
    def speed(self) -> FloatArray:
        """Absolute velocity at every sample, shape (n,)."""
        return np.asarray(np.linalg.norm(self.spline.derivative()(self.times), axis=1), dtype=np.float64)

    def integral_of_squared(self, derivative: int) -> float:
        """Return the time integral of the squared absolute value of a derivative."""
        fine = np.linspace(self.times[0], self.times[-1], _FINER * (len(self.times) - 1) + 1)
        squared = (self.spline.derivative(derivative)(fine) ** 2).sum(axis=1)
        return float(np.trapezoid(squared, fine))


def smooth_path(times: FloatArray, places: FloatArray) -> SmoothPath:
    """Filter and resample a recorded motion.

    Args:
        times: rising; gaps are bridged by straight lines [s], shape (n,).
        places: shape (n,) or (n, d).

    Raises:
        InputError: too short, not finite, or times that do not rise.
    """
    at = np.asarray(times, dtype=np.float64)
    values = np.asarray(places, dtype=np.float64)
    if len(at) < 2 or not at[-1] - at[0] >= SHORTEST:
        seconds = float(at[-1] - at[0]) if len(at) else 0.0
        raise InputError("motion", f"at least {SHORTEST:g} s", f"{seconds:g} s")
    values = values.reshape(len(at), -1)
    if not (np.isfinite(at).all() and np.isfinite(values).all()):
        raise InputError("motion", "finite numbers alone", "one that is not")
    steps = np.diff(at)
    if not (steps > 0).all():
        raise InputError("motion: times", "rising numbers", f"a step of {steps.min():g} s")
    rate = max(1.0 / float(np.median(steps)), RATE)
    even = np.linspace(at[0], at[-1], max(round((at[-1] - at[0]) * rate), 8) + 1)
    smooth = low_passed(_between(even, at, values), (len(even) - 1) / (even[-1] - even[0]))
    wanted = np.linspace(at[0], at[-1], max(round((at[-1] - at[0]) * RATE), 8) + 1)
    samples = make_interp_spline(even, smooth, k=3)(wanted)
    return SmoothPath(times=wanted, places=samples, spline=make_interp_spline(wanted, samples, k=5))


def low_passed(values: FloatArray, rate: float) -> FloatArray:
    """Return values along the first axis through the filter that is part of every metric.

    Args:
        values: evenly sampled.
        rate: of the samples, above 12 Hz [Hz].
    """
    sections = butter(ORDER, CUTOFF, fs=rate, output="sos")
    padding = min(len(values) - 1, round(_PADDING * rate))
    return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=padding), dtype=np.float64)


def _between(wanted: FloatArray, times: FloatArray, values: FloatArray) -> FloatArray:
    return np.stack([np.interp(wanted, times, column) for column in values.T], axis=1)
