"""What the tissue bears: von Mises stress, stretches, and the nominal strain through each layer."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from trocar.model import FloatArray
from trocar.reference.deformed import deformation_gradient
from trocar.reference.hyperelastic import Material, as_matrix
from trocar.reference.mesh import REDUCED_ORDER, Bricks, shape_functions
from trocar.tissues import Layer


def largest_von_mises(
    bricks: Bricks, layers: tuple[Layer, ...], fields: list[FloatArray], *, prestress: bool
) -> list[float]:
    """Return the largest von Mises stress of each layer [Pa].

    It is taken at the 2 x 2 x 2 Gauss points of the elements, where stresses of this element are most
    accurate (Barlow 1976, Int. J. Numer. Methods Eng. 10:243). It is not extrapolated to the faces; the peak
    under the rim of a flat tool, where the linear stress has no bound, grows as the mesh is refined.

    Args:
        bricks: the mesh.
        layers: top first.
        fields: displacements of the nodes [m], each of shape (3, nodes); the largest over all of them is
            returned.
        prestress: whether the layers' prestress is part of the stress.
    """
    gradients = shape_functions(bricks.gauss_rule(REDUCED_ORDER)[0])[1]
    largest = [0.0] * len(layers)
    for field in fields:
        for number, layer in enumerate(layers):
            here = bricks.element_layer == number
            local = np.einsum(
                "iae,akq->ikeq", field[:, bricks.element_nodes[:, here]], gradients, optimize=True
            )
            strain = local / bricks.edges[None, :, here, None]
            strain = 0.5 * (strain + strain.transpose(1, 0, 2, 3))
            stress = 2.0 * layer.shear_modulus * strain
            dilatation = np.einsum("iieq->eq", strain)
            for axis, tension in enumerate((layer.prestress_x, layer.prestress_y, 0.0)):
                stress[axis, axis] += layer.lame_lambda * dilatation + (tension if prestress else 0.0)
            deviator = stress - np.einsum("iieq->eq", stress) / 3.0 * np.eye(3)[:, :, None, None]
            peak = float(np.einsum("ikeq,ikeq->eq", deviator, deviator).max())
            largest[number] = max(largest[number], sqrt(1.5 * peak))
    return largest


def largest_cauchy_mises(
    bricks: Bricks, layers: tuple[Layer, ...], fields: list[FloatArray], *, prestress: bool
) -> list[float]:
    """Return the largest von Mises stress of each hyperelastic layer [Pa]: of the Cauchy stress F S F^T / J.

    Places and arguments are those of `largest_von_mises`.
    """
    largest = []
    for number, layer in enumerate(layers):
        material = Material(
            law=layer.law,
            shear_modulus=layer.shear_modulus,
            isochoric_share=1.0,
            bulk_modulus=layer.bulk_modulus,
            prestress=(layer.prestress_x, layer.prestress_y) if prestress else (0.0, 0.0),
        )
        peak = 0.0
        for gradient in _gradients(bricks, number, fields):
            second = as_matrix(material.second_piola(gradient, tangent=False)[0])
            stress = gradient @ second @ gradient.transpose(0, 2, 1) / np.linalg.det(gradient)[:, None, None]
            deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
            peak = max(peak, float(np.einsum("nij,nij->n", deviator, deviator).max()))
        largest.append(sqrt(1.5 * peak))
    return largest


@dataclass(frozen=True, kw_only=True)
class Deformation:
    """How far a layer is deformed at the points of the quadrature.

    Args:
        stretch: smallest and largest principal stretch [1].
        volume_ratio: smallest and largest determinant of the deformation gradient [1]; 0 or less cannot exist.
    """

    stretch: tuple[float, float]
    volume_ratio: tuple[float, float]

    @classmethod
    def of(cls, gradient: FloatArray) -> Deformation:
        """Return what deformation gradients, shape (n, 3, 3), amount to."""
        stretch = np.linalg.svd(gradient, compute_uv=False)
        volume = np.linalg.det(gradient)
        return cls(
            stretch=(float(stretch.min()), float(stretch.max())),
            volume_ratio=(float(volume.min()), float(volume.max())),
        )


def deformations(bricks: Bricks, layers: tuple[Layer, ...], fields: list[FloatArray]) -> list[Deformation]:
    """Return how far each layer is deformed; arguments as in `largest_von_mises`."""
    return [
        Deformation.of(np.concatenate(_gradients(bricks, number, fields))) for number in range(len(layers))
    ]


def _gradients(bricks: Bricks, layer: int, fields: list[FloatArray]) -> list[FloatArray]:
    slopes = shape_functions(bricks.gauss_rule(REDUCED_ORDER)[0])[1]
    here = np.flatnonzero(bricks.element_layer == layer)
    return [deformation_gradient(bricks, field, here, slopes).reshape(-1, 3, 3) for field in fields]


def largest_compression(bricks: Bricks, layers: tuple[Layer, ...], fields: list[FloatArray]) -> list[float]:
    """Return the largest share of its thickness that each layer loses anywhere [1].

    It is the approach of the layer's two faces along z at the nodes of the mesh, over the thickness.

    Args:
        bricks: the mesh.
        layers: top first.
        fields: displacements of the nodes [m], each of shape (3, nodes).
    """
    largest = []
    for number, layer in enumerate(layers):
        slabs = np.flatnonzero(bricks.slab_layer == number)
        lower, upper = (_face_nodes(bricks, line) for line in (slabs[0], slabs[-1] + 1))
        approach = max(float((field[2, lower] - field[2, upper]).max()) for field in fields)
        largest.append(max(0.0, approach / layer.thickness))
    return largest


def _face_nodes(bricks: Bricks, line: int) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    x, y, z = bricks.nodes
    nodes = np.flatnonzero(np.abs(z - bricks.z[line]) < 1e-6 * np.diff(bricks.z).min())
    return nodes[np.lexsort((y[nodes], x[nodes]))]
