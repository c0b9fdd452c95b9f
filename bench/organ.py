"""Set up WaveMesh for the liver of about 20,000 nodes: seconds, memory, and the time of one step under two presses.

Run: python bench/organ.py [--spacing-mm 12.5] [--modes 60]. Seconds are processor time. "kept" is a second
model that finds its modes and vectors in the cache. A step is `WaveMesh.step` from Python, where two presses stay;
"compiled" is the part of it that a live tick would call, `kernel.advance` with the forces given.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time

import numpy as np
from stopwatch import timed

from trocar import tissue
from trocar.model import Press
from trocar.waves.kernel import advance
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.sparse import Factored
from trocar.waves.mesh.wave_mesh import MeshState, WaveMesh

DT, STEPS = 1e-3, 2000
PRESSES = (Press(x=0.12, y=0.045, radius=4e-3, force=0.2), Press(x=0.15, y=0.06, radius=4e-3, force=0.2))


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--modes", type=int, default=60)
    parser.add_argument("--spacing-mm", type=float, default=12.5)
    arguments = parser.parse_args()
    mesh = timed(
        "mesh", lambda: Liver().mesh(tissue("liver").layers[-1], spacing=1e-3 * arguments.spacing_mm)
    )
    with tempfile.TemporaryDirectory() as folder:
        model = WaveMesh(mesh, modes=arguments.modes, cache=BasisCache(folder))
        print(f"{model.elements.nodes.shape[1]} nodes, {model.dofs} unknowns, {arguments.modes} modes")
        factor, state = first(model)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
        kept = WaveMesh(mesh, modes=arguments.modes, cache=BasisCache(folder))
        again = timed("all of it, kept", lambda: kept.static(PRESSES))
    assert np.array_equal(again.oscillators[0], state.oscillators[0])
    basis = 8 * 3 * model.elements.nodes.shape[1] * state.oscillators[0].shape[1] / 2**20
    print(f"  modes to {model.frequencies[-1]:.0f} Hz")
    print(
        f"  factor {factor.stored / 2**20:.0f} MiB, basis {basis:.0f} MiB, the process at most {peak:.0f} MiB"
    )
    steps(model, state)


def first(model: WaveMesh) -> tuple[Factored, MeshState]:
    """Print what setting up costs."""
    matrices = model.matrices
    timed("matrices", lambda: (matrices.stiffness, matrices.mass, matrices.damping))
    factor = timed("factor", lambda: matrices.factored)
    timed("modes", lambda: model.frequencies)
    return factor, timed("two presses", lambda: model.static(PRESSES))


def steps(model: WaveMesh, state: MeshState) -> None:
    """Print how long a step takes."""
    whole = np.empty(STEPS)
    for number in range(STEPS):
        began = time.perf_counter()
        state = model.step(state, PRESSES, PRESSES, DT)
        whole[number] = time.perf_counter() - began
    oscillators = model.oscillators(PRESSES)
    step, amplitudes = oscillators.propagator(DT), state.oscillators[0].copy()
    forces, inner = np.full((1, len(PRESSES)), 0.2), np.empty(STEPS)
    for number in range(STEPS):
        began = time.perf_counter()
        advance(step.transition, step.start_gain, step.end_gain, amplitudes, forces, forces)
        inner[number] = time.perf_counter() - began
    for name, times in (("WaveMesh.step", whole), ("compiled", inner)):
        median, high = 1e6 * np.percentile(times, (50, 99))
        print(
            f"  {name} of {amplitudes.shape[1]} amplitudes: median {median:.1f} us, 99 % below {high:.1f} us"
        )


if __name__ == "__main__":
    main()
