"""Parameters of a law by least squares.

What must stay positive is sought as its logarithm, so no bound is needed and a step is a share of what is there
(trust-region reflective; M. A. Branch, T. F. Coleman, Y. Li 1999, SIAM J. Sci. Comput. 21:1).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from trocar.model import FloatArray
from trocar.tissues.law import Fibre, Law, NeoHookean, Ogden

_MOST_EVALUATIONS = 400
_LARGEST_FACTOR = 1e5  # by which a modulus may leave where it started
_EXPONENTS = (1.0, 30.0)  # size of an Ogden exponent: from 1 on a term is polyconvex (J. M. Ball 1977)
_STIFFENING = (1e-3, 1e3)  # k2 of fibres


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A law with the moduli that fit.

    Args:
        law: with its parameters.
        shear_modulus: mu [Pa].
    """

    law: Law
    shear_modulus: float


Response = Callable[[Law, float], FloatArray]
"""From a law and mu to what was measured, shape (n,)."""


def positive_fit(
    predict: Callable[[FloatArray], FloatArray],
    measured: FloatArray,
    start: Sequence[float],
    *,
    floor: float,
    ranges: Sequence[tuple[float, float]] = (),
) -> FloatArray:
    """Return positive parameters for which a prediction is nearest to what was measured.

    Args:
        predict: from parameters, shape (p,), to predictions, shape (n,).
        measured: shape (n,).
        start: parameters to start from, above 0.
        floor: differences are weighed by one over the larger of this share of the largest measured value and the value
            itself: 1 weighs all alike, a small one weighs relative errors.
        ranges: least and greatest of the last parameters; those before, moduli, stay within 1e5 of their start.
    """
    size = np.maximum(np.abs(measured), floor * np.abs(measured).max())
    first = np.log(np.asarray(start, dtype=np.float64))
    reach = np.log(_LARGEST_FACTOR) * np.ones(len(first))
    low, high = first - reach, first + reach
    for place, (least, most) in enumerate(ranges, start=len(first) - len(ranges)):
        low[place], high[place] = np.log(least), np.log(most)

    def residual(logs: FloatArray) -> FloatArray:
        return np.asarray((predict(np.exp(logs)) - measured) / size)

    found = least_squares(
        residual,
        first,
        bounds=(low, high),
        max_nfev=_MOST_EVALUATIONS,
    )
    return np.asarray(np.exp(found.x))


def fit_neo_hookean(respond: Response, measured: FloatArray, *, floor: float = 1.0) -> Fitted:
    """Fit mu, of which the response is a multiple: a linear problem."""
    unit = respond(NeoHookean(), 1.0)
    size = np.maximum(np.abs(measured), floor * np.abs(measured).max())
    return Fitted(
        law=NeoHookean(),
        shear_modulus=float((unit / size) @ (measured / size) / ((unit / size) @ (unit / size))),
    )


def fit_ogden(
    respond: Response, measured: FloatArray, start: Sequence[tuple[float, float]], *, floor: float = 1.0
) -> Fitted:
    """Fit an Ogden law.

    Args:
        respond: what is to be near the measured.
        measured: shape (n,).
        start: (mu_i [Pa], alpha_i) of each term; an exponent keeps its sign.
        floor: as `positive_fit`.
    """
    moduli, exponents = zip(*start, strict=True)
    found = positive_fit(
        lambda given: respond(*_ogden(given, exponents)),
        measured,
        [*moduli, *np.abs(exponents)],
        floor=floor,
        ranges=[_EXPONENTS] * len(exponents),
    )
    law, mu = _ogden(found, exponents)
    return Fitted(law=law, shear_modulus=mu)


def fit_fibre(
    respond: Response,
    measured: FloatArray,
    *,
    start: tuple[float, float, float],
    dispersion: float = 0.0,
    floor: float = 1.0,
) -> Fitted:
    """Fit mu, k1 and k2 of fibres along x.

    Args:
        respond: what is to be near the measured.
        measured: shape (n,).
        start: mu [Pa], k1 [Pa], k2 [1].
        dispersion: of the fibres [1].
        floor: as `positive_fit`.
    """

    def law(given: FloatArray) -> Law:
        return Fibre(k1=float(given[1]), k2=float(given[2]), dispersion=dispersion)

    found = positive_fit(
        lambda given: respond(law(given), float(given[0])), measured, start, floor=floor, ranges=[_STIFFENING]
    )
    return Fitted(law=law(found), shear_modulus=float(found[0]))


def _ogden(given: FloatArray, like: Sequence[float]) -> tuple[Ogden, float]:
    count = len(like)
    moduli, exponents = given[:count], np.copysign(given[count:], like)
    mu = float(moduli.sum())
    shares = zip(moduli / mu, exponents, strict=True)
    return Ogden(terms=tuple((float(share), float(alpha)) for share, alpha in shares)), mu
