"""A tissue: bonded layers, top first, resting on whatever the model's support says."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trocar.errors import InputError
from trocar.tissues.law import LINEAR, Linear
from trocar.tissues.layer import Layer, relaxation_times


@dataclass(frozen=True, kw_only=True)
class Tissue:
    """Bond layers into a tissue.

    Args:
        layers: top (the side the tool touches) first; at least one; names unique.
        name: what the tissue is called in reports.

    Raises:
        InputError: there is no layer, two share a name, only some of them have a linear law, or there are too many
            different relaxation times.
    """

    layers: tuple[Layer, ...]
    name: str = "tissue"

    def __post_init__(self) -> None:
        if not self.layers:
            raise InputError(f"tissue {self.name!r}: layers", "at least one layer", self.layers)
        names = self.layer_names
        if len(set(names)) != len(names):
            raise InputError(f"tissue {self.name!r}: layers", "every name once", names)
        relaxation_times(self.layers, f"tissue {self.name!r}")
        linear = [layer.name for layer in self.layers if isinstance(layer.law, Linear)]
        if 0 < len(linear) < len(self.layers):
            raise InputError(
                f"tissue {self.name!r}: law",
                "every layer linear or none: a block deforms little or much as a whole",
                f"linear {', '.join(linear)} beside others",
                "take neo-hookean for the linear layers",
            )

    @property
    def large_deformation(self) -> bool:
        """Whether the layers' laws hold at large strain, so that finite elements follow large deformation."""
        return not isinstance(self.layers[0].law, Linear)

    @property
    def linearised(self) -> Tissue:
        """The same layers at small strain, their fibres left out."""
        return replace(self, layers=tuple(replace(layer, law=LINEAR) for layer in self.layers))

    @property
    def long_term(self) -> Tissue:
        """The same layers once all that relaxes has relaxed, their Prony series left out."""
        return replace(self, layers=tuple(replace(layer, prony=()) for layer in self.layers))

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the layers, top first."""
        return tuple(layer.name for layer in self.layers)

    @property
    def thickness(self) -> float:
        """Thickness of all layers together [m]."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """The different times of the layers' Prony series, ascending [s]; empty where no layer remembers."""
        return relaxation_times(self.layers, f"tissue {self.name!r}")

    def index(self, layer: str | None) -> int:
        """Return the place of a layer by name; None means the top one.

        Raises:
            InputError: no layer has this name.
        """
        if layer is None:
            return 0
        if layer not in self.layer_names:
            raise InputError("layer", f"one of {', '.join(self.layer_names)}", layer)
        return self.layer_names.index(layer)
