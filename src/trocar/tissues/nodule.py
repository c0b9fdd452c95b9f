"""A nodule: a ball of stiffer tissue within a layer, found by feel."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from trocar.errors import InputError
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue

MOST_NODULES = 4  # in one block


@dataclass(frozen=True, kw_only=True)
class Nodule:
    """Put a ball of another stiffness into a tissue.

    Args:
        x, y: where its centre lies, seen from above [m].
        depth: of its centre below the surface [m].
        radius: [m].
        young_modulus: of small strain [Pa].
        poisson_ratio: below 0.5.

    Raises:
        InputError: a number is impossible, or it would reach the surface.
    """

    x: float
    y: float
    depth: float
    radius: float
    young_modulus: float
    poisson_ratio: float = 0.48

    def __post_init__(self) -> None:
        for name in ("x", "y", "depth", "radius", "young_modulus"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InputError(f"nodule: {name}", "a finite number above 0", value)
        if not 0 <= self.poisson_ratio < 0.5:
            raise InputError("nodule: poisson_ratio", "from 0 to below 0.5", self.poisson_ratio)
        if self.radius >= self.depth:
            raise InputError(
                "nodule: radius", f"less than its depth, {1e3 * self.depth:g} mm", f"{1e3 * self.radius:g} mm"
            )

    @property
    def shear_modulus(self) -> float:
        """G [Pa]."""
        return self.young_modulus / (2 * (1 + self.poisson_ratio))

    @property
    def bulk_modulus(self) -> float:
        """K [Pa]."""
        return self.young_modulus / (3 * (1 - 2 * self.poisson_ratio))

    def host(self, tissue: Tissue, size: tuple[float, float]) -> Layer:
        """Return the layer it lies in.

        Args:
            tissue: the layers.
            size: sides of the block [m].

        Raises:
            InputError: it is not wholly in one layer of the block, or not stiffer than that.
        """
        for name, place, side in (("x", self.x, size[0]), ("y", self.y, size[1])):
            if not self.radius < place < side - self.radius:
                raise InputError(
                    f"nodule: {name}",
                    f"one that keeps the nodule inside, between {1e3 * self.radius:g} and "
                    f"{1e3 * (side - self.radius):g} mm",
                    f"{1e3 * place:g} mm",
                )
        upper = 0.0
        for layer in tissue.layers:
            lower = upper + layer.thickness
            if upper <= self.depth - self.radius and self.depth + self.radius <= lower:
                if not (self.shear_modulus > layer.shear_modulus and self.bulk_modulus > layer.bulk_modulus):
                    raise InputError(
                        "nodule: young_modulus",
                        f"a nodule stiffer than {layer.name}, in shear as in volume",
                        f"{1e-3 * self.young_modulus:g} kPa in {1e-3 * layer.young_modulus:g} kPa",
                    )
                return layer
            upper = lower
        raise InputError(
            "nodule: depth",
            f"one that leaves it wholly in one of the layers ({', '.join(tissue.layer_names)})",
            f"{1e3 * (self.depth - self.radius):g} to {1e3 * (self.depth + self.radius):g} mm below the surface",
        )
