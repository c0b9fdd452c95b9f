"""A scene of a mesh: an organ of any shape, pressed where its surface looks up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import Self

import numpy as np

from trocar.contact.instrument import Instrument
from trocar.model import Support
from trocar.simulation.scene import DT, FRICTION, Scene, Tools, require_friction
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.mesh_patch import stand
from trocar.waves.mesh.mesh_tick import make_mesh_tick, picture_length
from trocar.waves.mesh.press_grid import PER_WINDOW, PressGrid, press_grid, usual_window
from trocar.waves.mesh.skin import block_of, skin
from trocar.waves.mesh.surface_modes import SurfaceModes, surface_modes
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.near_field import half_space
from trocar.waves.solid import WaveSolid
from trocar.waves.springs import NO_SPRINGS

_SITES = 4000  # over the rectangle of a fine mesh: more would take minutes and gigabytes to prepare


@dataclass(frozen=True, eq=False)
class Organ:
    """A mesh that a scene can be made of.

    Attributes:
        model: its waves.
        grid: the sites of its surface that tools press.
        modes: that answer those.
        name: what it is called.
    """

    model: WaveMesh
    grid: PressGrid
    modes: SurfaceModes
    name: str = "organ"

    @classmethod
    def of(
        cls, model: WaveMesh, *, name: str = "organ", progress: Callable[[int, int], None] | None = None
    ) -> Self:
        """Prepare a mesh; the model's cache is looked in first.

        Args:
            model: its first surface is pressed.
            name: what it is called.
            progress: told how many systems of equations are solved, and of how many.

        Raises:
            InputError: nothing of it looks up, it has too many sites, or its materials damp differently or remember.
            SolverError: it is not held.
        """
        surface = model.layer_names[0]
        widest = PER_WINDOW * sqrt(model.size[0] * model.size[1] / _SITES)
        window = max(usual_window(model.elements, surface), widest)
        grid = press_grid(model.elements, surface, window=window)
        return cls(model, grid, surface_modes(model, grid, progress=progress), name)

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        return self.model.size

    @cached_property
    def skin(self) -> Layer:
        """The material that most of the pressed surface is made of."""
        return skin(self.model.mesh, self.grid.surface)

    @property
    def thickness(self) -> float:
        """From the lowest to the highest point [m]."""
        return self.model.mesh.thickness

    @cached_property
    def block(self) -> Tissue:
        """A flat block of the surface's material as thick as the organ: what the surface is like close by."""
        return block_of(self.model.mesh, self.grid.surface, self.name)


def surface_heights(scene: Scene) -> Callable[[float, float], float]:
    """Return a function of x and y [m] that tells how high an organ's surface lies at rest [m].

    Beside what looks up it tells the height of the highest place, 0.

    Args:
        scene: of an organ.
    """
    cubic, frame = np.zeros(8), np.zeros((4, 3))

    def height(x: float, y: float) -> float:
        return float(frame[0, 2]) if stand(scene.tick, x, y, cubic, frame) else 0.0

    return height


def make_organ_scene(
    organ: Organ,
    instruments: tuple[Instrument, Instrument],
    *,
    dt: float = DT,
    friction: float = FRICTION,
) -> Scene:
    """Lay out a scene of an organ.

    Args:
        organ: the tissue.
        instruments: left, right.
        dt: length of a tick [s].
        friction: coefficient [1].

    Raises:
        InputError: a number is impossible.
    """
    require_friction(friction)
    tools = Tools.of(instruments)
    tick = make_mesh_tick(organ.modes, organ.grid, dt, offsets=tools.offsets)
    near = tools.near(lambda finest: half_space(organ.skin), organ.grid.window)
    return Scene(
        tick=tick,
        ports=tools.ports,
        lengths=tools.lengths,
        axes=tools.axes,
        middles=tools.middles,
        holds=tools.holds,
        near=near,
        own=near,
        give=tools.give(WaveSolid(organ.block, size=organ.size, support=Support.BASE)),
        friction=friction,
        dt=dt,
        modes=(1, picture_length(tick)),
        layers=1,
        springs=NO_SPRINGS,
    )
