"""The kinds of scene there are, and the functions that move each: what sessions, films and the servo ask for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

from trocar.model import FloatArray
from trocar.simulation.scene import Scene, at_rest
from trocar.simulation.sheet_scene import SheetScene, SheetState, sheet_at_rest
from trocar.simulation.sheet_step import advance_sheet, renew_sheet, sheet_planes
from trocar.simulation.step import RECORD, advance, amplitudes, come_to_rest
from trocar.simulation.trajectory import play

AnyScene = Scene | SheetScene


@dataclass(frozen=True, kw_only=True)
class Kind:
    """What moves a scene.

    Attributes:
        at_rest: (scene) -> state.
        advance: (scene, state, poses, records) -> bool: one tick; compiled, as all below.
        amplitudes: (scene, state, out) -> None: writes what is shown, shape (layers, M, N).
        come_to_rest: (scene, state) -> None.
        play: (scene, state, poses, records) -> bool: many ticks.
    """

    at_rest: Callable[[Any], Any]
    advance: Any
    amplitudes: Any
    come_to_rest: Any
    play: Any

    def played(self, scene: AnyScene, poses: FloatArray) -> FloatArray:
        """Return the records of both instruments in every tick of a history, from rest, shape (ticks, 2, RECORD).

        Args:
            scene: of this kind.
            poses: of both handles, shape (ticks, 2, POSE).
        """
        records = np.zeros((len(poses), 2, RECORD))
        self.play(scene, self.at_rest(scene), poses, records)
        return records


@njit(cache=True, nogil=True)
def play_sheet(
    scene: SheetScene, state: SheetState, poses: FloatArray, records: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Advance a sheet through a history of poses, as `trajectory.play` does a tissue.

    Returns:
        Whether all ticks went well.
    """
    well = True
    for k in range(len(poses)):
        well = advance_sheet(scene, state, poses[k], records[k]) and well
    return well


TISSUE = Kind(at_rest=at_rest, advance=advance, amplitudes=amplitudes, come_to_rest=come_to_rest, play=play)
SHEET = Kind(
    at_rest=sheet_at_rest,
    advance=advance_sheet,
    amplitudes=sheet_planes,
    come_to_rest=renew_sheet,
    play=play_sheet,
)


def kind_of(scene: AnyScene) -> Kind:
    """Return what moves a scene."""
    return SHEET if isinstance(scene, SheetScene) else TISSUE
