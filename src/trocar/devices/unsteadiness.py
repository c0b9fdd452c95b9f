"""What keeps a held handle from being still: physiological tremor and the sensor's noise.

Both are functions of the seed and the time alone, so a trial repeats bit by bit, in whatever order it is asked for.

Tremor has its power between 8 and 12 Hz and an amplitude of 50 to 200 um rms at an instrument's tip held by hand
(Wells and others 2013, IEEE SMC, 1482-1487, and what they cite), and several dominant frequencies at once rather than
one (Veluvolu and Ang 2011, Sensors 11:3020-3036). Here it is a sum of sines with seeded frequencies and phases,

    x_i(t) = A sqrt(2/(3 n)) sum_k sin(2 pi f_ik t + phi_ik),   k = 1..n,   i = x, y, z,

whose vector has the rms value A. The numbers are those of microsurgeons with a few centimetres of tool; that a hand on
a laparoscopic handle trembles alike is our assumption. Noise is Gaussian at each reading of the sensor and goes
linearly from one to the next, as a driver that fills in between readings gives it.
"""

from __future__ import annotations

from hashlib import blake2b
from math import cos, floor, isfinite, log, pi, sin, sqrt
from random import Random

from trocar.contact.instrument import Vector
from trocar.errors import InputError

LOWEST, HIGHEST = 8.0, 12.0  # [Hz] of physiological tremor
USUAL_TREMOR = 1e-4  # [m] rms: the middle of the published range, by ratio
USUAL_NOISE = 1e-5  # [m]; chosen: well below the tremor, as a position sensor must be to show it
MOST_TREMOR = 1e-3  # [m] rms; more is an illness
MOST_NOISE = 1e-4  # [m]

_SINES = 5  # in each direction: enough for a beat that does not repeat within a trial
_READINGS = 100.0  # [Hz] of the sensor
_RESOLUTION = 2.0**-32  # of the uniform numbers behind the Gaussian ones


class Tremor:
    """Physiological tremor of one hand.

    Args:
        seed: which hand, on which day.
        amplitude: root mean square of the displacement vector [m].

    Raises:
        InputError: the amplitude is negative or too large to be physiological.
    """

    def __init__(self, seed: str, amplitude: float = USUAL_TREMOR) -> None:
        _check_amplitude("tremor", amplitude, MOST_TREMOR)
        draw = Random(f"tremor {seed}")
        self._scale = amplitude * sqrt(2.0 / (3.0 * _SINES))
        self._sines = tuple(
            tuple(
                (2.0 * pi * draw.uniform(LOWEST, HIGHEST), draw.uniform(0.0, 2.0 * pi)) for _ in range(_SINES)
            )
            for _ in range(3)
        )

    def at(self, time: float) -> Vector:
        """Return the displacement at a time [s], shape (3,) [m]."""
        x, y, z = (
            self._scale * sum(sin(omega * time + phase) for omega, phase in sines) for sines in self._sines
        )
        return x, y, z


class SensorNoise:
    """Noise of one position sensor.

    Args:
        seed: which sensor, on which day.
        amplitude: standard deviation of a reading in each direction [m].

    Raises:
        InputError: the amplitude is negative or larger than that of any useful sensor.
    """

    def __init__(self, seed: str, amplitude: float = USUAL_NOISE) -> None:
        _check_amplitude("noise", amplitude, MOST_NOISE)
        self._amplitude = amplitude
        self._key = blake2b(f"noise {seed}".encode()).digest()
        self._near = (
            0,
            self._reading(0),
            self._reading(1),
        )  # kept: ten ticks in a row lie between the same two

    def at(self, time: float) -> Vector:
        """Return the error at a time [s], shape (3,) [m]."""
        readings = time * _READINGS
        before = floor(readings)
        near = self._near
        if near[0] != before:
            near = self._near = (before, self._reading(before), self._reading(before + 1))
        share = readings - before
        x, y, z = (self._amplitude * (a + (b - a) * share) for a, b in zip(near[1], near[2], strict=True))
        return x, y, z

    def _reading(self, number: int) -> Vector:
        """Return three Gaussian numbers that belong to a reading (Box and Muller 1958)."""
        bits = blake2b(str(number).encode(), digest_size=24, key=self._key).digest()
        uniform = [int.from_bytes(bits[i : i + 4], "little") * _RESOLUTION for i in range(0, 24, 4)]
        x, y, z = (
            sqrt(-2.0 * log(1.0 - uniform[i])) * cos(2.0 * pi * uniform[i + 1]) for i in range(0, 6, 2)
        )
        return x, y, z


def _check_amplitude(name: str, amplitude: float, most: float) -> None:
    if not (isfinite(amplitude) and 0.0 <= amplitude <= most):
        raise InputError(f"simulated device: {name}", f"an amplitude from 0 to {most:g} m", amplitude)
