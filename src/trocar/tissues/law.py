"""What a layer's stress follows from its stretch: linear elasticity, or one of three hyperelastic laws.

With F the deformation gradient, J = det F and C_bar = J^(-2/3) F^T F, whose principal values are the squares of the
isochoric stretches l1, l2, l3, every law but the linear one stores

    W = W_iso(C_bar) + K/2 (J - 1)^2

with the bulk modulus K and the shear modulus mu that follow from the layer's Young's modulus and Poisson's ratio. So
at small strain each is the linear layer, fibres aside, and under volume change all are the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, pi

from trocar.errors import InputError

MOST_TERMS = 6  # of an Ogden law; published fits have one to four
LEAST_ALPHA, MOST_ALPHA = (
    0.01,
    50.0,
)  # size of an exponent: 1/alpha^2 and l^alpha stay far from float64's ends
SAME_SHARE = 1e-6  # by which shares may miss 1: three of them written with six digits
MOST_K2 = 1e4  # published fits for arteries and skin stay below 1000


@dataclass(frozen=True, kw_only=True)
class Linear:
    """Small-strain, isotropic linear elasticity."""


@dataclass(frozen=True, kw_only=True)
class NeoHookean:
    """W_iso = mu/2 (l1^2 + l2^2 + l3^2 - 3) (R. S. Rivlin 1948, Phil. Trans. R. Soc. A 240:459)."""


@dataclass(frozen=True, kw_only=True)
class Ogden:
    """W_iso = sum over terms of 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3), mu_i = share_i mu.

    R. W. Ogden 1972, Proc. R. Soc. A 326:565, in the form whose mu_i add up to the shear modulus; there
    mu_i(Ogden) = 2 mu_i / alpha_i. Positive shares are what keeps each term stable.

    Args:
        terms: (share, alpha) of each; shares [1] above 0 add up to 1, exponents alpha [1] are not 0.

    Raises:
        InputError: a number is not possible, or the shares do not add up.
    """

    terms: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.terms) <= MOST_TERMS:
            raise InputError("ogden", f"1 to {MOST_TERMS} terms (share, alpha)", self.terms)
        for share, alpha in self.terms:
            if not (isfinite(share) and share > 0):
                raise InputError("ogden", "every share a finite number above 0", share)
            if not (isfinite(alpha) and LEAST_ALPHA <= abs(alpha) <= MOST_ALPHA):
                raise InputError(
                    "ogden", f"every alpha from {LEAST_ALPHA:g} to {MOST_ALPHA:g} in size, either sign", alpha
                )
        total = sum(share for share, _ in self.terms)
        if abs(total - 1.0) > SAME_SHARE:
            raise InputError("ogden", "shares that add up to 1", total, "divide each by their sum")


@dataclass(frozen=True, kw_only=True)
class Fibre:
    """Two families of fibres in the plane of the layer, in a neo-Hookean matrix, mirror images about x.

    With I1 = tr C_bar and I4 = a . C_bar a along a family's direction a,

        W_iso = mu/2 (I1 - 3) + sum over both of k1/(2 k2) (exp(k2 E^2) - 1),
        E = max(0, dispersion I1 + (1 - 3 dispersion) I4 - 1):

    fibres bear tension only (T. C. Gasser, R. W. Ogden and G. A. Holzapfel 2006, J. R. Soc. Interface 3:15; E is cut
    off at 0 where they cut I4 off at 1, which would make the stress of dispersed fibres jump).

    Args:
        k1: stiffness of each family [Pa].
        k2: how fast it stiffens [1].
        dispersion: 0, all parallel, to 1/3, isotropic [1].
        angle: of the families from x, to either side [rad], 0 to pi/2.

    Raises:
        InputError: a number is not possible.
    """

    k1: float
    k2: float
    dispersion: float = 0.0
    angle: float = 0.0

    def __post_init__(self) -> None:
        for key, low, high, words in (
            ("k1", 0.0, 1e12, "a number from 0 to 1e12 Pa"),
            ("k2", 0.0, MOST_K2, f"a number from 0 to {MOST_K2:g}"),
            (
                "dispersion",
                0.0,
                1 / 3 + 1e-6,
                "a number from 0 to 1/3",
            ),  # 0.333333 and 0.3333334 both mean 1/3
            ("angle", 0.0, pi / 2 * (1 + 1e-12), "an angle from 0 to pi/2"),
        ):
            value = getattr(self, key)
            if not (isfinite(value) and low <= value <= high):
                raise InputError(f"fibre: {key}", words, value)


Law = Linear | NeoHookean | Ogden | Fibre

LINEAR = Linear()
"""The law of a layer that names none."""
