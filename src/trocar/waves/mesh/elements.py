"""Quadratic finite elements on a solid mesh: matrices, what is held, and places on its surfaces.

Tetrahedra have ten nodes, hexahedra twenty (scikit-fem's `ElementTetP2` and `ElementHexS2`); edges stay straight. With
G_ij = integral of c dN_a/dx_i dN_b/dx_j,

    K_ij = G_ij(lambda) + G_ji(mu) + delta_ij sum over k of G_kk(mu + sigma_k)

for prestress sigma (Zienkiewicz and Taylor 2000, vol. 2, the initial-stress matrix). Hexahedra take lambda at the
2 x 2 x 2 Gauss points, without which they lock near incompressibility, and mu nine tenths there and one tenth exactly,
without which some of their modes have no energy. Tetrahedra take all exactly.

Component i of node n is unknown i * nodes + n.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementHexS2, ElementTetP2, FacetBasis, MeshHex, MeshTet

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.waves.mesh.solid_mesh import IntArray, SolidMesh

_TO_SKFEM = [6, 2, 5, 7, 1, 3, 4, 0]  # its corners of a hexahedron among VTK's
_EXACT_SHARE = 0.1  # of mu, in hexahedra
_GAUSS, _EXACT = {4: (2, 2), 8: (3, 5)}, {4: 4, 8: 5}  # orders: of K (reduced, exact), and of M
_CHUNK = 256  # points located at a time


class Elements:
    """Make finite elements of a mesh.

    Args:
        mesh: of straight elements.
    """

    def __init__(self, mesh: SolidMesh) -> None:
        self.mesh = mesh
        self._corners = mesh.cells.shape[1]
        if self._corners == 4:
            self._skfem, self._element = MeshTet(_columns(mesh.corners), _columns(mesh.cells)), ElementTetP2()
        else:
            cells = _columns(mesh.cells[:, _TO_SKFEM])
            self._skfem, self._element = MeshHex(_columns(mesh.corners), cells), ElementHexS2()

    @cached_property
    def _basis(self) -> Basis:
        return Basis(self._skfem, self._element, intorder=_GAUSS[self._corners][0])

    @cached_property
    def nodes(self) -> FloatArray:
        """Places of all nodes, corners and middles of edges [m], shape (3, n)."""
        return np.asarray(self._basis.doflocs, dtype=np.float64)

    @cached_property
    def held(self) -> np.ndarray:
        """Which displacement components are zero, shape (3, n)."""
        held = np.zeros(self.nodes.shape, dtype=bool)
        for one in self.mesh.held:
            nodes = self._basis.get_dofs(self._numbers(one.faces)).all()
            for component in np.flatnonzero(one.along):
                held[component, nodes] = True
        return held

    def stiffness(self) -> sp.csr_array:
        """Return the stiffness [N/m], prestress included, shape (3n, 3n)."""
        return self._elastic(lambda layer: 1.0, prestressed=True)

    def damping(self) -> sp.csr_array:
        """Return the Kelvin-Voigt damping [N s/m]: each material's elastic stiffness times its retardation time."""
        return self._elastic(lambda layer: layer.retardation_time, prestressed=False)

    def remembered(self, time: float) -> sp.csr_array:
        """Return the stiffness of the branches of a relaxation time [s]: each material's times its weight [N/m]."""
        return self._elastic(lambda layer: layer.relaxing(time), prestressed=False)

    def mass(self) -> sp.csr_array:
        """Return the consistent mass [kg]."""
        basis = Basis(self._skfem, self._element, intorder=_EXACT[self._corners])
        density = self._of_elements(lambda layer: layer.density)
        one = BilinearForm(lambda u, v, w: w.c * u * v).assemble(basis, c=_everywhere(density, basis))
        return sp.csr_array(sp.block_diag([one] * 3, format="csr"))

    def at(self, surface: str, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the nodes around points of a surface, seen from above, and their shape functions there.

        Args:
            surface: its name.
            points: only x and y are used [m], shape (n, 2) or (n, 3).

        Returns:
            Nodes and weights, both of shape (k, n); a field's value is sum(field[nodes] * weights).

        Raises:
            InputError: a point is beside the surface.
        """
        places, triangle = self._dropped(surface, points)
        _, faces = self._seen(surface)
        cells = self._skfem.f2t[0, faces[triangle]]
        local = self._basis.mapping.invF(places.T[:, :, None], tind=cells)[:, :, 0]
        shapes = [self._element.lbasis(local, i)[0] for i in range(len(self._basis.element_dofs))]
        return np.asarray(self._basis.element_dofs[:, cells], dtype=np.int64), np.asarray(shapes)

    def seen(self, surface: str, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return where points lie on a surface, seen from above, and its unit normals there.

        Args:
            surface: its name.
            points: only x and y are used [m], shape (n, 2) or (n, 3).

        Returns:
            Places [m] and normals, both of shape (n, 3); normals look up.

        Raises:
            InputError: a point is beside the surface.
        """
        places, triangle = self._dropped(surface, points)
        a, b, c = np.moveaxis(self.mesh.corners[self._seen(surface)[0][triangle]], 1, 0)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return places, normal * np.sign(normal[:, 2:])

    def heights(self, surface: str, points: FloatArray) -> FloatArray:
        """Return the heights [m] of a surface at points, seen from above, and NaN beside it; (n, >= 2) to (n,)."""
        places, which = _dropped(self.mesh.corners[self._seen(surface)[0]], np.asarray(points)[:, :2])
        return np.where(which >= 0, places[:, 2], np.nan)

    def facets(self, surface: str, order: int) -> FacetBasis:
        """Return scikit-fem's basis on a surface, its rule exact for polynomials of an order."""
        faces = np.unique(self._numbers(self.mesh.surfaces[surface]))
        return FacetBasis(self._skfem, self._element, facets=faces, intorder=order)

    def _dropped(self, surface: str, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return where points fall on a surface, and on which of its triangles."""
        triangles, _ = self._seen(surface)
        places, which = _dropped(self.mesh.corners[triangles], np.asarray(points)[:, :2])
        if (which < 0).any():
            lost = 1e3 * np.asarray(points)[int(np.argmax(which < 0)), :2]
            x, y = (1e3 * side for side in self.mesh.size)
            raise InputError(
                f"point on {surface}",
                f"a place over the surface, whose mesh is {x:.6g} x {y:.6g} mm",
                f"{lost[0]:.6g}, {lost[1]:.6g} mm",
            )
        return places, which

    def _seen(self, surface: str) -> tuple[IntArray, IntArray]:
        """Return triangles that make up a surface, and the number of the face each is of."""
        corners = self.mesh.surfaces[surface]
        numbers = self._numbers(corners)
        if corners.shape[1] == 3:
            return corners, numbers
        return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]), np.tile(numbers, 2)

    def _numbers(self, faces: IntArray) -> IntArray:
        """Return scikit-fem's numbers of faces given by their corners."""
        known = np.sort(self._skfem.facets.T, axis=1)
        wanted = np.sort(faces, axis=1)
        _, place = np.unique(np.concatenate([known, wanted]), axis=0, return_inverse=True)
        place = place.ravel()
        number = np.full(place.max() + 1, -1)
        number[place[: len(known)]] = np.arange(len(known))
        found = number[place[len(known) :]]
        if (found < 0).any():
            raise InputError(
                "mesh: faces", "corners of an element's face", wanted[int(np.argmax(found < 0))].tolist()
            )
        return np.asarray(found, dtype=np.int64)

    def _of_elements(self, of: Callable[[Layer], float]) -> FloatArray:
        return np.array([of(layer) for layer in self.mesh.materials])[self.mesh.region]

    def _elastic(self, times: Callable[[Layer], float], *, prestressed: bool) -> sp.csr_array:
        lame = self._of_elements(lambda layer: times(layer) * layer.lame_lambda)
        shear = self._of_elements(lambda layer: times(layer) * layer.shear_modulus)
        pulls = [
            self._of_elements(lambda layer, name=name: times(layer) * getattr(layer, name))  # type: ignore[misc]
            for name in ("prestress_x", "prestress_y")
        ]
        reduced, exact = (Basis(self._skfem, self._element, intorder=o) for o in _GAUSS[self._corners])
        share = _EXACT_SHARE if self._corners == 8 else 1.0
        volume = {(i, j): _gradients(reduced, lame, i, j) for i in range(3) for j in range(i, 3)}
        sheared = {}
        for i in range(3):
            for j in range(i, 3):
                sheared[i, j] = share * _gradients(exact, shear, i, j)
                if share < 1:
                    sheared[i, j] = sheared[i, j] + (1 - share) * _gradients(reduced, shear, i, j)
        along = sheared[0, 0] + sheared[1, 1] + sheared[2, 2]
        for axis, pull in enumerate(pulls):
            if prestressed and pull.any():
                along = along + _gradients(exact, pull, axis, axis)

        def block(i: int, j: int) -> sp.csr_array:
            if i > j:
                return sp.csr_array(block(j, i).T)
            found = volume[i, j] + sheared[i, j].T
            return sp.csr_array(found + along if i == j else found)

        rows = [[block(i, j) for j in range(3)] for i in range(3)]
        return sp.csr_array(sp.block_array(rows, format="csr"))


def _columns(rows: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(rows.T)


def _gradients(basis: Basis, coefficient: FloatArray, i: int, j: int) -> sp.csr_array:
    """Return G_ij: rows dN_a/dx_i, columns dN_b/dx_j."""
    form = BilinearForm(lambda u, v, w: w.c * v.grad[i] * u.grad[j])
    return sp.csr_array(form.assemble(basis, c=_everywhere(coefficient, basis)))


def _everywhere(values: FloatArray, basis: Basis) -> FloatArray:
    """Return a value of each element at each of its points of quadrature."""
    return np.repeat(values[:, None], basis.dx.shape[1], axis=1)


def _dropped(triangles: FloatArray, points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return where points fall on triangles from above, shape (n, 3), and on which; -1 where on none.

    Args:
        triangles: their corners [m], shape (k, 3, 3).
        points: x and y [m], shape (n, 2).
    """
    first, second, third = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    one, other = (second - first)[:, :2], (third - first)[:, :2]
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    steep = np.abs(area) <= 1e-12 * np.abs(area).max()
    area = np.where(steep, 1.0, area)
    slack = 1e-9
    places, which = np.zeros((len(points), 3)), np.full(len(points), -1)
    for begin in range(0, len(points), _CHUNK):
        here = points[begin : begin + _CHUNK, None] - first[:, :2]
        s = (here[..., 0] * other[:, 1] - here[..., 1] * other[:, 0]) / area
        t = (one[:, 0] * here[..., 1] - one[:, 1] * here[..., 0]) / area
        inside = (s >= -slack) & (t >= -slack) & (s + t <= 1 + slack) & ~steep
        height = first[:, 2] + s * (second - first)[:, 2] + t * (third - first)[:, 2]
        best = np.argmax(np.where(inside, height, -np.inf), axis=1)
        rows = np.arange(len(best))
        which[begin : begin + _CHUNK] = np.where(inside[rows, best], best, -1)
        places[begin : begin + _CHUNK, 2] = height[rows, best]
    places[:, :2] = points
    return places, np.asarray(which, dtype=np.int64)
