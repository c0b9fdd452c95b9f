"""A disc pressed between two platens: hyperelastic finite elements, axially symmetric.

In cylindrical coordinates, r, theta, z, a displacement (u, w) of the meridian plane has

    F = I + [[du/dR, 0, du/dZ], [0, u/R, 0], [dw/dR, 0, dw/dZ]],

and forces and tangent are sums over Gauss points as in `deformed`, each point weighing 2 pi R. Elements are quadratic,
with nine nodes. In place of K/2 (J - 1)^2 each stores K/2 t^2 with t the part of J - 1 that is linear over the element
(mean dilatation; J. C. Nagtegaal, D. M. Parks and J. R. Rice 1974; with this pair no pressure can oscillate:
F. Brezzi and M. Fortin 1991, Mixed and Hybrid Finite Element Methods, sec. VI.3), so that a nearly incompressible disc
does not lock. Only the upper half is meshed, and the middle plane cannot leave itself.

Bonded faces cannot move sideways; free ones slide without friction. The side of a bonded disc bulges, and what of it
would come past the platen lays itself on it: it slides there freely, held back by a stiff spring at each node.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementQuad2, MeshQuad

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.reference.deformed import InversionError
from trocar.reference.hyperelastic import Material, first_piola, nominal_moduli
from trocar.reference.newton import Directions, NewtonError, balance
from trocar.tissues.law import Law, NeoHookean, Ogden

_RADIAL, _AXIAL = 6, 4  # elements: half as many again each way change the force by less than 1.5 %
_LONGEST = 0.04  # of the height: compression in one step
_SHORTEST = 0.001
_TOLERANCE = 1e-9  # of the force on the platen, what may be out of balance
_SPRING = (
    20000.0  # of mu times the radius over the number of nodes at the side [1]: what is past stays below h/200
)
_ORDER = 5  # what 3 x 3 Gauss points integrate exactly
_UNIT = np.eye(3).ravel()


@dataclass(frozen=True, kw_only=True)
class PlatenCurve:
    """Force on the platens against compression, as far as it could be followed.

    Args:
        strain: compression over height [1], ascending from 0, shape (n,).
        force: on a platen, compression positive [N], shape (n,).
        past: how far springs let the side past the platen, over the height [1], shape (n,).
        stopped: why it ends where it does; empty where it reached what was asked for.
    """

    strain: FloatArray
    force: FloatArray
    past: FloatArray
    stopped: str


class Cylinder:
    """A disc of one material.

    Args:
        radius: [m].
        height: of the whole disc [m].
        law: any but the linear one; fibres, which know x from y, are refused.
        shear_modulus: mu [Pa].
        bulk_modulus: K [Pa].
        bonded: whether the platens hold the faces sideways.
        elements: along the radius and over half the height.

    Raises:
        InputError: a number is not possible.
    """

    def __init__(
        self,
        *,
        radius: float,
        height: float,
        law: Law,
        shear_modulus: float,
        bulk_modulus: float,
        bonded: bool,
        elements: tuple[int, int] = (_RADIAL, _AXIAL),
    ) -> None:
        for key, value in (("radius", radius), ("height", height), ("shear modulus", shear_modulus)):
            if not value > 0:
                raise InputError(f"cylinder: {key}", "a number above 0", value)
        if not bulk_modulus > 0:
            raise InputError("cylinder: bulk modulus", "a number above 0", bulk_modulus)
        if not isinstance(law, NeoHookean | Ogden):
            raise InputError("cylinder: law", "neo-Hookean or Ogden", type(law).__name__)
        self.radius, self.height = radius, height
        self._mu, self._bulk = shear_modulus, bulk_modulus
        mesh = MeshQuad.init_tensor(
            np.linspace(0.0, radius, elements[0] + 1), np.linspace(0.0, 0.5 * height, elements[1] + 1)
        )
        basis = Basis(mesh, ElementQuad2(), intorder=_ORDER)
        self._nodes, self._element_nodes = basis.doflocs, basis.element_dofs
        self._gradient, self._weight, self._linear = _gradients(basis)
        self._mass = np.linalg.inv(np.einsum("eq,qi,qj->eij", self._weight, self._linear, self._linear))
        self._material = Material(law=law, shear_modulus=shear_modulus, isochoric_share=1.0, bulk_modulus=0.0)
        self._unknowns = np.concatenate([2 * self._element_nodes, 2 * self._element_nodes + 1]).T
        r, z = self._nodes
        small = 1e-9 * min(radius, height)
        self._top, side = z > 0.5 * height - small, r > radius - small
        self._side = np.flatnonzero(side & ~self._top)
        self._spring = _SPRING * shear_modulus * radius / len(self._side)
        held = np.zeros((len(r), 2), dtype=bool)
        held[r < small, 0] = True
        held[z < small, 1] = True
        held[self._top, 1] = True
        held[self._top, 0] |= bonded
        order = np.lexsort((r, z))
        places = (2 * order[:, None] + np.arange(2)).ravel()
        self._free = places[~held.ravel()[places]]

    def press(self, strains: FloatArray) -> PlatenCurve:
        """Press as far as asked, or as far as an equilibrium is found.

        Args:
            strains: compressions over height at which the force is wanted [1], ascending, between 0 and 1.

        Raises:
            InputError: they are not ascending or not between 0 and 1.
        """
        if (np.diff(strains) <= 0).any() or not 0 <= strains[0] <= strains[-1] < 1:
            raise InputError("cylinder: strains", "ascending numbers from 0 to below 1", list(strains))
        field, reached = np.zeros(2 * len(self._nodes[0])), 0.0
        before: tuple[float, FloatArray] | None = None
        done: list[tuple[float, float, float]] = []  # strain, force, past
        step = _LONGEST
        directions = Directions("superlu", reuse=False)
        for aim in strains:
            while reached < aim:
                near = min(reached + step, aim) if aim - reached > 1.001 * step else aim
                slope = None if before is None else (field - before[1]) / (reached - before[0])
                try:
                    found = self._balanced(field, near - reached, near, slope, directions)
                except NewtonError as error:
                    step *= 0.5
                    if step < _SHORTEST:
                        return _curve(done, error.reason)
                    continue
                before, field, reached = (reached, field), found, near
                step = min(_LONGEST, 1.5 * step)
            past = float(self._past(field, aim).max()) / self.height
            done.append((float(aim), self._platen_force(field, aim), past))
        return _curve(done, "")

    @cached_property
    def linear_stiffness(self) -> float:
        """Force over compression as both become small [N/m]: what a linear model has at every compression."""
        rest = np.zeros(2 * len(self._nodes[0]))
        matrix = self._stiffness(rest)
        moved = np.zeros_like(rest)
        moved[2 * np.flatnonzero(self._top) + 1] = -0.5 * self.height
        right = -(matrix @ moved)
        directions = Directions("superlu")
        moved[self._free] = directions.solve(matrix[self._free][:, self._free], right[self._free])
        top = 2 * np.flatnonzero(self._top) + 1
        return float(-(matrix @ moved)[top].sum() / self.height)

    def _balanced(
        self,
        field: FloatArray,
        change: float,
        strain: float,
        slope: FloatArray | None,
        directions: Directions,
    ) -> FloatArray:
        start = field + slope * change if slope is not None else self._squeezed(field, strain)
        start[2 * np.flatnonzero(self._top) + 1] = -0.5 * self.height * strain
        scale = self._mu * self.radius**2 * max(strain, 0.01)
        equations = _Pressed(self, start, strain)
        found = balance(
            equations, start[self._free], scale=scale, tolerance=_TOLERANCE, directions=directions
        )
        return equations.spread(found.unknowns)

    def _squeezed(self, field: FloatArray, strain: float) -> FloatArray:
        """Return a first guess: what is there, pressed on evenly at constant volume."""
        moved = field.copy()
        extra = strain + 2 * field[2 * np.flatnonzero(self._top)[0] + 1] / self.height
        moved[1::2] -= extra * self._nodes[1]
        free = np.zeros(len(field), dtype=bool)
        free[self._free] = True
        radial = np.where(free[::2], 0.5 * extra * self._nodes[0], 0.0)
        moved[::2] += radial
        return moved

    def _platen_force(self, field: FloatArray, strain: float) -> float:
        forces = self._forces(field)
        top = 2 * np.flatnonzero(self._top) + 1
        return float(-forces[top].sum() + self._spring * self._past(field, strain).sum())

    def _past(self, field: FloatArray, strain: float) -> FloatArray:
        """Return how far nodes of the side are past the platen [m], 0 for those that are not."""
        height = self._nodes[1, self._side] + field[2 * self._side + 1]
        return np.asarray(np.maximum(height - 0.5 * self.height * (1 - strain), 0.0))

    def _deformation(self, field: FloatArray) -> FloatArray:
        local = field[self._unknowns]
        gradient = (self._gradient @ local[:, None, :, None])[..., 0] + _UNIT
        result: FloatArray = gradient.reshape(-1, 3, 3)
        volume = np.linalg.det(result)
        if not (volume > 0).all():
            worst = int(np.argmin(volume)) // self._weight.shape[1]
            raise InversionError(worst, "an element turned inside out")
        return result

    def _dilatation(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return K t [Pa], shape (e, q), d2J/dF2, shape (e, q, 9, 9), and its K (linear part, unknowns), (e, 3, 18)."""
        flat = gradient.reshape(*self._weight.shape, 9)
        second = (flat.reshape(-1, 9) @ _CROSS).reshape(*self._weight.shape, 9, 9)
        cofactor = 0.5 * (second @ flat[..., None])[..., 0]
        volume = np.einsum("eqf,eqf->eq", cofactor, flat) / 3.0
        moments = np.einsum("eq,qi,eq->ei", self._weight, self._linear, volume - 1.0)
        pressure = self._bulk * (np.einsum("eij,ej->ei", self._mass, moments) @ self._linear.T)
        slope = (cofactor[:, :, None, :] @ self._gradient)[:, :, 0]
        change = np.einsum("eq,qi,eqa->eia", self._weight, self._linear, slope, optimize=True)
        return pressure, second, change

    def _forces(self, field: FloatArray) -> FloatArray:
        gradient = self._deformation(field)
        stress, _ = self._material.second_piola(gradient, tangent=False)
        nominal = first_piola(gradient, stress).reshape(*self._weight.shape, 9)
        pressure, second, _ = self._dilatation(gradient)
        flat = gradient.reshape(*self._weight.shape, 9)
        nominal += 0.5 * pressure[..., None] * (second @ flat[..., None])[..., 0]
        local = ((self._weight[..., None] * nominal)[:, :, None, :] @ self._gradient).sum(axis=(1, 2))
        return np.bincount(self._unknowns.ravel(), local.ravel(), minlength=len(field)).astype(np.float64)

    def _stiffness(self, field: FloatArray) -> sp.csr_array:
        gradient = self._deformation(field)
        stress, moduli = self._material.second_piola(gradient, tangent=True)
        assert moduli is not None
        tangent = nominal_moduli(gradient, stress, moduli).reshape(*self._weight.shape, 9, 9)
        pressure, second, change = self._dilatation(gradient)
        tangent += pressure[..., None, None] * second
        count, points = self._weight.shape
        weighted = (self._weight[:, :, None, None] * (tangent @ self._gradient)).reshape(
            count, 9 * points, -1
        )
        local = self._gradient.reshape(count, 9 * points, -1).transpose(0, 2, 1) @ weighted
        local += self._bulk * (change.transpose(0, 2, 1) @ self._mass @ change)
        rows = np.broadcast_to(self._unknowns[:, :, None], local.shape)
        columns = np.broadcast_to(self._unknowns[:, None, :], local.shape)
        places = (rows.ravel(), columns.ravel())
        return sp.csr_array(sp.coo_array((local.ravel(), places), shape=(len(field), len(field))))


class _Pressed:
    """The disc at one compression, as `newton` wants it."""

    def __init__(self, disc: Cylinder, field: FloatArray, strain: float) -> None:
        self._disc, self._field, self._strain = disc, field, strain

    def spread(self, unknowns: FloatArray) -> FloatArray:
        field = self._field.copy()
        field[self._disc._free] = unknowns
        return field

    def imbalance(self, unknowns: FloatArray) -> FloatArray:
        disc, field = self._disc, self.spread(unknowns)
        forces = disc._forces(field)
        forces[2 * disc._side + 1] += disc._spring * disc._past(field, self._strain)
        return np.asarray(forces[disc._free])

    def tangent(self, unknowns: FloatArray) -> sp.csr_array:
        disc, field = self._disc, self.spread(unknowns)
        matrix = disc._stiffness(field)
        touching = 2 * disc._side[disc._past(field, self._strain) > 0] + 1
        if touching.size:
            springs = np.zeros(len(field))
            springs[touching] = disc._spring
            matrix = sp.csr_array(matrix + sp.diags_array(springs))
        return sp.csr_array(matrix[disc._free][:, disc._free])


def _curve(done: list[tuple[float, float, float]], stopped: str) -> PlatenCurve:
    strain, force, past = np.array(done).reshape(-1, 3).T
    return PlatenCurve(strain=strain, force=force, past=past, stopped=stopped)


def _gradients(basis: Basis) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return dF/du, shape (e, q, 9, 18), weights [m3], (e, q), and 1 and the local places, (q, 3)."""
    radius = np.asarray(basis.global_coordinates())[0]
    count = len(basis.basis)
    made = np.zeros((*radius.shape, 9, 2 * count))
    for node, (shape,) in enumerate(basis.basis):
        made[:, :, 0, node] = shape.grad[0]
        made[:, :, 2, node] = shape.grad[1]
        made[:, :, 4, node] = np.asarray(shape) / radius
        made[:, :, 6, count + node] = shape.grad[0]
        made[:, :, 8, count + node] = shape.grad[1]
    local = np.vstack([np.ones(basis.X.shape[1]), 2 * basis.X - 1]).T
    return made, 2 * np.pi * radius * basis.dx, local


def _cross() -> FloatArray:
    """Return d2J/dF_iJ dF_kL by F_mN, the product of two permutation symbols, shape (9, 81)."""
    sign = np.zeros((3, 3, 3))
    for i in range(3):
        sign[i, (i + 1) % 3, (i + 2) % 3], sign[i, (i + 2) % 3, (i + 1) % 3] = 1.0, -1.0
    return np.asarray(np.einsum("ikm,jln->mnijkl", sign, sign).reshape(9, 81))


_CROSS = _cross()
