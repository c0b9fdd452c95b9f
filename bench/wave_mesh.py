"""Compare WaveMesh with finite elements on the same mesh: clamped sides, free base, at rest and under a tap.

Run: python bench/wave_mesh.py [--modes 30 60 120] [--fine]. Prints the largest difference of the deflection at three
places of every face, relative to the largest deflection, that of the modes alone at rest, and what setting up took.
"""

from __future__ import annotations

import argparse
import time
from math import pi, sin

import numpy as np

from trocar import tissue
from trocar.model import Press
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.wave_mesh import WaveMesh

SIZE, SUPPORT, DURATION, DT = (0.06, 0.06), "edges", 0.02, 2.5e-4
PRESS = Press(x=0.03, y=0.03, radius=4e-3, force=0.1)
POINTS = np.array([[0.03, 0.03, 0.0], [0.036, 0.03, 0.0], [0.02, 0.04, 0.0]])
COARSE = MeshSize(per_radius=1.0, growth=1.0, top=0.8, deepening=1.0, side=0.8)
FINE = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)


def pushed(at: float) -> tuple[Press]:
    """Return the tap's load at a time [s]: half a sine."""
    return (PRESS.with_force(PRESS.force * sin(pi * at / DURATION) if at < DURATION else 0.0),)


def apart(one: list, other: list) -> float:
    """Return the largest difference relative to the largest value of the other."""
    return float(np.abs(np.array(one) - np.array(other)).max() / np.abs(other).max())


def of_modes_alone(model: WaveMesh, modes: tuple[np.ndarray, np.ndarray], face: str) -> np.ndarray:
    """Return what the modes without the vectors of the press say at rest [m], shape (n, 3)."""
    squares, shapes = modes
    field = (shapes @ ((shapes.T @ model.nodal_forces(PRESS)) / squares)).reshape(3, -1)
    nodes, weights = model.elements.at(face, POINTS)
    return np.einsum("ckn,kn->nc", field[:, nodes], weights)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--modes", type=int, nargs="+", default=[30, 60, 120])
    parser.add_argument("--fine", action="store_true", help="a mesh of 16,000 unknowns instead of 5,000")
    arguments = parser.parse_args()
    layers = tissue("skin")
    size = FINE if arguments.fine else COARSE
    reference = FEASolid(layers, size=SIZE, support=SUPPORT, around=(PRESS,), mesh=size)
    lines = [
        np.concatenate([line, side - line[-2::-1]])
        for line, side in zip((reference.bricks.x, reference.bricks.y), SIZE, strict=True)
    ]
    still, states = reference.static((PRESS,)), [reference.init()]
    ticks = round(2 * DURATION / DT)
    for tick in range(ticks):
        states.append(reference.step(states[-1], pushed(tick * DT), pushed((tick + 1) * DT), DT))
    for modes in arguments.modes:
        began = time.process_time()
        model = WaveMesh(block_mesh(layers, (*lines, reference.bricks.z), support=SUPPORT), modes=modes)
        rest, state = model.static((PRESS,)), model.init()
        taken, faces = time.process_time() - began, layers.layer_names
        static = apart(
            [model.displacement(rest, POINTS, face) for face in faces],
            [reference.displacement(still, POINTS, face) for face in faces],
        )
        shapes = model.matrices.modes(modes)
        alone = apart(
            [of_modes_alone(model, shapes, face) for face in faces],
            [reference.displacement(still, POINTS, face) for face in faces],
        )
        ours, theirs = [], []
        for tick in range(ticks):
            state = model.step(state, pushed(tick * DT), pushed((tick + 1) * DT), DT)
            ours += [model.displacement(state, POINTS, face) for face in faces]
            theirs += [reference.displacement(states[tick + 1], POINTS, face) for face in faces]
        print(
            f"{model.dofs} unknowns, {modes:4} modes to {model.frequencies[-1]:4.0f} Hz: "
            f"static {100 * static:.3f} % (modes alone {100 * alone:.1f} %), "
            f"tap {100 * apart(ours, theirs):.2f} %, set up in {taken:.1f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
