"""Phantoms: organs that Trocar makes, cast of one layer of a preset, small enough to be ready in seconds."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from trocar.errors import InputError
from trocar.simulation.live_organ import live_organ
from trocar.simulation.organ import Organ
from trocar.tissues.catalogue import tissue
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.solid_mesh import SolidMesh


@dataclass(frozen=True, kw_only=True)
class Phantom:
    """A cast organ.

    Attributes:
        name: what it is called.
        tissue: the preset one of whose layers it is cast of.
        layer: name of that layer.
        shape: of it.
        spacing: of its elements' nodes [m].
    """

    name: str
    tissue: str
    layer: str
    shape: Liver = field(default_factory=Liver)
    spacing: float

    @property
    def material(self) -> Layer:
        """What it is cast of.

        Raises:
            InputError: the preset has no such layer.
        """
        layers = {layer.name: layer for layer in tissue(self.tissue).layers}
        if self.layer not in layers:
            raise InputError(f"{self.name}: layer", " or ".join(layers), self.layer)
        return layers[self.layer]

    @property
    def stuff(self) -> Tissue:
        """The material as a tissue of its own."""
        return Tissue(layers=(self.material,), name=self.name)

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        x, y = np.ptp(_mesh(self).corners[:, :2], axis=0).tolist()
        return x, y

    @property
    def organ(self) -> Organ:
        """What a scene is made of; what takes long is kept on disk."""
        return _organ(self)


@lru_cache(maxsize=4)
def _mesh(phantom: Phantom) -> SolidMesh:
    linear = Tissue(layers=(phantom.material,), name=phantom.name).linearised.layers[0]
    return phantom.shape.mesh(linear, spacing=phantom.spacing)


@lru_cache(maxsize=4)
def _organ(phantom: Phantom) -> Organ:
    return live_organ(_mesh(phantom), name=phantom.name)
