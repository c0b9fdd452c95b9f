"""What a live scene with a sheet is made of: a lattice laid out in ticks and two instruments, one of which may cut.

It is to the servo what `scene` is: parameters and a state that compiled code takes whole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from trocar.contact.instrument import Instrument, TipKind
from trocar.contact.tips import TIPS
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation.scene import DT, FRICTION
from trocar.waves.sheet.lattice import Lattice, LatticeState, make_lattice, taut
from trocar.waves.sheet.sheet import Sheet

PLANES = 6  # of what is shown: u_z, u_x, u_y, and where three links of each node are cut
MOST_HELD = 64  # nodes in one jaw
_WIDER = 0.5  # of the spacing: so much wider than the tip is what presses, or it would slip between nodes


class SheetScene(NamedTuple):
    """Parameters of a scene; nothing in it changes.

    Attributes:
        lattice: the sheet.
        ports: of both instruments [m], shape (2, 3).
        lengths: of their shafts, from handle to tip [m], shape (2,).
        axes, middles: of their tips' ellipsoids (`contact.tips`) [m], shapes (2, 3).
        wider: by which an ellipsoid that presses is larger all round, and higher [m].
        holds, cuts: whether a tip has jaws that hold, and blades, shape (2,).
        friction: coefficient [1].
        dt: length of a tick [s].
        modes: rows and columns of nodes, in the place of the waves' modes.
        layers: planes that are shown.
    """

    lattice: Lattice
    ports: FloatArray
    lengths: FloatArray
    axes: FloatArray
    middles: FloatArray
    wider: float
    holds: FloatArray
    cuts: FloatArray
    friction: float
    dt: float
    modes: tuple[int, int]
    layers: int


class SheetState(NamedTuple):
    """What a scene changes, in place.

    Attributes:
        lattice: the sheet.
        centres: middles of the ellipsoids that press at the end of the last small step [m], shape (2, 3).
        ways: how far they go in each small step of this tick [m], shape (2, 3).
        spreads: S of `contact.tips` [m^2], shape (2, 3, 3).
        flags: of both instruments: in the hand, free to touch, jaw, blades were open since they last closed, small
            steps with touch; shape (2, 5).
        touched: nodes touched in the last small step, shape (2, MOST_HELD); counts: how many, and how many are held,
            shape (2, 2).
        held: nodes in a jaw, shape (2, MOST_HELD); offsets: from the ellipsoid's middle [m], (2, MOST_HELD, 3).
        forces: on the tips, sums over a tick [N], shape (2, 3); moments: about their ends [N m], shape (2, 3).
        snips: as records have them, and ticks for which they still do, shape (2, 6).
        lowest: lowest points of the tips [m], shape (2, 3).
        vectors: scratch, shape (6, 3).
        spread: scratch, shape (3, 3).
    """

    lattice: LatticeState
    centres: FloatArray
    ways: FloatArray
    spreads: FloatArray
    flags: FloatArray
    touched: np.ndarray
    counts: np.ndarray
    held: np.ndarray
    offsets: FloatArray
    forces: FloatArray
    moments: FloatArray
    snips: FloatArray
    lowest: FloatArray
    vectors: FloatArray
    spread: FloatArray


def make_sheet_scene(
    sheet: Sheet, instruments: tuple[Instrument, Instrument], *, dt: float = DT, friction: float = FRICTION
) -> SheetScene:
    """Lay out a scene.

    Args:
        sheet: the film.
        instruments: left, right.
        dt: length of a tick [s].
        friction: coefficient [1].

    Raises:
        InputError: a number is impossible.
    """
    if not 0 <= friction <= 2:
        raise InputError("scene: friction", "a coefficient from 0 to 2", friction)
    radii = np.array([each.shaft_radius for each in instruments])[:, None]
    columns, rows = sheet.nodes
    return SheetScene(
        lattice=make_lattice(sheet, dt),
        ports=np.array([each.port for each in instruments]),
        lengths=np.array([each.length for each in instruments]),
        axes=np.array([TIPS[each.tip].axes for each in instruments]) * radii,
        middles=np.array([TIPS[each.tip].middle for each in instruments]) * radii,
        wider=_WIDER * sheet.spacing,
        holds=np.array([1.0 if TIPS[each.tip].holds else 0.0 for each in instruments]),
        cuts=np.array([1.0 if each.tip is TipKind.SCISSORS else 0.0 for each in instruments]),
        friction=friction,
        dt=dt,
        modes=(rows, columns),
        layers=PLANES,
    )


def sheet_at_rest(scene: SheetScene) -> SheetState:
    """Return a scene's state with the sheet whole and at rest, and no instrument in the hand."""
    tools = len(scene.lengths)
    return SheetState(
        lattice=taut(scene.lattice),
        centres=np.zeros((tools, 3)),
        ways=np.zeros((tools, 3)),
        spreads=np.zeros((tools, 3, 3)),
        flags=np.zeros((tools, 5)),
        touched=np.zeros((tools, MOST_HELD), dtype=np.int64),
        counts=np.zeros((tools, 2), dtype=np.int64),
        held=np.zeros((tools, MOST_HELD), dtype=np.int64),
        offsets=np.zeros((tools, MOST_HELD, 3)),
        forces=np.zeros((tools, 3)),
        moments=np.zeros((tools, 3)),
        snips=np.zeros((tools, 6)),
        lowest=np.zeros((tools, 3)),
        vectors=np.zeros((6, 3)),
        spread=np.zeros((3, 3)),
    )
