"""One layer of tissue: an elastic slab with a law, Kelvin-Voigt damping and in-plane prestress."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, pi

from trocar.errors import InputError
from trocar.tissues.law import LINEAR, Law


@dataclass(frozen=True, kw_only=True)
class Layer:
    """Describe one layer.

    Args:
        name: what the layer is called; unique within a tissue.
        thickness: [m].
        young_modulus: [Pa].
        poisson_ratio: [1], at least 0 and below 0.5.
        density: [kg/m3].
        prestress_x: normal stress along x in the rest state [Pa], tension positive.
        prestress_y: the same along y [Pa].
        loss_factor: tangent of the loss angle at `loss_frequency` [1]; 0 means undamped.
        loss_frequency: the frequency the loss factor was measured at [Hz].
        tensile_strength: stress at which the layer tears [Pa]; infinite where unknown.
        law: how stress follows from stretch; the wave models take every law as linear.

    Raises:
        InputError: a value is not finite or not possible.
    """

    name: str
    thickness: float
    young_modulus: float
    poisson_ratio: float
    density: float
    prestress_x: float = 0.0
    prestress_y: float = 0.0
    loss_factor: float = 0.0
    loss_frequency: float = 50.0
    tensile_strength: float = inf
    law: Law = LINEAR

    def __post_init__(self) -> None:
        if not self.name:
            raise InputError("layer: name", "a name", self.name)
        for key in ("thickness", "young_modulus", "density", "loss_frequency"):
            self._require(key, getattr(self, key) > 0, "a finite number above 0")
        for key in ("prestress_x", "prestress_y", "loss_factor"):
            self._require(key, getattr(self, key) >= 0, "a finite number, 0 or above")
        self._require(
            "poisson_ratio",
            0 <= self.poisson_ratio < 0.5,
            "a number at least 0 and below 0.5",
            "use 0.499 for nearly incompressible tissue" if self.poisson_ratio >= 0.5 else "",
        )
        if not self.tensile_strength > 0:
            raise InputError(self._key("tensile_strength"), "a number above 0", self.tensile_strength)

    def _key(self, key: str) -> str:
        return f"layer {self.name!r}: {key}"

    def _require(self, key: str, holds: bool, expected: str, advice: str = "") -> None:
        value = getattr(self, key)
        if not (isfinite(value) and holds):
            raise InputError(self._key(key), expected, value, advice)

    @property
    def shear_modulus(self) -> float:
        """Lame's second parameter mu = E / (2 (1 + nu)) [Pa]."""
        return self.young_modulus / (2 * (1 + self.poisson_ratio))

    @property
    def lame_lambda(self) -> float:
        """Lame's first parameter lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]."""
        nu = self.poisson_ratio
        return self.young_modulus * nu / ((1 + nu) * (1 - 2 * nu))

    @property
    def bulk_modulus(self) -> float:
        """K = E / (3 (1 - 2 nu)) [Pa]."""
        return self.young_modulus / (3 * (1 - 2 * self.poisson_ratio))

    @property
    def retardation_time(self) -> float:
        """Kelvin-Voigt time tau = loss_factor / (2 pi loss_frequency) [s]: damping C = tau K."""
        return self.loss_factor / (2 * pi * self.loss_frequency)
