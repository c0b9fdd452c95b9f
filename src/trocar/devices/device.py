"""What every device is: two handle poses out at any time, two forces in.

A device knows handles, not tips: where a handle is, the tip follows by the lever of `trocar.contact.instrument`, and
the trainer computes it. Poses are data as they came; whoever moves tissue with them checks them, every one.

Hardware with a servo of its own, whose driver calls back at 1 kHz from a thread that is not ours, fits like this: the
callback writes its pose into a slot and takes the newest force from another, each slot guarded by a sequence number so
that neither side ever waits; `poses` reads the one slot, `feel` writes the other. The callback lets the force fall
where `feel` has not been called for 50 ms, because only there is the hand safe if we are gone. `open` starts the
driver and raises where it cannot, `close` first brings the force to zero; `every_tick` is true.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from trocar.contact.instrument import Vector

LEFT, RIGHT = 0, 1
"""Where each hand stands in every pair."""

FARTHEST = 1.0  # [m] of a handle from the block; farther off, the trainer takes no pose
FASTEST_TIP = 1.0  # [m/s]; nobody moves a tip faster inside a body, so a device that does has jumped


@dataclass(frozen=True, kw_only=True, slots=True)
class HandlePose:
    """How one instrument is held.

    Args:
        present: whether it is in the hand at all.
        handle: position of the handle [m].
        roll: angle about the shaft [rad].
        jaw: opening, 0 closed to 1 open.
    """

    present: bool
    handle: Vector
    roll: float
    jaw: float


Poses = tuple[HandlePose, HandlePose]
Forces = tuple[Vector, Vector]


@runtime_checkable
class Device(Protocol):
    """Hands, or what stands for them. `poses` and `feel` may be called at 1 kHz, and neither ever waits."""

    @property
    def name(self) -> str:
        """What the device is called on the command line."""
        ...

    @property
    def description(self) -> str:
        """What it is, in a few words."""
        ...

    @property
    def steered_by_page(self) -> bool:
        """Whether the browser's hands move the instruments; else the device does, and the page only shows them."""
        ...

    @property
    def every_tick(self) -> bool:
        """Whether poses are smooth at 1 kHz, so that the servo need not smooth them."""
        ...

    @property
    def duration(self) -> float:
        """How long it has something to do [s]; infinite for hands."""
        ...

    def open(self) -> None:
        """Get ready, and count time from now; a closed device may be opened again.

        Raises:
            TrocarError: it is not there, or does not answer.
        """
        ...

    def poses(self, time: float, /) -> Poses:
        """Return both poses, left and right.

        Args:
            time: since `open` [s]; a live device has only its newest poses, whatever the time.
        """
        ...

    def feel(self, forces: Forces, /) -> None:
        """Give the hands what they feel; a device without motors lets it pass.

        Args:
            forces: of each instrument on its hand, left and right [N].
        """
        ...

    def finished(self, time: float, /) -> bool:
        """Return whether nothing more will happen from `time` [s] on; hands are never finished."""
        ...

    def close(self) -> None:
        """Let go of whatever `open` took hold of; closing twice does nothing."""
        ...
