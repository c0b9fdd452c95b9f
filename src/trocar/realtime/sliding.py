"""The scene and the motion that the servo is measured with: two tips that circle in the tissue, always in contact."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin

from trocar.contact.instrument import Instrument, default_instruments
from trocar.devices.device import HandlePose, Poses
from trocar.simulation import Scene, SceneState, at_rest, make_scene
from trocar.simulation.live import LIVE_SIZE, live_model
from trocar.tissues.tissue import Tissue

DEPTH = 8e-4  # [m] of the tips below the rest surface
_CIRCLE, _TURN = 5e-3, 0.6  # [m] radius, [s] a turn: 52 mm/s over the surface
_MIDDLES = (0.3, 0.7)  # of the block's width
_COME_DOWN, _FROM = 0.5, 5e-3  # [s] from so high [m]: a tip first seen in the tissue would not touch it


def sliding_contact(
    tissue: Tissue, *, size: tuple[float, float] = LIVE_SIZE, depth: float = DEPTH
) -> tuple[Scene, SceneState, Callable[[float], Poses]]:
    """Return the live scene of a tissue under the default instruments, its state at rest and a motion.

    Args:
        tissue: the layers.
        size: of the block [m].
        depth: of the tips below the rest surface [m].
    """
    instruments = default_instruments(size)
    scene = make_scene(live_model(tissue, size=size), tissue, instruments)
    return scene, at_rest(scene), circling(instruments, size, depth)


def circling(
    instruments: tuple[Instrument, Instrument], size: tuple[float, float], depth: float
) -> Callable[[float], Poses]:
    """Return the motion of two tips that circle in the tissue, beside each other and against each other.

    Args:
        instruments: left and right.
        size: of the block [m].
        depth: of the tips below the rest surface [m].
    """

    def at(time: float) -> Poses:
        turn = 2 * pi * time / _TURN
        grips = []
        above = (depth + _FROM) * max(1.0 - time / _COME_DOWN, 0.0)
        for instrument, share, sense in zip(instruments, _MIDDLES, (1, -1), strict=True):
            x = share * size[0] + _CIRCLE * cos(turn)
            y = 0.5 * size[1] + sense * _CIRCLE * sin(turn)
            grips.append(
                HandlePose(
                    present=True, handle=instrument.handle_for((x, y, above - depth)), roll=0.0, jaw=1.0
                )
            )
        return grips[0], grips[1]

    return at
