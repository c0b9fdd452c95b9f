"""How readings follow a force in layers that remember, out of static answers alone.

By the correspondence principle (R. M. Christensen 1982, Theory of Viscoelasticity, section 2.2), at a constant
Poisson's ratio, the Carson transform of a creep compliance,

    s J^(s) = s integral of J(t) exp(-s t) dt,

is the static compliance of the tissue whose moduli are E (1 + sum of g s tau/(1 + s tau)): real numbers for a real s. A
creep compliance is J(t) = j_0 + sum of j_k (1 - exp(-t/theta_k)), so s J^(s) = j_0 + sum of j_k/(1 + s theta_k). Static
answers at some s give the j of closely spaced fixed theta by least squares, cut off where rounding begins (collocation,
R. A. Schapery 1962, Proc. 4th US Nat. Congr. Appl. Mech. 1075), and a force that is linear between rows goes through
each exponential exactly. All this is one linear map from static answers to rows, made once. A prestress does not relax.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trocar.model import FloatArray
from trocar.study.calibration.measurement import Measurement
from trocar.study.calibration.parameter import Specimen
from trocar.study.calibration.probes import Probes
from trocar.study.calibration.unit_response import Units

_A_DECADE = (
    5  # static answers: 4 miss a creep by 1e-4 of it and 6 by 2e-5, over random sums of four exponentials
)
_THETAS_A_DECADE = 10
_BEYOND = 20.0  # theta goes on to this many times the record's length, and below its interval
_SPAN = 0.15, 6.0  # of s: over the record's length, over its interval
_CUT = 1e-8  # of the largest singular value: below it is the rounding of static answers, amplified


class Creeping:
    """Readings that creep under the measured force.

    Args:
        units: static answers.
        measurement: the force.
        probes: what is read.
    """

    def __init__(self, units: Units, measurement: Measurement, probes: Probes) -> None:
        self._units, self._probes = units, probes
        first, last = measurement.interval, measurement.duration
        self._s = np.append(0.0, _decades(_SPAN[0] / last, _SPAN[1] / first, _A_DECADE))
        theta = _decades(first / _BEYOND, last * _BEYOND, _THETAS_A_DECADE)
        collocated = 1 / (1 + np.outer(self._s, theta))
        matrix = np.hstack([np.ones((len(self._s) + 1, 1)), np.vstack([collocated, np.zeros(len(theta))])])
        inverse = np.linalg.pinv(matrix, rcond=_CUT)
        self._rows = _followed(theta, measurement, probes.time) @ inverse
        self._at_once = np.append(1.0, 1 - np.exp(-first / theta)) @ inverse

    def __call__(self, specimen: Specimen) -> tuple[FloatArray, FloatArray]:
        """Return the rows [m] and how each answers a force at once [m/N], both of shape (n,)."""
        answers = np.array([self._units(at_rate(specimen, s)) for s in (*self._s, np.inf)])
        which = self._probes.which
        rows = np.einsum("ns,sn->n", self._rows, answers[:, which])
        return np.asarray(rows, dtype=np.float64), np.asarray(self._at_once @ answers)[which]


def at_rate(specimen: Specimen, s: float) -> Specimen:
    """Return the elastic specimen with the moduli of the Carson transform at s [1/s]; infinity is a sudden load."""
    layers = []
    for layer in specimen.tissue.layers:
        shares = (g if np.isinf(s) else g * s * tau / (1 + s * tau) for g, tau in layer.prony)
        layers.append(replace(layer, young_modulus=layer.young_modulus * (1 + sum(shares)), prony=()))
    return replace(specimen, tissue=replace(specimen.tissue, layers=tuple(layers)))


def _decades(low: float, high: float, each: int) -> FloatArray:
    return np.geomspace(low, high, int(np.ceil(each * np.log10(high / low))) + 1)


def _followed(theta: FloatArray, measurement: Measurement, wanted: FloatArray) -> FloatArray:
    """Return the force, and through 1 - exp(-t/theta) for each theta, at the times wanted, shape (n, 1 + thetas).

    With z' = -z/theta + F', z starting at the first force, what follows is F - z.
    """
    times = np.union1d(measurement.time, wanted)
    force = np.interp(times, measurement.time, measurement.force)
    lag = np.empty((len(times), len(theta)))
    lag[0] = force[0]
    for i, (dt, change) in enumerate(zip(np.diff(times), np.diff(force), strict=True)):
        kept = np.exp(-dt / theta)
        lag[i + 1] = kept * lag[i] + change / dt * theta * -np.expm1(-dt / theta)
    table = np.hstack([force[:, None], force[:, None] - lag])
    return table[np.searchsorted(times, wanted)]
