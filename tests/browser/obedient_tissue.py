"""A tissue of a few lines that only obeys: it follows a tip down, is dragged along, and comes up with a closed jaw.

No physics: what a tip does is laid over the block as one smooth bump, so that a page has something to draw whose every
number a test can say beforehand. A negative depth lifts the tissue to a tent.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

SIZE = 0.06  # of the square block [m]
NODES = 64
DEEPEST = 0.009  # a tip is followed down so far [m]
STIFFNESS = 120.0  # [N/m]
DRAGGED = 0.4  # how far the surface goes with a sliding tip, in depths of the tip
CLOSED = 0.2  # a jaw closed so far takes hold of what it touches

PRESENT, TOUCHING, HOLDING = 1, 2, 4  # bits of an instrument's flags


@dataclass
class Touch:
    """What one tip does to the tissue.

    Args:
        place: rest place of the tissue it acts on, x and y [m]; None while it is free.
        holding: whether a jaw is closed on it.
        flags: as they go into a frame.
        depth: of the tip below the rest surface, negative above it [m].
        force: of the tissue on the tip [N].
        displacement: of the tissue at the place [m].
    """

    place: np.ndarray | None = None
    holding: bool = False
    flags: int = PRESENT
    depth: float = 0.0
    force: np.ndarray = field(default_factory=lambda: np.zeros(3))
    displacement: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def follow(self, tip: np.ndarray, jaw: float) -> None:
        """Move to where a tip is [m] with its jaw so far open."""
        over = bool(np.all((tip[:2] > 0) & (tip[:2] < SIZE)))
        touching = over and tip[2] < 0
        self.holding = jaw < CLOSED and (self.holding or (touching and self.place is not None))
        if not self.holding:
            if not touching:
                self.place = None
            elif self.place is None:
                self.place = tip[:2].copy()
            else:  # the surface sticks to the tip as far as it can, and then slips under it
                drag = tip[:2] - self.place
                most = DRAGGED * min(-tip[2], DEEPEST)
                self.place = tip[:2] - drag * min(1.0, most / max(float(np.hypot(*drag)), 1e-12))
        self.depth = float(np.clip(-tip[2], -DEEPEST, DEEPEST)) if self.place is not None else 0.0
        drag = tip[:2] - self.place if self.place is not None else np.zeros(2)
        self.displacement = np.array([*drag, -self.depth])
        self.force = -STIFFNESS * self.displacement
        self.flags = PRESENT | (TOUCHING if self.place is not None else 0) | (HOLDING if self.holding else 0)

    def moved(self) -> np.ndarray:
        """Return the displacement x, y, z [m] at every node, shape (3, ny, nx)."""
        if self.place is None:
            return np.zeros((3, NODES, NODES))
        return self.displacement[:, None, None] * bump(*self.place)


def bump(at_x: float, at_y: float) -> np.ndarray:
    """Return a smooth bump of height one at a place [m], zero at the edges: narrow on top, with wide flanks."""
    x = np.linspace(0, SIZE, NODES)
    squared = (x[None, :] - at_x) ** 2 + (x[:, None] - at_y) ** 2
    edge = np.minimum(x, SIZE - x) / SIZE * 20
    held = np.clip(np.minimum(edge[None, :], edge[:, None]), 0, 1)
    return held * (0.6 * np.exp(-squared / (2 * 0.004**2)) + 0.4 * np.exp(-squared / (2 * 0.010**2)))
