"""Stresses of the hyperelastic laws under principal stretches, written from their formulas alone."""

from __future__ import annotations

from math import cos, exp, sin

import numpy as np

from trocar.tissues import Fibre, Law, NeoHookean, Ogden

MU, BULK = 1e4, 2.5e5  # [Pa]
RUBBER = ((0.7, 1.3), (0.25, 5.0), (0.05, -2.0))  # the exponents of Ogden 1972
LAWS = (NeoHookean(), Ogden(terms=RUBBER), Fibre(k1=2e4, k2=1.2, dispersion=0.1, angle=0.6))


def _slope(law: Law, stretches: np.ndarray, axis: int) -> float:
    """dW_iso/dl_axis of free stretches, written from the laws' formulas, times l_axis."""
    l2 = stretches**2
    if isinstance(law, Ogden):
        return sum(2 * share * MU / alpha * stretches[axis] ** alpha for share, alpha in law.terms)
    slope = MU * l2[axis]
    if isinstance(law, Fibre):
        along = np.array([cos(law.angle) ** 2, sin(law.angle) ** 2, 0.0])
        weight = law.dispersion + (1 - 3 * law.dispersion) * along
        strain = max(0.0, float(weight @ l2) - 1)
        slope += 2 * 2 * law.k1 * strain * exp(law.k2 * strain**2) * weight[axis] * l2[axis]
    return slope


def principal(law: Law, stretches: np.ndarray, bulk: float = BULK) -> np.ndarray:
    """Nominal principal stresses: (dev of l dW/dl)/l + K (J - 1) J / l at isochoric stretches."""
    volume = stretches.prod()
    kirchhoff = np.array([_slope(law, stretches * volume ** (-1 / 3), axis) for axis in range(3)])
    return (kirchhoff - kirchhoff.mean() + bulk * (volume - 1) * volume) / stretches
