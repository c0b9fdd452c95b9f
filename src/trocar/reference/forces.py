"""The nodal forces of a load, split by parity."""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray, Load, Press
from trocar.reference.footprint import footprint_points
from trocar.reference.grid import Grid
from trocar.reference.parity import PARITIES, QUARTERS, Parity, fold, mirror_signs, mirrored_lines

_NEGLIGIBLE = 1e-12  # of the force: a part below it is rounding in a symmetric load, not a load
_CACHED_PRESSES = 64  # each is up to four arrays the size of the mesh


class NodalForces:
    """Turn loads into consistent nodal forces of the quarter; those of unit forces are kept.

    Args:
        grid: the quarter's mesh.
        size: sides of the block [m].
    """

    def __init__(self, grid: Grid, size: tuple[float, float]) -> None:
        self._bricks = grid
        self._size = size
        self._units: dict[Press, dict[Parity, FloatArray]] = {}

    def of(self, load: Load) -> dict[Parity, FloatArray]:
        """Return the nodal forces [N], shape (3, nodes), of every parity that a load excites.

        Raises:
            InputError: a footprint is not wholly on the block.
        """
        total: dict[Parity, FloatArray] = {}
        for press in load:
            for parity, unit in self._unit(press.with_force(1.0)).items():
                total[parity] = total.get(parity, 0.0) + press.force * unit
        smallest = _NEGLIGIBLE * sum(abs(press.force) for press in load)
        return {parity: force for parity, force in total.items() if np.abs(force).sum() > smallest}

    def _unit(self, press: Press) -> dict[Parity, FloatArray]:
        if press not in self._units:
            if len(self._units) >= _CACHED_PRESSES:
                self._units.pop(next(iter(self._units)))
            self._units[press] = self._integrate(press)
        return self._units[press]

    def _integrate(self, press: Press) -> dict[Parity, FloatArray]:
        grid, vector = self._bricks, np.array(press.force_vector)
        lines = (mirrored_lines(half, side) for half, side in zip((grid.x, grid.y), self._size, strict=True))
        points, share = footprint_points(press, *lines)
        folded, mirrored = fold(points, self._size)
        nodes, weights = grid.interpolation(folded, len(grid.z) - 1)
        forces = {parity: np.zeros(grid.nodes.shape) for parity in PARITIES}
        for quarter in QUARTERS:
            here = np.all(mirrored == quarter, axis=1)
            carried = (weights * share)[:, here].ravel()
            spread = np.bincount(nodes[:, here].ravel(), carried, minlength=grid.nodes.shape[1])
            for parity in PARITIES:
                signs = mirror_signs(parity, np.array([quarter]))[:, 0]
                forces[parity] += np.outer(0.25 * signs * vector, spread)
        return {parity: force for parity, force in forces.items() if np.abs(force).sum() > _NEGLIGIBLE}
