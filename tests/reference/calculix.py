"""Ask CalculiX, which nobody here wrote, for the displacement of a block of 20-node bricks (C3D20R).

Only what the comparison needs: linear isotropic layers, components held at zero, nodal forces or a pressure
on element faces, a static step. Lengths go to CalculiX in millimetres and forces in newtons (so moduli in
MPa), since it prints seven digits of whatever it is given.

Node order of C3D20 (CalculiX manual, sec. 6.2.8): corners of the lower face, of the upper face, middles of
the lower edges, of the upper edges, of the upright edges, each anticlockwise seen from above.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from trocar.tissues import Layer
from trocar.units import MEGAPASCAL, MILLIMETRE

UPPER_FACE = "P2"  # the face of nodes 5, 6, 7 and 8

CORNERS = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)])
_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
LOCAL_NODES = np.vstack([CORNERS, [(CORNERS[i] + CORNERS[j]) // 2 for i, j in _EDGES]])
"""Places of the 20 nodes in an element, each coordinate 0, 1 or 2; shape (20, 3)."""


def executable() -> str:
    """Return the path of `ccx`; skip where a user has none, fail in continuous integration."""
    path = shutil.which("ccx")
    if path is None and os.environ.get("CI") == "true":
        pytest.fail("CalculiX is missing; install the Debian package calculix-ccx")
    if path is None:
        pytest.skip("CalculiX is not installed (Debian package calculix-ccx)")
    return path


@dataclass(kw_only=True)
class Job:
    """A static step.

    Args:
        nodes: places [m], shape (n, 3).
        elements: numbers of the nodes, shape (m, 20), in C3D20's order.
        element_layer: shape (m,).
        layers: the materials.
        held: which components are zero, shape (n, 3).
        forces: nodal forces [N], shape (n, 3).
        pressure: pressure on the upper faces of elements [Pa].
    """

    nodes: np.ndarray
    elements: np.ndarray
    element_layer: np.ndarray
    layers: tuple[Layer, ...]
    held: np.ndarray
    forces: np.ndarray | None = None
    pressure: dict[int, float] = field(default_factory=dict)

    def solve(self, folder: Path) -> np.ndarray:
        """Run CalculiX in a folder; return the displacement of every node [m], shape (n, 3)."""
        (folder / "block.inp").write_text("\n".join(self._lines()) + "\n")
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        run = subprocess.run(
            [executable(), "block"], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        assert run.returncode == 0, run.stdout[-2000:] + run.stderr
        assert "*ERROR" not in run.stdout, run.stdout[-2000:]
        row = re.compile(r"^\s*(\d+)\s+(\S+)\s+(\S+)\s+(\S+)\s*$")
        found = [
            match.groups()
            for match in map(row.match, (folder / "block.dat").read_text().splitlines())
            if match
        ]
        assert [int(number) for number, *_ in found] == list(range(1, len(self.nodes) + 1))
        return MILLIMETRE * np.array([values for _, *values in found], dtype=float)

    def _lines(self) -> list[str]:
        lines = ["*NODE, NSET=ALL"]
        places = self.nodes / MILLIMETRE
        lines += [f"{n}, {x:.10g}, {y:.10g}, {z:.10g}" for n, (x, y, z) in enumerate(places, start=1)]
        for number, layer in enumerate(self.layers):
            lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET=LAYER{number}")
            for element in np.flatnonzero(self.element_layer == number):
                names = [str(node + 1) for node in self.elements[element]]
                lines += [f"{element + 1}, {', '.join(names[:10])},", ", ".join(names[10:])]
            modulus = layer.young_modulus / MEGAPASCAL
            lines += [f"*MATERIAL, NAME=M{number}", "*ELASTIC", f"{modulus:.12g}, {layer.poisson_ratio:.12g}"]
            lines.append(f"*SOLID SECTION, ELSET=LAYER{number}, MATERIAL=M{number}")
        lines.append("*BOUNDARY")
        lines += [f"{n + 1}, {axis + 1}" for n, axis in np.argwhere(self.held)]
        lines += ["*STEP", "*STATIC"]
        if self.forces is not None:
            lines.append("*CLOAD")
            lines += [
                f"{n + 1}, {axis + 1}, {self.forces[n, axis]:.12g}" for n, axis in np.argwhere(self.forces)
            ]
        if self.pressure:
            lines.append("*DLOAD")
            lines += [f"{e + 1}, {UPPER_FACE}, {p / MEGAPASCAL:.12g}" for e, p in self.pressure.items()]
        return [*lines, "*NODE PRINT, NSET=ALL", "U", "*END STEP"]
