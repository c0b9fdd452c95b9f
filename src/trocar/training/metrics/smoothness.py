"""How smooth a motion is, in three published ways; none of them is proof of skill.

With path length L, duration T, highest speed v_max and jerk j of a filtered motion (`motion`),

    integrated jerk         S = sqrt(T^5/(2 L^2) int |j|^2 dt)
    log dimensionless jerk  LDLJ = -ln(T^3/v_max^2 int |j|^2 dt)
    spectral arc length     SPARC, of one discrete movement

S is that of the EndoViS code, which leaves the dt out; the others are of Balasubramanian et al. 2015, J NeuroEng
Rehabil 12:112. LDLJ is published for the second derivative of the speed; along a straight line that is |j|. The jerk
itself is taken here, since a speed has a corner, and no second derivative, wherever a tip turns back.

S is sqrt(360) for a minimum-jerk reach, whatever its length and duration, and grows with every hesitation. It goes
mostly with time: on surgeons tying knots the two are correlated by 0.93, so S is not a second piece of evidence
beside it. LDLJ and SPARC are the nearer to zero the smoother. SPARC of a whole task separates nobody from nobody.
"""

from __future__ import annotations

from math import log, nan, sqrt

import numpy as np

from trocar.model import FloatArray
from trocar.training.metrics.motion import RATE, SmoothPath

MOVING = 5e-3  # [m/s] a slower tip is idle
MOVEMENT = 0.4  # [s] a shorter run above `MOVING` is no movement
_HIGHEST, _LOUD, _PADDED = 10.0, 0.05, 4  # [Hz], of the peak, powers of two: SPARC's own constants


def integrated_jerk(motion: SmoothPath) -> float:
    """Return S [1]; nan of a motion that goes nowhere, or of noise alone."""
    length, jerk = motion.length(), motion.jerk()
    return sqrt(motion.duration**5 / (2 * length**2) * jerk) if length > 0 and jerk > 0 else nan


def log_dimensionless_jerk(motion: SmoothPath) -> float:
    """Return LDLJ [1]; nan of a motion that goes nowhere, or of noise alone."""
    fastest, jerk = float(motion.speed.max()), motion.jerk()
    return -log(motion.duration**3 / fastest**2 * jerk) if fastest > 0 and jerk > 0 else nan


def sparc(speed: FloatArray, rate: float = RATE) -> float:
    """Return the spectral arc length of a speed profile [1].

    Args:
        speed: of one movement, shape (n,).
        rate: of its samples [Hz].
    """
    count = 2 ** (int(np.ceil(np.log2(len(speed)))) + _PADDED)
    frequencies = np.arange(count) * rate / count
    spectrum = np.abs(np.fft.fft(speed, count))
    spectrum = spectrum / spectrum.max()
    low = frequencies <= _HIGHEST
    frequencies, spectrum = frequencies[low], spectrum[low]
    loud = np.flatnonzero(spectrum >= _LOUD)
    used = slice(loud[0], loud[-1] + 1)
    frequencies, spectrum = frequencies[used], spectrum[used]
    across = frequencies[-1] - frequencies[0]
    return -float(np.hypot(np.diff(frequencies) / across, np.diff(spectrum)).sum())


def movements(motion: SmoothPath) -> list[slice]:
    """Return where a motion moves: runs of samples above `MOVING`, at least `MOVEMENT` long."""
    moving = np.concatenate([[False], motion.speed > MOVING, [False]])
    begins, ends = (np.flatnonzero(np.diff(moving.astype(np.int8)) == sign) for sign in (1, -1))
    return [slice(a, b) for a, b in zip(begins, ends, strict=True) if b - a >= MOVEMENT * RATE]


def sparc_of_movements(motion: SmoothPath) -> float:
    """Return the median spectral arc length of a motion's movements [1]; nan where there is none."""
    speed = motion.speed
    found = [sparc(speed[part]) for part in movements(motion)]
    return float(np.median(found)) if found else nan
