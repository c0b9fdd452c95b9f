"""What a taut sheet is: a film that was stretched alike in all directions and clipped to a frame all round."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import isfinite, pi, sqrt

from trocar.errors import InputError

POISSON_RATIO = 1 / 3  # of every lattice of links that push and pull along themselves (`lattice`)
_MOST_STRETCH = 0.2  # beyond it, what is linear here is not


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """A film in a frame; its Poisson ratio is a third.

    Attributes:
        size: sides of the frame [m].
        thickness: of the film as it is clipped [m].
        young_modulus: [Pa].
        density: [kg/m^3].
        stretch: by which it was lengthened in all directions before it was clipped [1].
        along: how long what stretches in its plane lags behind, Kelvin-Voigt [s].
        across: the same of what goes up and down [s].
        drag: of the air and the like, for each kilogram [1/s].
        cells: of the lattice along x, along y as many to the length.
    """

    size: tuple[float, float] = (0.06, 0.06)
    thickness: float = 1.5e-3
    young_modulus: float = 8e4
    density: float = 1070.0
    stretch: float = 0.05
    along: float = 1e-5
    across: float = 2e-4
    drag: float = 10.0
    cells: int = 40

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            least = 0.0 if one.name in ("along", "across", "drag") else 1e-12
            for number in value if isinstance(value, tuple) else (value,):
                if not (isfinite(number) and number >= least):
                    raise InputError(f"sheet: {one.name}", "a finite number above 0", value)
        if self.stretch > _MOST_STRETCH:
            raise InputError("sheet: stretch", f"at most {_MOST_STRETCH:g}", self.stretch)
        rows = self.size[1] / self.spacing
        if not 4 <= self.cells <= 400 or abs(rows - round(rows)) > 1e-9 * rows or rows < 3.5:
            raise InputError(
                "sheet: cells",
                "4 to 400, so that squares as wide fill its other side too",
                self.cells,
            )

    @property
    def spacing(self) -> float:
        """Of the nodes along x and y [m]."""
        return self.size[0] / self.cells

    @property
    def nodes(self) -> tuple[int, int]:
        """How many along x and y, rim included."""
        return self.cells + 1, round(self.size[1] / self.spacing) + 1

    @property
    def stiffness(self) -> float:
        """Young's modulus times thickness [N/m]."""
        return self.young_modulus * self.thickness

    @property
    def tension(self) -> float:
        """Force on each metre of a side, E h e/(1 - nu) of a film lengthened in both directions [N/m]."""
        return self.stiffness * self.stretch / (1 - POISSON_RATIO)

    def linear_force(self, radius: float) -> float:
        """Return the force under which the dent of a tip stretches the sheet at its rim by half of what it is [N].

        A membrane's slope there is s = F/(2 pi r T), and the stretch that it adds s^2/2.

        Args:
            radius: of the tip [m].
        """
        return 2 * pi * radius * self.tension * sqrt(self.stretch)

    @property
    def wave_speed(self) -> float:
        """Of waves up and down, sqrt(T/(rho h)) [m/s]."""
        return sqrt(self.tension / (self.density * self.thickness))
