"""Coulomb friction of a tip on a surface that gives way sideways at once.

While the tip sticks, the surface goes with it, and the force f across the surface changes by the motion over the
compliance C; it slides as soon as that force would exceed the friction coefficient times the normal force,

    trial = f + s/C,   f = trial min(1, mu N/|trial|),   slip = C (trial - f),

which is the implicit step of an elastic, perfectly sliding contact (return mapping; Wriggers 2006, Computational
Contact Mechanics, section 5.2). Its energy C f^2/2 and the heat f slip together never exceed what the tip puts in.
"""

from __future__ import annotations

from math import sqrt

from numba import njit

from trocar.model import FloatArray


@njit(cache=True)
def drag(
    force: FloatArray, motion_x: float, motion_y: float, compliance: float, coefficient: float, normal: float
) -> float:  # pragma: no cover - compiled
    """Advance the friction force over a motion of the tip.

    Args:
        force: of the tip on the surface, along x and y [N], shape (2,); overwritten.
        motion_x: of the tip over the tick, along x [m].
        motion_y: along y [m].
        compliance: displacement of the surface under the tip per force across it [m/N].
        coefficient: of friction [1].
        normal: force of the tip into the surface at the end of the tick [N]; below 0 counts as 0.

    Returns:
        How far the tip slid over the surface [m].
    """
    trial_x, trial_y = force[0] + motion_x / compliance, force[1] + motion_y / compliance
    trial = sqrt(trial_x**2 + trial_y**2)
    most = coefficient * max(normal, 0.0)
    if trial <= most:
        force[0], force[1] = trial_x, trial_y
        return 0.0
    share = most / trial
    force[0], force[1] = share * trial_x, share * trial_y
    return compliance * (trial - most)
