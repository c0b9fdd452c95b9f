"""Implicit time for linear layers: Newmark's average acceleration, one factorisation for each length of step.

With D = u1 - u0 and v1 = 2 D / h - v0 the equation of motion holds on average over the step,

    (2/h^2 M + C/h + K/2) D = (f0 + f1)/2 - K u0 + 2/h M v0

(N. M. Newmark 1959, J. Eng. Mech. Div. ASCE 85:67, beta = 1/4, gamma = 1/2): second order, stable whatever the step, no
damping of its own. The explicit method's equations, for tissue whose thin stiff layers would make its steps too short.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.mesh_free.body import Body
from trocar.reference.solver import Factorisation


class AverageAcceleration:
    """Steps of one length.

    Args:
        body: what moves.
        dt: [s].
    """

    def __init__(self, body: Body, dt: float) -> None:
        self._body, self._dt = body, dt
        self._inertia = 2 / dt * np.repeat(body.mass, 3)[body.free]
        matrix = sp.diags_array(self._inertia / dt) + 0.5 * body.freed(body.stiffness)
        if body.laws.retardation.any():
            matrix = matrix + body.freed(body.damping) / dt
        self._factors = Factorisation(sp.csr_array(matrix), body.solver)

    def advance(
        self, start: tuple[FloatArray, FloatArray], forces: tuple[FloatArray, FloatArray]
    ) -> tuple[FloatArray, FloatArray]:
        """Return displacement and velocity after a step; all of shape (nodes, 3), as in `explicit.advance`.

        Raises:
            SolverError: the equations could not be solved accurately.
        """
        body = self._body
        held = 0.5 * (forces[0] + forces[1]).ravel() - body.stiffness @ start[0].ravel()
        right = held[body.free] + self._inertia * start[1].ravel()[body.free]
        change = body.spread(self._factors.solve(right))
        return start[0] + change, 2 / self._dt * change - start[1]
