"""The coefficients of coupled membranes, one sheet per layer, and how they follow from a tissue.

Sheet i obeys

    m_i u_i'' + c_i u_i' + tau_i S_i u_i' + S_i u_i + sum over neighbours k (1 + tau d/dt) (u_i - u_j) = p_i,
    S_i = D_i del^4 - Tx_i d^2/dx^2 - Ty_i d^2/dy^2,

with a foundation as the lowest neighbour, standing still. S_i and k relax where they have a Prony series. It is the
paper's equation 1 per layer, with what it left out: a tension of its own along x and y, bending, damping, memory, and
the coupling that makes the layers one tissue.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Support
from trocar.tissues.layer import Layer, Prony
from trocar.tissues.tissue import Tissue


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """One membrane of the stack.

    Args:
        name: of the layer it stands for.
        tension_x, tension_y: [N/m].
        bending: stiffness D [N m].
        areal_density: [kg/m2].
        damping: viscous, against the room [N s/m3].
        retardation_time: Kelvin-Voigt time of tension and bending [s].
        prony: terms (g, tau) by which both relax: weight relative to the long-term value [1], time [s].

    Raises:
        InputError: a value is not finite, negative, or the areal density or a relaxation time is 0.
    """

    name: str
    tension_x: float
    tension_y: float
    areal_density: float
    bending: float = 0.0
    damping: float = 0.0
    retardation_time: float = 0.0
    prony: Prony = ()

    def __post_init__(self) -> None:
        for key in ("tension_x", "tension_y", "bending", "damping", "retardation_time"):
            _require(f"sheet {self.name!r}: {key}", getattr(self, key), at_least_zero=True)
        _require(f"sheet {self.name!r}: areal_density", self.areal_density)
        _require_prony(f"sheet {self.name!r}", self.prony)


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """A bed of springs and dampers below a sheet.

    Args:
        stiffness: [N/m3].
        retardation_time: Kelvin-Voigt time [s].
        prony: terms (g, tau) by which it relaxes, as a sheet's.

    Raises:
        InputError: a value is not finite or negative, or a relaxation time is 0.
    """

    stiffness: float
    retardation_time: float = 0.0
    prony: Prony = ()

    def __post_init__(self) -> None:
        for key in ("stiffness", "retardation_time"):
            _require(f"coupling: {key}", getattr(self, key), at_least_zero=True)
        _require_prony("coupling", self.prony)


@dataclass(frozen=True, kw_only=True)
class Stack:
    """Sheets, top first, each coupled to the next and the last to the ground.

    Args:
        sheets: at least one, names unique.
        couplings: one below each sheet; the last is the foundation (stiffness 0 where there is none).

    Raises:
        InputError: there is no sheet, or not one coupling below each.
    """

    sheets: tuple[Sheet, ...]
    couplings: tuple[Coupling, ...]

    def __post_init__(self) -> None:
        names = [sheet.name for sheet in self.sheets]
        if not names or len(set(names)) != len(names):
            raise InputError("stack: sheets", "at least one sheet, every name once", names)
        if len(self.couplings) != len(self.sheets):
            raise InputError(
                "stack: couplings",
                f"{len(self.sheets)}, one below each sheet (the last is the foundation)",
                len(self.couplings),
            )

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """The different times of all series, ascending [s]; empty where nothing remembers."""
        series = [sheet.prony for sheet in self.sheets] + [bed.prony for bed in self.couplings]
        return tuple(sorted({time for prony in series for weight, time in prony if weight > 0}))

    def compliance(self, k: FloatArray) -> FloatArray:
        """Return every sheet's static amplitude per unit amplitude of pressure on the top one [m/Pa].

        Args:
            k: wavenumbers [1/m], shape (J,), of no direction: a sheet's tension is the mean of its two.

        Returns:
            Shape (J, sheets).
        """
        tension = np.array([0.5 * (sheet.tension_x + sheet.tension_y) for sheet in self.sheets])
        bending = np.array([sheet.bending for sheet in self.sheets])
        return sheet_compliance(tension, bending, np.array([bed.stiffness for bed in self.couplings]), k)


def sheet_compliance(
    tension: FloatArray, bending: FloatArray, coupling: FloatArray, k: FloatArray
) -> FloatArray:
    """Return each sheet's static amplitude per unit amplitude of pressure on the top one [m/Pa], shape (J, n).

    Args:
        tension: of each of n sheets, top first [N/m].
        bending: stiffness of each [N m].
        coupling: of the bed below each [N/m3].
        k: wavenumbers [1/m], shape (J,).
    """
    k2 = k[:, None] ** 2
    own = bending * k2**2 + tension * k2
    flexibility = 1 / (own[:, -1] + coupling[-1])  # of the sheets below, seen from above
    below = [flexibility]
    for i in range(len(tension) - 2, -1, -1):
        flexibility = 1 / (own[:, i] + 1 / (flexibility + 1 / coupling[i]))
        below.append(flexibility)
    below.reverse()
    response = [below[0]]
    for i in range(1, len(tension)):
        passed = below[i] / (below[i] + 1 / coupling[i - 1])
        response.append(response[-1] * passed)
    return np.stack(response, axis=1)


def derived_stack(tissue: Tissue, support: Support) -> Stack:
    """Derive coefficients from the layers alone, without a fit.

    Each layer's vertical displacement is taken to run linearly from its upper face to its lower one and its
    in-plane displacement to vanish (Vlasov and Leont'ev 1966, ch. 2, one layer; half of the shear goes to each
    face). Then layer i, with constrained modulus H = lambda + 2 mu, gives

        coupling below sheet i     H_i / h_i
        tension of its two faces   mu_i h_i / 2 each, plus prestress times thickness at its own face
        bending of its own face    E_i h_i^3 / (12 (1 - nu_i^2))

    Because nothing may give way sideways the result is far too stiff where Poisson's ratio nears 0.5: it is a
    starting point and a statement of structure. `WaveMembrane.fitted` is what to use.

    Args:
        tissue: the layers.
        support: with a free base there is no foundation, and the lowest layer's own face carries the whole of it.
    """
    layers = tissue.layers
    sheets = []
    for i, layer in enumerate(layers):
        above = _shear_tension(layers[i - 1]) if i else 0.0
        shared = above + _shear_tension(layer)
        sheets.append(
            Sheet(
                name=layer.name,
                tension_x=shared + layer.prestress_x * layer.thickness,
                tension_y=shared + layer.prestress_y * layer.thickness,
                bending=layer.young_modulus * layer.thickness**3 / (12 * (1 - layer.poisson_ratio**2)),
                areal_density=layer.density * layer.thickness,
                retardation_time=layer.retardation_time,
                prony=layer.prony,
            )
        )
    couplings = [
        Coupling(
            stiffness=(layer.lame_lambda + 2 * layer.shear_modulus) / layer.thickness,
            retardation_time=layer.retardation_time,
            prony=layer.prony,
        )
        for layer in layers
    ]
    if not support.base_held:
        couplings[-1] = Coupling(stiffness=0.0)
    return Stack(sheets=tuple(sheets), couplings=tuple(couplings))


def _shear_tension(layer: Layer) -> float:
    return 0.5 * layer.shear_modulus * layer.thickness


def weight_of(prony: Prony, time: float) -> float:
    """Return the weight g of a relaxation time [s] in a series; 0 where it is not there."""
    return sum(weight for weight, own in prony if own == time)


def _require_prony(where: str, prony: Prony) -> None:
    for weight, time in prony:
        _require(f"{where}: g of prony", weight, at_least_zero=True)
        _require(f"{where}: tau of prony", time)


def _require(where: str, value: float, *, at_least_zero: bool = False) -> None:
    if not (isfinite(value) and (value >= 0 if at_least_zero else value > 0)):
        raise InputError(
            where, "a finite number, 0 or above" if at_least_zero else "a finite number above 0", value
        )
