"""What every tissue model is: loads in, states out, time moved only by `step`.

A load is a set of presses. A press spreads a force over a footprint on the top face, z = 0; z points out of
the tissue, so pushing in means a negative z component and a negative u_z. The block covers 0 <= x <= a,
0 <= y <= b.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from math import cos, isfinite, pi, sin
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError

FloatArray = npt.NDArray[np.float64]


class Support(StrEnum):
    """How the block is held."""

    EDGES = "edges"  # sides clamped, base free (the 2014 paper)
    EDGES_AND_BASE = "edges+base"  # sides clamped, base held
    BASE = "base"  # base held, sides simply supported: a piece of wider tissue

    @property
    def base_held(self) -> bool:
        """Whether the lower face cannot move."""
        return self is not Support.EDGES

    @property
    def sides_clamped(self) -> bool:
        """Whether the sides cannot move at all; else their tangential and vertical displacement is zero."""
        return self is not Support.BASE


class Profile(StrEnum):
    """How a press spreads over its footprint."""

    FLAT = "flat"  # uniform
    SPHERE = "sphere"  # Hertz: sqrt(1 - r^2/R^2)
    GAUSSIAN = "gaussian"  # exp(-2 r^2/R^2): R is two standard deviations


@dataclass(frozen=True, kw_only=True)
class Press:
    """A force spread over a tool's footprint as dead traction.

    A tool tilted by `tilt` leaves an ellipse: semi-axis radius/cos(tilt) along the azimuth, radius across it.
    The force acts along the tool's axis: cos(tilt) of it presses in, sin(tilt) drags along the azimuth.

    Args:
        x, y: centre of the footprint on the top face [m].
        radius: of the tool's tip [m].
        force: along the tool's axis [N]; positive presses in.
        profile: how the traction is spread.
        tilt: from the surface normal [rad], 0 to below pi/2.
        azimuth: of the tangential part, from +x towards +y [rad].

    Raises:
        InputError: a value is not finite or not possible.
    """

    x: float
    y: float
    radius: float
    force: float
    profile: Profile = Profile.FLAT
    tilt: float = 0.0
    azimuth: float = 0.0

    def __post_init__(self) -> None:
        for key in ("x", "y", "radius", "force", "tilt", "azimuth"):
            if not isfinite(getattr(self, key)):
                raise InputError(f"press: {key}", "a finite number", getattr(self, key))
        if self.radius <= 0:
            raise InputError("press: radius", "a number above 0", self.radius)
        if not 0 <= self.tilt < pi / 2:
            raise InputError("press: tilt", "an angle at least 0 and below pi/2", self.tilt)

    @property
    def semi_axes(self) -> tuple[float, float]:
        """Semi-axes of the footprint along and across the azimuth [m]."""
        return self.radius / cos(self.tilt), self.radius

    @property
    def force_vector(self) -> tuple[float, float, float]:
        """Force on the tissue (x, y, z) [N]."""
        drag = self.force * sin(self.tilt)
        return drag * cos(self.azimuth), drag * sin(self.azimuth), -self.force * cos(self.tilt)

    def with_force(self, force: float) -> Press:
        """Return the same press with another force [N]."""
        return replace(self, force=force)


Load = tuple[Press, ...]


class State(Protocol):
    """What a model remembers between steps; each model has its own frozen kind."""

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        ...


S = TypeVar("S", bound=State)


@runtime_checkable
class TissueModel(Protocol[S]):
    """A tissue that can be loaded, stepped and looked at."""

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the layers, top first."""
        ...

    @property
    def size(self) -> tuple[float, float]:
        """Sides a, b of the block along x and y [m]."""
        ...

    @property
    def support(self) -> Support:
        """How the block is held."""
        ...

    @property
    def dofs(self) -> int:
        """Unknowns solved for by the loads so far."""
        ...

    @property
    def longest_step(self) -> float:
        """The longest step that still follows a moving tissue [s]; infinite where the step is exact."""
        ...

    def init(self) -> S:
        """Return the state at rest at time 0."""
        ...

    def step(self, state: S, load0: Load, load1: Load, dt: float) -> S:
        """Advance by dt [s] under a load going linearly from load0 to load1.

        Presses are paired in order; the two loads must hold equally many.
        """
        ...

    def static(self, load: Load) -> S:
        """Return the equilibrium under a constant load."""
        ...

    def displacement(self, state: S, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m], shape (n, 3), of a layer's upper face (None: the top layer's).

        Args:
            state: of this model.
            points: rest positions [m], shape (n, 3); only x and y are used, the face gives z.
            layer: name of the layer.
        """
        ...
