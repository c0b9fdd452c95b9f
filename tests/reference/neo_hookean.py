"""Large deformation of a layered block, by CalculiX, which nobody here wrote.

A quarter of a block pressed in the middle, in 20-node bricks with reduced integration (C3D20R), every layer a
compressible neo-Hookean solid

    W = C10 (I1_bar - 3) + (J - 1)^2 / D1,    C10 = mu / 2,  D1 = 2 / K

with the small-strain moduli of the layer, so that small forces give the linear answer. Prestress is an
initial second Piola-Kirchhoff stress; CalculiX ignores it in hyperelastic elements, so a second set
of elements on the same nodes carries it, with next to no stiffness of its own. The tool is a dead load: nodal
forces that keep direction and size, consistent with a uniform disc (CalculiX's own pressure would turn with
the surface). Mesh, forces and the reading of the result are made here and share nothing with
`trocar.reference`.

Lengths go to CalculiX in millimetres, forces in newtons and moduli in megapascals: it prints seven digits.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from pathlib import Path

import numpy as np

from trocar.model import Support
from trocar.tissues import Layer, Tissue
from trocar.units import MEGAPASCAL, MILLIMETRE

# C3D20 (CalculiX manual, sec. 6.2.8): corners of the lower face, of the upper face, middles of the lower
# edges, of the upper edges, of the upright edges, each anticlockwise seen from above. Coordinates -1 to 1.
_CORNERS = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
LOCAL_NODES = np.vstack([_CORNERS, [(_CORNERS[i] + _CORNERS[j]) // 2 for i, j in _EDGES]])

_NOTHING = 1e-7  # share of a layer's modulus given to the second set of elements that carries its prestress
_PRINTED_ROW = re.compile(r"^\s+(\d+)\s+(\S+)\s+(\S+)\s+(\S+)\s*$")


def executable() -> str | None:
    """Return the path of `ccx`, or None where there is none (Debian package calculix-ccx)."""
    return shutil.which("ccx")


@dataclass(frozen=True, kw_only=True)
class Pressed:
    """The block under one force.

    Args:
        force: of the tool [N].
        deflection: largest deflection of each layer's upper face [m], top first.
        stretch: smallest principal stretch at any Gauss point [1]; 0.3 is about where a neo-Hookean fit to
        soft
            tissue means nothing any more.
        height: smallest height of a layer over its thickness, at any node of its faces [1].
        volume_ratio: smallest and largest determinant of the deformation gradient [1].
    """

    force: float
    deflection: tuple[float, ...]
    stretch: float
    height: float
    volume_ratio: tuple[float, float]

    @property
    def sane(self) -> bool:
        """Whether the state can exist and the law is not stretched beyond reason."""
        return self.stretch > 0.3 and self.height > 0.3 and self.volume_ratio[0] > 0.8


@dataclass(frozen=True, kw_only=True)
class NeoHookeanBlock:
    """A block pressed in the middle by a flat tool.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        support: how the block is held.
        radius: of the tool [m].
        per_radius: elements along the radius; those below grow with depth in proportion.
    """

    tissue: Tissue
    size: tuple[float, float]
    support: Support
    radius: float
    per_radius: float = 2.0

    def pressed(self, forces: tuple[float, ...], folder: Path) -> list[Pressed]:
        """Press with ever larger forces [N] in one run; the list is shorter where CalculiX gave up.

        Args:
            forces: ascending, above 0.
            folder: to write into; must exist.
        """
        command = executable()
        assert command is not None, "CalculiX is missing (Debian package calculix-ccx)"
        (folder / "block.inp").write_text("\n".join(self._deck(forces)) + "\n")
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        run = subprocess.run(
            [command, "block"], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        steps = self._read((folder / "block.dat").read_text())[
            1:
        ]  # the first step only settles the prestress
        if len(steps) < len(forces) and "increment size smaller" not in run.stdout:
            raise RuntimeError(f"CalculiX failed: {run.stdout[-1500:]}{run.stderr}")
        return [self._measured(force, field) for force, field in zip(forces, steps, strict=False)]

    # The mesh

    @cached_property
    def _lines(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Grid lines of the quarter along x, y and z [mm]; the tool stands at the upper end of x and y."""
        radius = self.radius / MILLIMETRE
        fine = radius / self.per_radius
        sides = []
        for side in self.size:
            half, places, step = 0.5 * side / MILLIMETRE, [0.0], fine
            while places[-1] < half:
                step = fine if places[-1] < 1.2 * radius else 1.5 * step
                places.append(places[-1] + step)
            sides.append(half * (1.0 - np.array(places[::-1]) / places[-1]))
        z, upper = [0.0], 0.0
        for layer in self.tissue.layers:
            thickness, depth = layer.thickness / MILLIMETRE, -upper
            high = 0.7 / self.per_radius * (radius + depth + 0.5 * thickness)
            count = ceil(thickness / high)
            z += [upper - thickness * (i + 1) / count for i in range(count)]
            upper -= thickness
        return sides[0], sides[1], np.array(z[::-1])

    @cached_property
    def _lattice(self) -> tuple[np.ndarray, np.ndarray]:
        """Places of the nodes [mm], shape (n, 3), and nodes of the elements, shape (m, 20)."""
        x, y, z = self._lines
        counts = [len(line) - 1 for line in (x, y, z)]
        cells = np.stack(np.meshgrid(*(np.arange(c) for c in counts), indexing="ij"), axis=-1).reshape(-1, 3)
        twice = 2 * cells[:, None, :] + 1 + LOCAL_NODES
        shape = tuple(2 * c + 1 for c in counts)
        used, elements = np.unique(
            np.ravel_multi_index(tuple(np.moveaxis(twice, 2, 0)), shape), return_inverse=True
        )
        halves = [
            np.interp(np.arange(2 * len(line) - 1) / 2, np.arange(len(line)), line) for line in (x, y, z)
        ]
        places = [half[index] for half, index in zip(halves, np.unravel_index(used, shape), strict=True)]
        return np.stack(places, axis=1), elements.reshape(-1, 20)

    @property
    def dofs(self) -> int:
        """Displacement components of all nodes, the held ones too."""
        return int(self._lattice[0].size)

    @cached_property
    def _element_layer(self) -> np.ndarray:
        nodes, elements = self._lattice
        middle = nodes[elements, 2].mean(axis=1) * MILLIMETRE
        lower = -np.cumsum([layer.thickness for layer in self.tissue.layers])
        return np.searchsorted(-lower, -middle)

    def _held(self) -> np.ndarray:
        nodes = self._lattice[0]
        x, y, z = self._lines
        held = np.zeros(nodes.shape, dtype=bool)
        if self.support.base_held:
            held[nodes[:, 2] == z[0]] = True
        for axis, line in ((0, x), (1, y)):
            side = nodes[:, axis] == line[0]
            held[side] |= np.array(
                [self.support.sides_clamped or component != axis for component in range(3)]
            )
            held[nodes[:, axis] == line[-1], axis] = True  # the mirror planes
        return held

    # The loads

    def _tool_forces(self) -> np.ndarray:
        """Nodal forces along -z for 1 N on the whole block, shape (n,)."""
        nodes, elements = self._lattice
        x, y, z = self._lines
        radius = self.radius / MILLIMETRE
        gauss, weight = np.polynomial.legendre.leggauss(24)
        rho, angle = np.meshgrid(0.5 * radius * (gauss + 1), 0.25 * np.pi * (gauss + 1), indexing="ij")
        share = (np.outer(weight * (gauss + 1), weight)).ravel() / 4
        places = (x[-1] - (rho * np.cos(angle)).ravel(), y[-1] - (rho * np.sin(angle)).ravel())
        cell, local = [], []
        for line, place in zip((x, y), places, strict=True):
            number = np.clip(np.searchsorted(line, place, side="right") - 1, 0, len(line) - 2)
            cell.append(number)
            local.append(2 * (place - line[number]) / np.diff(line)[number] - 1)
        element = (cell[0] * (len(y) - 1) + cell[1]) * (len(z) - 1) + len(z) - 2
        shapes = shape_functions(np.stack([*local, np.ones_like(local[0])], axis=1))
        forces = np.zeros(len(nodes))
        np.add.at(forces, elements[element], shapes * share[:, None] / 4)
        return forces

    def _side_forces(self) -> np.ndarray:
        """Nodal forces that hold the prestress at the sides x = 0 and y = 0, shape (n, 3)."""
        nodes, elements = self._lattice
        corner, middle = -1 / 12, 1 / 3  # of a uniform traction on an 8-node face
        forces = np.zeros(nodes.shape)
        for axis, key in ((0, "prestress_x"), (1, "prestress_y")):
            here = np.flatnonzero(LOCAL_NODES[:, axis] == -1)
            weights = np.where(np.abs(LOCAL_NODES[here]).sum(axis=1) == 3, corner, middle)
            for number, layer in enumerate(self.tissue.layers):
                tension = getattr(layer, key) / MEGAPASCAL
                chosen = elements[self._element_layer == number]
                chosen = chosen[nodes[chosen[:, 0], axis] == self._lines[axis][0]]
                span = np.ptp(nodes[chosen], axis=1)
                area = np.prod(np.delete(span, axis, axis=1), axis=1)
                np.add.at(forces[:, axis], chosen[:, here], -tension * area[:, None] * weights)
        return forces

    # The deck

    def _deck(self, forces: tuple[float, ...]) -> list[str]:
        nodes, elements = self._lattice
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in enumerate(nodes, start=1)]
        for number, layer in enumerate(self.tissue.layers):
            chosen = np.flatnonzero(self._element_layer == number)
            lines += _bricks(f"LAYER{number}", chosen + 1, elements[chosen])
            lines += [f"*MATERIAL, NAME=LAYER{number}", "*HYPERELASTIC, NEO HOOKE", _constants(layer)]
            if layer.prestress_x or layer.prestress_y:
                lines += _bricks(f"TENSION{number}", chosen + len(elements) + 1, elements[chosen])
                lines += [f"*MATERIAL, NAME=TENSION{number}", "*ELASTIC"]
                lines.append(f"{_NOTHING * layer.young_modulus / MEGAPASCAL:.12g}, 0.")
        lines.append("*BOUNDARY")
        lines += [f"{n + 1}, {axis + 1}" for n, axis in np.argwhere(self._held())]
        lines += self._initial_stress()
        lines += self._step(self._side_forces())
        pushed = self._tool_forces()
        for force in forces:
            load = np.zeros(nodes.shape)
            load[:, 2] = -force * pushed
            lines += self._step(load)
        return lines

    def _initial_stress(self) -> list[str]:
        lines, count = [], len(self._lattice[1])
        for number, layer in enumerate(self.tissue.layers):
            stress = (
                f"{layer.prestress_x / MEGAPASCAL:.12g}, {layer.prestress_y / MEGAPASCAL:.12g}, 0, 0, 0, 0"
            )
            if layer.prestress_x or layer.prestress_y:
                chosen = np.flatnonzero(self._element_layer == number) + count + 1
                lines += [f"{element}, {point}, {stress}" for element in chosen for point in range(1, 9)]
        return ["*INITIAL CONDITIONS, TYPE=STRESS", *lines] if lines else []

    @staticmethod
    def _step(load: np.ndarray) -> list[str]:
        """Write one step; forces on other components than these stay as they were."""
        return [
            "*STEP, NLGEOM, INC=200",
            "*STATIC",
            "1., 1., 1e-3",
            "*CONTROLS, PARAMETERS=FIELD",
            "1e-4, 1e-3",  # residual and correction, relative; the defaults 5e-3 and 1e-2 would cost digits
            *(["*CLOAD"] if np.any(load) else []),
            *(f"{n + 1}, {axis + 1}, {load[n, axis]:.12g}" for n, axis in np.argwhere(load)),
            "*NODE PRINT, NSET=ALL, FREQUENCY=200",  # the end of a step is always printed
            "U",
            "*END STEP",
        ]

    # The result

    def _read(self, text: str) -> list[np.ndarray]:
        rows = [match.groups() for match in map(_PRINTED_ROW.match, text.splitlines()) if match]
        count = len(self._lattice[0])
        whole = len(rows) // count
        table = np.array(rows[: whole * count], dtype=float).reshape(whole, count, 4)
        assert np.array_equal(table[:, :, 0], np.tile(np.arange(1, count + 1), (whole, 1)))
        return list(table[:, :, 1:])

    def _measured(self, force: float, field: np.ndarray) -> Pressed:
        nodes, elements = self._lattice
        faces = np.concatenate([[0.0], -np.cumsum([layer.thickness for layer in self.tissue.layers])])
        vertical = []
        for face in faces / MILLIMETRE:
            here = np.flatnonzero(np.abs(nodes[:, 2] - face) < 1e-6)
            vertical.append(field[here[np.lexsort((nodes[here, 1], nodes[here, 0]))], 2])
        heights = [
            1 + (upper - lower).min() / (layer.thickness / MILLIMETRE)
            for upper, lower, layer in zip(vertical, vertical[1:], self.tissue.layers, strict=False)
        ]
        gauss = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)
        slopes = _shape_gradients(gauss)
        half = np.ptp(nodes[elements], axis=1) / 2
        gradient = np.einsum("eai,qak,ek->eqik", field[elements], slopes, 1 / half, optimize=True)
        deformation = gradient + np.eye(3)
        volume = np.linalg.det(deformation)
        return Pressed(
            force=force,
            deflection=tuple(float(-row.min()) * MILLIMETRE for row in vertical[:-1]),
            stretch=float(np.linalg.svd(deformation, compute_uv=False).min()),
            height=float(min(heights)),
            volume_ratio=(float(volume.min()), float(volume.max())),
        )


def shape_functions(local: np.ndarray) -> np.ndarray:
    """Return the 20 serendipity functions at places from -1 to 1, shape (n, 3); shape (n, 20)."""
    product = 1 + local[:, None, :] * LOCAL_NODES
    bubble = np.where(LOCAL_NODES == 0, 1 - local[:, None, :] ** 2, product).prod(axis=2)
    corner = np.all(LOCAL_NODES != 0, axis=1)
    return np.where(corner, bubble * (product.sum(axis=2) - 5) / 8, bubble / 4)


def _shape_gradients(local: np.ndarray) -> np.ndarray:
    """Return their gradients, shape (n, 20, 3), by central differences, exact for quadratics."""
    steps = np.eye(3)
    return np.stack([(shape_functions(local + h) - shape_functions(local - h)) / 2 for h in steps], axis=2)


def _bricks(name: str, numbers: np.ndarray, elements: np.ndarray) -> list[str]:
    lines = [f"*ELEMENT, TYPE=C3D20R, ELSET={name}"]
    for number, element in zip(numbers, elements, strict=True):
        names = [str(node + 1) for node in element]
        lines += [f"{number}, {', '.join(names[:10])},", ", ".join(names[10:])]
    return [*lines, f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]


def _constants(layer: Layer) -> str:
    bulk = layer.young_modulus / (3 * (1 - 2 * layer.poisson_ratio))
    return f"{layer.shear_modulus / 2 / MEGAPASCAL:.12g}, {2 / bulk * MEGAPASCAL:.12g}"
