"""The nodal forces of a load, split by parity."""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray, Load
from trocar.reference.footprint import footprint_points
from trocar.reference.mesh import Bricks
from trocar.reference.parity import PARITIES, QUARTERS, Parity, fold, mirror_signs

_NEGLIGIBLE = 1e-13  # of the force: a part below it is rounding of a symmetric footprint, not a load


def nodal_forces(bricks: Bricks, size: tuple[float, float], load: Load) -> dict[Parity, FloatArray]:
    """Return the consistent nodal forces [N] of a load on the quarter, for the parities it excites.

    Args:
        bricks: the quarter's mesh.
        size: sides of the block [m].
        load: presses.

    Returns:
        Forces of shape (3, nodes) for every parity that is not zero.

    Raises:
        InputError: a footprint is not wholly on the block.
    """
    forces = {parity: np.zeros(bricks.nodes.shape) for parity in PARITIES}
    scale = 0.0
    for press in load:
        points, share = footprint_points(press, size)
        folded, mirrored = fold(points, size)
        nodes, weights = bricks.interpolation(folded, len(bricks.z) - 1)
        vector = np.array(press.force_vector)
        scale += float(np.abs(vector).sum())
        for quarter in QUARTERS:
            here = np.all(mirrored == quarter, axis=1)
            spread = np.bincount(
                nodes[:, here].ravel(), (weights * share)[:, here].ravel(), minlength=bricks.nodes.shape[1]
            )
            for parity in PARITIES:
                signs = mirror_signs(parity, np.array([quarter]))[:, 0]
                forces[parity] += np.outer(0.25 * signs * vector, spread)
    return {parity: force for parity, force in forces.items() if np.abs(force).sum() > _NEGLIGIBLE * scale}
