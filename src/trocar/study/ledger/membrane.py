"""Equations 1 to 5: coefficient, wave speed and frequency of the one term the paper keeps.

u(x, y, t) = B11 cos(lambda11 t) sin(pi x/a) sin(pi y/b), lambda_mn = c pi sqrt(m^2/a^2 + n^2/b^2) and
c^2 = T/rho.
"""

from __future__ import annotations

from math import ceil, cos, hypot, isclose, pi, sin, sqrt

from scipy import integrate

from trocar.study.ledger import paper
from trocar.study.ledger.dermis import GRAM, SKIN_DENSITY, prestress_norm, tension_as_printed
from trocar.study.ledger.entry import Entry, Verdict, agrees, recomputed_entry, unspecified_entry
from trocar.units import MEGAPASCAL

SIDE = float(paper.SIDE_M)  # [m]
DISC = 6e-3  # [m], diameter within the paper's 5 to 8 mm


def initial_shape(x: float, y: float) -> float:
    """Return equation 4's f = 5 x (1 - x) y (1 - y) [m] at x, y [m]."""
    return float(paper.SHAPE_FACTOR) * x * (1 - x) * y * (1 - y)


def b11_integral() -> float:
    """Return the integral of equation 4 without its factor 4/(ab), by quadrature."""
    value, _ = integrate.dblquad(
        lambda y, x: initial_shape(x, y) * sin(pi * x / SIDE) * sin(pi * y / SIDE),
        0,
        SIDE,
        0,
        SIDE,
        epsabs=1e-16,
    )
    return float(value)


def b11_closed_form() -> float:
    """Return the same integral, 5 I^2 with I = a^2/pi - a^3 (pi^2 - 4)/pi^3, by parts."""
    one = SIDE**2 / pi - SIDE**3 * (pi**2 - 4) / pi**3
    return float(paper.SHAPE_FACTOR) * one**2


def lambda11(speed: float) -> float:
    """Return equation 2's eigenvalue for m = n = 1 [rad/s] from the wave speed [m/s]."""
    return speed * pi * hypot(1 / SIDE, 1 / SIDE)


def rayleigh_wavenumber() -> float:
    """Return sqrt(integral of |grad u|^2 / integral of u^2) of u = sin sin [rad/m], by quadrature."""
    k = pi / SIDE
    bent, _ = integrate.quad(lambda x: (k * cos(k * x)) ** 2, 0, SIDE)
    size, _ = integrate.quad(lambda x: sin(k * x) ** 2, 0, SIDE)
    return sqrt(2 * bent / size)


def disc_share() -> float:
    """Return the part of a 6 mm disc's squared shape, at the centre, that the term m = n = 1 can hold [1]."""
    k, radius = pi / SIDE, DISC / 2
    overlap, _ = integrate.dblquad(
        lambda angle, r: r * cos(k * r * cos(angle)) * cos(k * r * sin(angle)), 0, radius, 0, 2 * pi
    )
    return float(overlap**2 / (SIDE**2 / 4) / (pi * radius**2))


def membrane_entries() -> tuple[Entry, ...]:
    """Return the entries of equations 1 to 5."""
    return (*_coefficient_entries(), *_frequency_entries(), *_series_entries())


def _coefficient_entries() -> tuple[Entry, ...]:
    integral = b11_integral()
    factor = 4 / SIDE**2
    edge, centre = initial_shape(SIDE, SIDE / 2), initial_shape(SIDE / 2, SIDE / 2)
    without = "agrees" if agrees(paper.B11, integral) else "does not agree"
    return (
        recomputed_entry(
            "b11",
            paper.B11,
            factor * integral,
            "m",
            f"As written, with 4/(ab) = {factor:.5g}; the integral alone, {integral:.4g}, {without} with the "
            "printed digits: the factor was left out.",
        ),
        recomputed_entry(
            "b11_without_factor",
            paper.B11,
            integral,
            "m",
            f"The integral of equation 4 without 4/(ab), by quadrature; by parts {b11_closed_form():.6g}.",
        ),
        recomputed_entry(
            "f_boundary",
            "0",
            edge,
            "m",
            f"The membrane is fixed along its boundary, but f is {1e3 * edge:.2g} mm at the middle of the "
            f"side x = 0.06, more than the {1e3 * centre:.2g} mm at the centre. It was written for a unit "
            "square; 5 x (a - x) y (b - y) vanishes.",
        ),
    )


def _frequency_entries() -> tuple[Entry, ...]:
    rho = float(paper.DENSITY_G_M3)
    speed = sqrt(tension_as_printed() / rho)
    rounded = lambda11(sqrt(float(paper.TENSION_N_M) / rho))
    stress = prestress_norm() * MEGAPASCAL
    own_si = lambda11(sqrt(stress / (rho * GRAM)))
    skin_speed = sqrt(stress / SKIN_DENSITY)
    skin = lambda11(skin_speed)
    quotient = rayleigh_wavenumber()
    return (
        Entry(
            id="eigenvalue_formula",
            printed="c pi sqrt(m^2/a^2 + n^2/b^2)",
            recomputed=quotient,
            unit="rad/m",
            verdict=Verdict.REPRODUCED if isclose(quotient, lambda11(1.0)) else Verdict.INCONSISTENT,
            note=f"For m = n = 1 and c = 1 the formula gives {lambda11(1.0):.6g}; recomputed is the Rayleigh "
            "quotient of sin sin.",
        ),
        unspecified_entry(
            "c",
            "plain number",
            "Not printed; sqrt(T/rho), T in MPa m and rho in g/m3, as plain numbers.",
            speed,
        ),
        recomputed_entry(
            "lambda11",
            paper.LAMBDA11,
            lambda11(speed),
            "plain number",
            "Only as plain numbers, T in MPa m over rho in g/m3; in SI it is another one (lambda11_si).",
        ),
        recomputed_entry(
            "lambda11_from_printed_tension",
            paper.LAMBDA11,
            rounded,
            "plain number",
            "From the rounded T = 1.54e-3 the last digit differs: the unrounded T was used.",
        ),
        recomputed_entry(
            "lambda11_si",
            paper.LAMBDA11,
            skin,
            "rad/s",
            f"sqrt(prestress/rho) = {skin_speed:.3g} m/s with skin's 1100 kg/m3, {skin / (2 * pi):.2g} Hz.",
        ),
        recomputed_entry(
            "lambda11_si_own_density",
            paper.LAMBDA11,
            own_si,
            "rad/s",
            f"The paper's own prestress and density, 0.018 kg/m3, in SI: {own_si / (2e3 * pi):.2g} kHz.",
        ),
        unspecified_entry(
            "period",
            "s",
            "Not printed; 2 pi/0.686. Undamped, equation 5 swings for ever at this period and never returns "
            "to rest, while the finite elements follow a slow load.",
            2 * pi / float(paper.LAMBDA11),
        ),
    )


def _series_entries() -> tuple[Entry, ...]:
    largest_tool = float(paper.TOOL_MM[1])
    half_height_width = float(paper.SIDE_MM) * (1 - 2 / 6)  # sin(pi x/a) is a half at a/6 and 5a/6
    return (
        recomputed_entry(
            "series_terms",
            "1",
            ceil(4 * SIDE / DISC),
            "terms a side",
            "Equation 5 keeps one term; a half-wave a quarter of a 6 mm tool long is the term recomputed. Of "
            f"a 6 mm disc at the centre, the one term holds {100 * disc_share():.2g} %.",
        ),
        recomputed_entry(
            "footprint",
            paper.TOOL_MM[1],
            half_height_width,
            "mm",
            f"Width at half height of sin(pi x/a) against the largest tool: the dent of equation 5 is "
            f"{half_height_width / largest_tool:.2g} times wider than the tool that makes it.",
        ),
    )
