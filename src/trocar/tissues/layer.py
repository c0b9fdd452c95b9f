"""One layer of tissue: an elastic slab with a law that damps and remembers, with in-plane prestress.

Its relaxation modulus is a Prony series (generalised Maxwell model; Christensen 1982, Theory of Viscoelasticity,
ch. 1) relative to the long-term modulus, at a constant Poisson's ratio,

    E(t) = E (1 + sum over i of g_i exp(-t/tau_i)),

beside a Kelvin-Voigt damping C = tau K. A prestress neither relaxes nor damps.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, isfinite, pi

from trocar.errors import InputError
from trocar.tissues.law import LINEAR, Law

Prony = tuple[tuple[float, float], ...]
"""Terms (g, tau) of a Prony series: weight [1] and relaxation time [s]."""

MOST_TERMS = 8  # of one layer, and relaxation times of one tissue: each is a state of every mode
LARGEST_WEIGHT = 1e3  # [1]
GIVE_LONG_TERM = "g is relative to the long-term modulus"
SHORTEST_TIME, LONGEST_TIME = 1e-5, 1e5  # [s] relaxation times


@dataclass(frozen=True, kw_only=True)
class Layer:
    """Describe one layer.

    Args:
        name: what the layer is called; unique within a tissue.
        thickness: [m].
        young_modulus: [Pa]; the long-term one where there is a Prony series.
        poisson_ratio: [1], at least 0 and below 0.5.
        density: [kg/m3].
        prestress_x: normal stress along x in the rest state [Pa], tension positive.
        prestress_y: the same along y [Pa].
        loss_factor: tangent of the loss angle at `loss_frequency` [1]; 0 means undamped.
        loss_frequency: the frequency the loss factor was measured at [Hz].
        prony: terms (g, tau) of the relaxation modulus: weight relative to the long-term modulus [1], 0 or above,
            and relaxation time [s], each time once; empty where the layer does not remember.
        tensile_strength: stress at which the layer tears [Pa]; infinite where unknown.
        law: how stress follows from stretch; waves take it as linear, or stiffen with the sheet above the lowest layer.

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
    prony: Prony = ()
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
        self._check_prony()

    def _key(self, key: str) -> str:
        return f"layer {self.name!r}: {key}"

    def _require(self, key: str, holds: bool, expected: str, advice: str = "") -> None:
        value = getattr(self, key)
        if not (isfinite(value) and holds):
            raise InputError(self._key(key), expected, value, advice)

    def _check_prony(self) -> None:
        try:
            terms = tuple((float(weight), float(time)) for weight, time in self.prony)
        except (TypeError, ValueError):
            raise InputError(self._key("prony"), "pairs of numbers (g, tau)", self.prony) from None
        object.__setattr__(self, "prony", terms)
        if len(self.prony) > MOST_TERMS:
            raise InputError(self._key("prony"), f"at most {MOST_TERMS} terms", len(self.prony))
        for i, (weight, time) in enumerate(self.prony):
            if not 0 <= weight <= LARGEST_WEIGHT:
                raise InputError(
                    self._key(f"prony[{i}]: g"),
                    f"a number from 0 to {LARGEST_WEIGHT:g}",
                    weight,
                    GIVE_LONG_TERM,
                )
            if not SHORTEST_TIME <= time <= LONGEST_TIME:
                raise InputError(
                    self._key(f"prony[{i}]: tau"),
                    f"a time from {SHORTEST_TIME:g} to {LONGEST_TIME:g} s",
                    time,
                )
        times = [time for _, time in self.prony]
        if len(set(times)) != len(times):
            raise InputError(self._key("prony"), "every tau once", times, "add the weights of equal times")

    def relaxing(self, time: float) -> float:
        """Return the weight g of a relaxation time [s]; 0 where the layer has no such term."""
        return sum(weight for weight, own in self.prony if own == time)

    @property
    def instantaneous_modulus(self) -> float:
        """Young's modulus under a sudden load, E (1 + sum of g) [Pa]."""
        return self.young_modulus * (1 + sum(weight for weight, _ in self.prony))

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


def relaxation_times(layers: Iterable[Layer], what: str) -> tuple[float, ...]:
    """Return the different times of layers' Prony series, ascending [s]; empty where no layer remembers.

    Args:
        layers: of one tissue.
        what: the tissue's name in messages.

    Raises:
        InputError: there are too many.
    """
    times = tuple(sorted({time for layer in layers for weight, time in layer.prony if weight > 0}))
    if len(times) > MOST_TERMS:
        raise InputError(
            f"{what}: prony",
            f"at most {MOST_TERMS} different times in all layers together",
            len(times),
            "let layers share their times",
        )
    return times
