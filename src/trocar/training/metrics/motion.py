"""A recorded motion made ready for derivatives: filtered, on one time step, and a spline through it.

Every metric that differentiates sees the same motion: low-passed by a 4th-order Butterworth filter run forwards and
backwards (zero phase), 6 Hz, at the rate it was recorded at, then resampled to 100 Hz. The filter is part of each
metric's definition: the smoothness of one and the same knot changes threefold between 3 and 10 Hz. Derivatives are
those of the interpolating quintic spline, not differences, which lose a twentieth of a reach's jerk at its ends.

A sensor's noise is left below 6 Hz too. Lengths are therefore walked in strides longer than it, or a hand at rest would
go far; and the squared jerk is less what white noise adds that is as strong as the motion is between 20 and 45 Hz,
where no hand moves (tremor is at 8 to 12 Hz).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.signal import butter, freqz_sos, sosfiltfilt

from trocar.errors import InputError
from trocar.model import FloatArray

RATE = 100.0  # [Hz] of the motion that is measured
CUTOFF, ORDER = 6.0, 4  # [Hz] of the Butterworth filter, and its order; run twice
_PADDING = 0.5  # [s] by which the motion is continued beyond its ends, mirrored through them, for the filter
SHORTEST = 0.1  # [s]
STRIDE = 1e-4  # [m] of a length; of an angle [rad] ten times as much, for a tip is some 0.1 m from its port
QUIET = (20.0, 45.0)  # [Hz] where what moves is noise
_FREQUENCIES = 2**15  # of a filter's response
_FINER = 5  # points of an integral to a sample: between samples a derivative is a low polynomial


@dataclass(frozen=True, kw_only=True)
class SmoothPath:
    """One filtered coordinate, or several together, on a step of 1/`RATE`.

    Attributes:
        times: [s], shape (n,).
        places: shape (n, d), in any unit; the others follow it.
        spline: through them.
        noise_jerk: what noise adds to the time integral of the squared jerk.
    """

    times: FloatArray
    places: FloatArray
    spline: BSpline
    noise_jerk: float

    @property
    def duration(self) -> float:
        """From first to last sample [s]."""
        return float(self.times[-1] - self.times[0])

    def length(self, stride: float = STRIDE) -> float:
        """Return the length of the way in strides, the polygon through `places[strides(places, stride)]`."""
        kept = self.places[strides(self.places, stride)]
        return float(np.linalg.norm(np.diff(kept, axis=0), axis=1).sum())

    @property
    def speed(self) -> FloatArray:
        """Absolute velocity at every sample, shape (n,)."""
        return np.asarray(np.linalg.norm(self.spline.derivative()(self.times), axis=1), dtype=np.float64)

    def jerk(self) -> float:
        """Return the time integral of the squared absolute jerk, less noise's, 0 at least."""
        fine = np.linspace(self.times[0], self.times[-1], _FINER * (len(self.times) - 1) + 1)
        squared = (self.spline.derivative(3)(fine) ** 2).sum(axis=1)
        return max(0.0, float(np.trapezoid(squared, fine)) - self.noise_jerk)


def strides(places: FloatArray, stride: float) -> np.ndarray:
    """Return which places are left of a way walked in strides: the next one that is a stride away, again and again.

    The first and the last are among them.

    Args:
        places: shape (n, d).
        stride: in their unit.
    """
    kept = [0]
    here = places[0]
    for number, place in enumerate(places):
        if np.linalg.norm(place - here) >= stride:
            kept.append(number)
            here = place
    return np.array([*kept, len(places) - 1])


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
    rate = (len(even) - 1) / (even[-1] - even[0])
    evenly = _between(even, at, values)
    smooth = low_passed(evenly, rate)
    wanted = np.linspace(at[0], at[-1], max(round((at[-1] - at[0]) * RATE), 8) + 1)
    samples = make_interp_spline(even, smooth, k=3)(wanted)
    return SmoothPath(
        times=wanted,
        places=samples,
        spline=make_interp_spline(wanted, samples, k=5),
        noise_jerk=float((at[-1] - at[0]) * _noise(evenly, rate).sum() * _jerk_of_noise(round(rate, 6))),
    )


def time_above(times: FloatArray, values: FloatArray, limit: float) -> float:
    """Return how long values, joined by straight lines, are above a limit [s].

    Args:
        times: rising [s], shape (n,).
        values: shape (n,).
        limit: infinite is never reached.
    """
    low, high = np.minimum(values[:-1], values[1:]), np.maximum(values[:-1], values[1:])
    level = high == low
    share = np.clip((high - limit) / np.where(level, 1.0, high - low), 0.0, 1.0)
    return float(np.where(level, low > limit, share) @ np.diff(times))


def low_passed(values: FloatArray, rate: float) -> FloatArray:
    """Return values along the first axis through the filter that is part of every metric.

    Args:
        values: evenly sampled.
        rate: of the samples, above 12 Hz [Hz].
    """
    return _both_ways(butter(ORDER, CUTOFF, fs=rate, output="sos"), values, rate)


def _both_ways(sections: FloatArray, values: FloatArray, rate: float) -> FloatArray:
    padding = min(len(values) - 1, round(_PADDING * rate))
    return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=padding), dtype=np.float64)


def _noise(values: FloatArray, rate: float) -> FloatArray:
    """Return the one-sided power density of each column where it is quiet [its unit squared/Hz]."""
    sections = butter(ORDER, QUIET, "bandpass", fs=rate, output="sos")
    left = _both_ways(sections, values, rate)
    return np.asarray((left**2).mean(axis=0) / _through(sections, rate, 0))


@cache
def _jerk_of_noise(rate: float) -> float:
    """Return the mean squared jerk, after the filter, of white noise of density 1."""
    return _through(butter(ORDER, CUTOFF, fs=rate, output="sos"), rate, 3)


def _through(sections: FloatArray, rate: float, derivative: int) -> float:
    """Return the mean square of a derivative of white noise of density 1 that went through a filter both ways."""
    frequencies, response = freqz_sos(sections, worN=_FREQUENCIES, fs=rate)
    passed = (2 * np.pi * frequencies) ** (2 * derivative) * np.abs(response) ** 4
    return float(np.trapezoid(passed, frequencies))


def _between(wanted: FloatArray, times: FloatArray, values: FloatArray) -> FloatArray:
    return np.stack([np.interp(wanted, times, column) for column in values.T], axis=1)
