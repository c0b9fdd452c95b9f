"""Forces, tangent stiffness, energy and damping of bricks that deform much: the total Lagrangian form.

With F = I + du/dX at a Gauss point, X the place at rest, P = dW/dF and A = dP/dF (`hyperelastic`), the nodal forces and
their derivative are sums of w P_iJ dN_a/dX_J and w dN_a/dX_J A_iJkL dN_b/dX_L (T. Belytschko, W. K. Liu and B. Moran
2000, Nonlinear Finite Elements, sec. 4.9 and 6.4). The bricks are those of `assembly` and so is the quadrature, term by
term, with K/2 (J - 1)^2 = lambda/2 (J - 1)^2 + mu/3 (J - 1)^2:

* lambda/2 (J - 1)^2 at the 2 x 2 x 2 points alone, without which the brick locks near incompressibility;
* W_iso + mu/3 (J - 1)^2 and the prestress nine tenths there and a tenth at the 3 x 3 x 3 points, so that no mode is
  without energy and no point of the element may turn inside out.

At rest the tangent is the linear stiffness, prestress included, to the last bit but rounding.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp

from trocar.errors import TrocarError
from trocar.model import FloatArray
from trocar.reference.assembly import STABILISATION
from trocar.reference.grid import IntArray
from trocar.reference.hyperelastic import COLUMN, ROW, Material, first_piola, nominal_moduli
from trocar.reference.mesh import EXACT_ORDER, REDUCED_ORDER, Bricks, shape_functions
from trocar.tissues import Layer

_BATCH = 96  # elements at a time: their tangents fill 60 MB
_UNIT = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])


class InversionError(TrocarError):
    """A trial displacement that no tissue can have.

    Args:
        element: the one that turned inside out, or whose stress overflowed.
        reason: what happened to it.
    """

    def __init__(self, element: int, reason: str) -> None:
        self.element = element
        self.reason = reason
        super().__init__(reason)


class DeformedBricks:
    """A mesh of hyperelastic layers.

    Args:
        bricks: the mesh.
        layers: top first, none of them linear.
        free: the unknowns that may move, in the order to eliminate them in.
    """

    def __init__(self, bricks: Bricks, layers: tuple[Layer, ...], free: IntArray) -> None:
        self.bricks = bricks
        self.layers = layers
        self.free = free
        rules = [(order, bricks.gauss_rule(order)) for order in (REDUCED_ORDER, EXACT_ORDER)]
        self._gradients = np.concatenate([shape_functions(rule[0])[1] for _, rule in rules], axis=2)
        self._weights = np.concatenate([rule[1] for _, rule in rules])
        reduced = np.concatenate([np.full(len(rule[1]), order == REDUCED_ORDER) for order, rule in rules])
        self._share = np.where(reduced, 1.0 - STABILISATION, STABILISATION)
        self._reduced = reduced.astype(np.float64)

    def forces(self, field: FloatArray) -> FloatArray:
        """Return the nodal forces [N] that hold a displacement [m], both of shape (3, nodes).

        Raises:
            InversionError: an element is inside out.
        """
        return self._integrate(field, tangent=False)[0]

    def stiffness(self, field: FloatArray) -> sp.csr_array:
        """Return the derivative of the free forces by the free unknowns [N/m].

        Raises:
            InversionError: an element is inside out.
        """
        return self._integrate(field, tangent=True)[1]

    def convex(self, field: FloatArray) -> None:
        """Return None: an equilibrium that is not stable is left to whoever asked."""

    def energy(self, field: FloatArray) -> float:
        """Return what the layers and their prestress store [J].

        Raises:
            InversionError: an element is inside out.
        """
        total = 0.0
        for layer, elements in self._batches():
            gradient = self._gradient(field, elements)
            density = self._material(layer, len(elements)).energy(gradient.reshape(-1, 3, 3))
            total += float(np.einsum("eq,eq->", density.reshape(len(elements), -1), self._measure(elements)))
        return total

    def smallest_stretch(self, field: FloatArray) -> FloatArray:
        """Return the smallest principal stretch in each element [1], shape (elements,)."""
        gradient = self._slopes(field, np.arange(len(self.bricks.element_layer)))
        return np.asarray(np.linalg.svd(gradient, compute_uv=False).min(axis=(1, 2)))

    def damping(self, field: FloatArray) -> sp.csr_array:
        """Return the Kelvin-Voigt damping [N s/m] about a displacement [m], between the free unknowns.

        The viscous second Piola-Kirchhoff stress is tau (lambda tr(E') I + 2 mu E') with E' the rate of Green's strain,
        so that turning costs nothing; at rest this is the linear model's.
        """
        data = np.zeros(self._pattern[1])
        for layer, elements in self._batches():
            gradient = self._slopes(field, elements).reshape(-1, 3, 3)
            self._add(data, nominal_moduli(gradient, None, self._viscosity(layer, len(elements))), elements)
        return self._matrix(data)

    def viscous_forces(self, field: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return the nodal forces [N] of that damping, shape (3, nodes), held nodes too.

        Args:
            field: displacement [m], shape (3, nodes).
            velocity: [m/s], shape (3, nodes).
        """
        forces = np.zeros(self.bricks.nodes.shape)
        for layer, elements in self._batches():
            gradient = self._slopes(field, elements).reshape(-1, 3, 3)
            rate = self._slopes(velocity, elements).reshape(-1, 3, 3) - np.eye(3)
            strain = gradient.transpose(0, 2, 1) @ rate
            flat = (strain + strain.transpose(0, 2, 1))[:, ROW, COLUMN] * np.where(_UNIT, 0.5, 1.0)
            stress = np.einsum("nij,nj->ni", self._viscosity(layer, len(elements)), flat)
            self._pour(forces, first_piola(gradient, stress), elements)
        return forces

    def _viscosity(self, layer: Layer, elements: int) -> FloatArray:
        """Return the viscous moduli [Pa s] at the points of so many elements, shape (n, 6, 6)."""
        lame, shear = (
            layer.retardation_time * np.tile(modulus * share, elements)
            for modulus, share in ((layer.lame_lambda, self._reduced), (layer.shear_modulus, self._share))
        )
        volumetric = lame[:, None, None] * np.outer(_UNIT, _UNIT)
        return np.asarray(volumetric + shear[:, None, None] * np.diag(1.0 + _UNIT))

    def _integrate(self, field: FloatArray, *, tangent: bool) -> tuple[FloatArray, sp.csr_array]:
        forces = np.zeros(self.bricks.nodes.shape)
        data = np.zeros(self._pattern[1]) if tangent else np.zeros(0)
        for layer, elements in self._batches():
            gradient = self._gradient(field, elements).reshape(-1, 3, 3)
            with np.errstate(over="ignore", invalid="ignore"):  # an exponential law overflows: refused below
                material = self._material(layer, len(elements))
                stress, moduli = material.second_piola(gradient, tangent=tangent)
                nominal = first_piola(gradient, stress)
            finite = np.isfinite(nominal).all(axis=(1, 2)).reshape(len(elements), -1).all(axis=1)
            if not finite.all():
                raise InversionError(
                    int(elements[int(np.argmin(finite))]), "its stress grew beyond any number"
                )
            self._pour(forces, nominal, elements)
            if moduli is not None:
                self._add(data, nominal_moduli(gradient, stress, moduli), elements)
        return forces, self._matrix(data) if tangent else sp.csr_array((0, 0))

    def _pour(self, forces: FloatArray, nominal: FloatArray, elements: IntArray) -> None:
        """Add the forces of first Piola-Kirchhoff stresses [Pa], shape (e q, 3, 3), at the elements' nodes."""
        scale = self._measure(elements)[:, :, None, None] / self._edges(elements)[:, None, None, :]
        scaled = nominal.reshape(len(elements), -1, 3, 3) * scale
        local = np.einsum("eqij,ajq->iae", scaled, self._gradients, optimize=True)
        nodes = self.bricks.element_nodes[:, elements].ravel()
        for axis in range(3):
            forces[axis] += np.bincount(nodes, local[axis].ravel(), minlength=forces.shape[1])

    def _add(self, data: FloatArray, moduli: FloatArray, elements: IntArray) -> None:
        """Add the elements' stiffness to the entries of the matrix; moduli of shape (e q, 9, 9)."""
        count, points = len(elements), len(self._weights)
        edges = self._edges(elements)
        scale = self._measure(elements)[:, :, None, None] / (edges[:, :, None] * edges[:, None, :])[:, None]
        split = moduli.reshape(count, points, 3, 3, 3, 3) * scale[:, :, None, :, None, :]
        rows = split.transpose(0, 2, 4, 1, 3, 5).reshape(9 * count, 9 * points)  # e i k by q J L
        entries = (rows @ self._products).reshape(count, 3, 3, 20, 20).transpose(0, 1, 3, 2, 4)
        data += np.bincount(self._pattern[0][elements].ravel(), entries.ravel(), minlength=len(data) + 1)[:-1]

    def _matrix(self, data: FloatArray) -> sp.csr_array:
        _, _, columns, starts = self._pattern
        return sp.csr_array((data, columns, starts), shape=(len(self.free), len(self.free)))

    def _slopes(self, field: FloatArray, elements: IntArray) -> FloatArray:
        return deformation_gradient(self.bricks, field, elements, self._gradients)

    def _gradient(self, field: FloatArray, elements: IntArray) -> FloatArray:
        """Return F at the elements' points, shape (e, q, 3, 3), each of positive determinant."""
        gradient = self._slopes(field, elements)
        volume = np.linalg.det(gradient).min(axis=1)
        if not volume.min() > 0:
            raise InversionError(int(elements[int(np.argmin(volume))]), "it turned inside out")
        return gradient

    def _material(self, layer: Layer, elements: int) -> Material:
        bulk = self._reduced * layer.lame_lambda + self._share * (2 / 3) * layer.shear_modulus
        return Material(
            law=layer.law,
            shear_modulus=layer.shear_modulus,
            isochoric_share=np.tile(self._share, elements),
            bulk_modulus=np.tile(bulk, elements),
            prestress=(layer.prestress_x, layer.prestress_y),
        )

    def _batches(self) -> list[tuple[Layer, IntArray]]:
        found = []
        for number, layer in enumerate(self.layers):
            here = np.flatnonzero(self.bricks.element_layer == number)
            found += [(layer, here[start : start + _BATCH]) for start in range(0, len(here), _BATCH)]
        return found

    @cached_property
    def _volume(self) -> FloatArray:
        return np.asarray(self.bricks.edges.prod(axis=0))

    def _edges(self, elements: IntArray) -> FloatArray:
        return self.bricks.edges[:, elements].T

    def _measure(self, elements: IntArray) -> FloatArray:
        return np.outer(self._volume[elements], self._weights)

    @cached_property
    def _products(self) -> FloatArray:
        """Products of the gradients of two shape functions, shape (q J L, a b)."""
        gradients = self._gradients
        product: FloatArray = np.einsum("ajq,blq->qjlab", gradients, gradients)
        return product.reshape(-1, 400)

    @cached_property
    def _pattern(self) -> tuple[IntArray, int, IntArray, IntArray]:
        """Where each entry of each element goes: its place, shape (e, 60 60), number of places, columns, row starts."""
        count, size = self.bricks.nodes.shape[1], len(self.free)
        number = np.full(3 * count, -1, dtype=np.int64)
        number[self.free] = np.arange(size)
        unknowns = number[
            (np.arange(3)[:, None] * count + self.bricks.element_nodes.T[:, None, :]).reshape(-1, 60)
        ]
        rows, columns = unknowns[:, :, None], unknowns[:, None, :]
        kept = (rows >= 0) & (columns >= 0)
        keys, place = np.unique((rows * size + columns)[kept], return_inverse=True)
        places = np.full(kept.shape, len(keys), dtype=np.int64)
        places[kept] = place
        starts = np.searchsorted(keys // size, np.arange(size + 1))
        return (
            places.reshape(len(places), -1),
            len(keys),
            (keys % size).astype(np.int32),
            starts.astype(np.int32),
        )


def deformation_gradient(
    bricks: Bricks, field: FloatArray, elements: IntArray, gradients: FloatArray
) -> FloatArray:
    """Return F = I + du/dX [1], shape (elements, q, 3, 3).

    Args:
        bricks: the mesh.
        field: displacements of the nodes [m], shape (3, nodes).
        elements: which.
        gradients: of the shape functions at q local places, shape (20, 3, q).
    """
    local = field[:, bricks.element_nodes[:, elements]].transpose(2, 0, 1) @ gradients.reshape(20, -1)
    slopes = local.reshape(len(elements), 3, 3, -1) / bricks.edges[:, elements].T[:, None, :, None]
    return np.asarray(slopes.transpose(0, 3, 1, 2) + np.eye(3))
