"""A layered block as a soft body of Newton, on Warp's processor device, by vertex block descent.

Tetrahedra are piecewise linear and stable neo-Hookean (B. Smith, F. de Goes, T. Kim 2018), time is backward Euler, and
its equations are met approximately: every node in turn, colour by colour, is moved to its own optimum, `rounds` times a
step (A. Chen and others, Vertex Block Descent, 2024). Numbers have single precision. Damping is by the rate of
C = F^T F and amounts to a shear viscosity of 2 k: with k = tau mu / 2 that is Kelvin and Voigt's, but of shear alone.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp
from engine_meshes import Tetrahedra

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.tissues import Tissue

_TICK = 1e-3  # [s]
_LOOK, _MOST = 0.02, 25  # [s] between two looks; looks
_STILL = 5e-4  # of the largest displacement: what may change from look to look; single precision moves 3e-4


class NewtonVBD:
    """A block that Newton moves.

    Args:
        tissue: the layers; prestress is left out.
        mesh: of the whole block.
        rounds: over all nodes in a step.
    """

    def __init__(self, tissue: Tissue, mesh: Tetrahedra, *, rounds: int) -> None:
        wp.config.log_level = wp.LOG_ERROR
        self.mesh = mesh
        self.layer_names = tissue.layer_names
        builder = newton.ModelBuilder(gravity=wp.vec3())
        masses = np.where(mesh.held, 0.0, mesh.masses(tissue))
        builder.add_particles(
            pos=[wp.vec3(*place) for place in mesh.nodes.T],
            vel=[wp.vec3()] * len(masses),
            mass=list(masses),
        )
        for nodes, layer in zip(mesh.tetrahedra, mesh.tetrahedron_layer, strict=True):
            stuff = tissue.layers[layer]
            builder.add_tetrahedron(
                *(int(node) for node in nodes),
                k_mu=stuff.shear_modulus,
                k_lambda=stuff.lame_lambda,
                k_damp=0.5 * stuff.retardation_time * stuff.shear_modulus,
            )
        builder.color()
        self._model = builder.finalize(device="cpu")
        self._solver = newton.solvers.SolverVBD(
            self._model,
            iterations=rounds,
            particle_enable_self_contact=False,
            particle_enable_tile_solve=False,
        )
        self._now, self._next = self._model.state(), self._model.state()
        self._control = self._model.control()
        self._rest = self._now.particle_q.numpy().copy()

    @property
    def dofs(self) -> int:
        """Unknowns."""
        return 3 * int((~self.mesh.held).sum())

    def rest(self, forces: FloatArray) -> FloatArray:
        """Go on until the block is at rest, and return the displacements of the nodes [m].

        Args:
            forces: on the nodes [N], shape (nodes, 3).

        Raises:
            SolverError: it does not come to rest.
        """
        before = self.displacement()
        change = np.inf
        for _ in range(_MOST):
            for _ in range(round(_LOOK / _TICK)):
                self.step(forces, _TICK)
            found = self.displacement()
            change = float(np.abs(found - before).max() / np.abs(found).max())
            if change < _STILL:
                return found
            before = found
        raise SolverError(
            f"Newton is not at rest after {_LOOK * _MOST:g} s: the last look saw {change:.1g} of change"
        )

    def step(self, forces: FloatArray, dt: float) -> None:
        """Go on by dt [s] under forces on the nodes [N], shape (nodes, 3)."""
        self._now.particle_f.assign(forces.astype(np.float32))
        self._solver.step(self._now, self._next, self._control, None, dt)
        self._now, self._next = self._next, self._now

    def displacement(self) -> FloatArray:
        """Return the displacements of the nodes [m], shape (nodes, 3)."""
        return np.asarray(self._now.particle_q.numpy() - self._rest, dtype=np.float64)
