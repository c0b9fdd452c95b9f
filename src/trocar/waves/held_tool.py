"""`WaveSolid` under one tool that stays where it is: a force comes in, deflections come out.

Only the waves that the tool excites move. For an upright tool in the middle of the block these are odd m and
n, and no horizontally polarised shear: what is left of the block is the quarter that mirror symmetry leaves
of any method. The tool's traction and the read-out are folded into the blocks, so a step is E z + G F per
block and one sum per face; as in `tick`, z = x - W1 B F needs one gain. Waves beyond the moving ones follow
at once, as in `WaveSolid`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from trocar.errors import InputError
from trocar.model import FloatArray, Press
from trocar.waves.kernel import TINY, turned
from trocar.waves.solid import WaveSolid

_SILENT = 1e-13  # modal force relative to the largest: below it is rounding
_STRIP = 64  # partial sums of the read-out, so that it runs in vector registers


@dataclass(frozen=True)
class HeldTool:
    """The exact step of length dt under one upright tool.

    Attributes:
        transition: E, components 00, 01, 10, 11 of every block, shape (4, blocks padded).
        gain: E W1 B + W0 B [per N], shape (2, blocks padded).
        read: from the blocks to u_z under the tool's centre, shape (faces, 2, blocks padded).
        at_once: u_z [m] that a force of 1 N at the end of the step adds, shape (faces,).
        blocks: how many oscillators move.
        dt: [s].
    """

    transition: FloatArray
    gain: FloatArray
    read: FloatArray
    at_once: FloatArray
    blocks: int
    dt: float

    @property
    def rest(self) -> FloatArray:
        """The state at rest without load, shape (2, blocks padded)."""
        return np.zeros_like(self.gain)

    def press(self, forces: FloatArray) -> FloatArray:
        """Return u_z [m] of every face under the tool's centre, shape (steps, faces), from rest.

        Args:
            forces: at the end of every step [N], positive pressing in, linear in between, shape (steps,).
        """
        result = np.empty((len(forces), len(self.at_once)))
        press_through(self.transition, self.gain, self.read, self.at_once, self.rest, forces, result)
        return result


def hold(model: WaveSolid, tool: Press, dt: float) -> HeldTool:
    """Fold a tool into a model's oscillators.

    Args:
        model: the tissue.
        tool: where it presses and with what footprint; its force does not matter.
        dt: length of a step [s].

    Raises:
        InputError: the tool is tilted, the sides are clamped, or a layer has a Prony series.
    """
    if model.support.sides_clamped:
        raise InputError("held tool: support", "simply supported sides, base", model.support.value)
    if model.tissue.relaxation_times:
        raise InputError("held tool: prony", "layers without a Prony series", model.tissue.relaxation_times)
    if tool.tilt > 0:
        raise InputError("held tool: tilt", "an upright tool, 0", tool.tilt)
    unit = tool.with_force(1.0)
    forces, _ = model.moving_forces((unit,))
    heard = np.flatnonzero(np.abs(forces[:, 0]) > _SILENT * np.abs(forces[:, 0]).max())
    waves = model.oscillators_wv.gathered(heard)
    push = forces[heard]
    faces = len(model.layer_names)
    upright = waves.outputs.reshape(len(heard), faces, -1, *waves.outputs.shape[2:])[:, :, 0]
    centre = np.array([[tool.x, tool.y, 0.0]])
    shapes = model.moving_shapes(centre)[0, heard]
    read = upright * shapes[:, None, None, None]

    step = waves.propagator(dt)
    start, end = (np.einsum("jran,jn->jra", gain, push) for gain in (step.start_gain, step.end_gain))
    static = model.static((unit,))
    whole = np.array([model.displacement(static, centre, name)[0, 2] for name in model.layer_names])
    moving = np.einsum("jkri,jri->k", read, waves.equilibrium(push))
    count = start.shape[0] * start.shape[1]
    return HeldTool(
        transition=_planes(step.transition.reshape(count, 4)),
        gain=_planes((np.einsum("jrab,jrb->jra", step.transition, end) + start).reshape(count, 2)),
        read=_planes(np.moveaxis(read, 1, 2).reshape(count, faces * 2)).reshape(faces, 2, -1),
        at_once=whole - moving + np.einsum("jkri,jri->k", read, end),
        blocks=count,
        dt=dt,
    )


def _planes(table: FloatArray) -> FloatArray:
    planes = np.zeros((table.shape[1], -(-len(table) // _STRIP) * _STRIP))
    planes[:, : len(table)] = np.where(np.abs(table) > TINY, table, 0.0).T
    return planes


@njit(cache=True)
def press_through(
    transition: FloatArray,
    gain: FloatArray,
    read: FloatArray,
    at_once: FloatArray,
    state: FloatArray,
    forces: FloatArray,
    result: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Step through a history of forces; arguments as in `HeldTool`, `state` and `result` overwritten."""
    e00, e01, e10, e11 = transition
    gain_x, gain_y = gain
    x, y = state
    faces, _, count = read.shape
    sums = np.empty(_STRIP)
    force = 0.0
    for step in range(len(forces)):
        for j in range(count):
            p, q = x[j], y[j]
            x[j] = turned(e00[j], e01[j], p, q, gain_x[j] * force)
            y[j] = turned(e10[j], e11[j], p, q, gain_y[j] * force)
        force = forces[step]
        for face in range(faces):
            sums[:] = 0.0
            for first in range(0, count, _STRIP):
                read_x, read_y = read[face, 0, first:], read[face, 1, first:]
                own_x, own_y = x[first:], y[first:]
                for j in range(_STRIP):
                    sums[j] += read_x[j] * own_x[j] + read_y[j] * own_y[j]
            result[step, face] = at_once[face] * force + sums.sum()
