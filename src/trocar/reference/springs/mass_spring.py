"""The mass-spring model: a layered block as a lattice of Kelvin-Voigt springs between lumped masses.

    M u'' + (dashpots) + dW/du = f(t),    W = sum over springs of what they store

Springs and their constants: `elements`; what they store: `energies`. The springs turn with the tissue, so large
displacement is followed with the moduli of small strain; for small loads the model is linear, and with `linearised` it
is so for all. Grid, presses, supports, Newton's method and the step in time are those of `FEASolid`.
"""

from __future__ import annotations

import numpy as np

from trocar.errors import InputError
from trocar.model import Load, Support
from trocar.reference.arguments import central_press, checked_size, checked_support
from trocar.reference.block import MeshSize, quarter_mesh
from trocar.reference.block_model import BlockModel
from trocar.reference.springs.boxes import Boxes
from trocar.reference.springs.lattice import DeformedLattice, Lattice
from trocar.reference.state import FEAState
from trocar.reference.stress import Deformation
from trocar.tissues import Linear, NeoHookean, Tissue

PER_RADIUS = 8.0
"""Boxes along a footprint's half width where nothing is said; `bench/springs.py` prints what that is worth."""


def lattice_size(per_radius: float = PER_RADIUS) -> MeshSize:
    """Return a mesh size of which every length is inversely proportional to the boxes along a footprint's half width.

    Raises:
        InputError: the number is not possible.
    """
    if not (np.isfinite(per_radius) and per_radius > 0):
        raise InputError("mesh: per_radius", "a finite number above 0", per_radius)
    return MeshSize(
        per_radius=per_radius,
        growth=2.0 / per_radius,
        top=0.5 / per_radius,
        deepening=1.4 / per_radius,
        side=0.6 / per_radius,
    )


class MassSpring(BlockModel[Boxes]):
    """Solve a layered block by a lattice of springs; a `TissueModel`.

    Args:
        tissue: the layers; of the laws, linear and neo-Hookean: either gives the springs their small-strain moduli.
        size: sides a, b of the block [m].
        support: how the block is held, or its name.
        around: presses the lattice is made for: their footprints are finely resolved, their forces do not matter.
            None: a 1/15 of the shorter side in the middle.
        mesh: how finely; see `lattice_size`.
        linearised: takes displacements as small, so that springs do not turn and equilibria scale with the load.
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep.
        solver: "superlu", "pardiso" (Intel MKL, from the extra `trocar[pardiso]`) or "auto", the fastest
            installed.

    Raises:
        InputError: an argument is not possible, or springs cannot follow a layer's law.
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str,
        around: Load = (),
        mesh: MeshSize | None = None,
        linearised: bool = False,
        massless: bool = False,
        solver: str = "auto",
    ) -> None:
        for layer in tissue.layers:
            if not isinstance(layer.law, Linear | NeoHookean):
                raise InputError(
                    f"layer {layer.name!r}: law",
                    "linear or neo-hookean, for springs",
                    type(layer.law).__name__.lower(),
                    "springs have no more than moduli; take FEASolid for this law",
                )
        if tissue.relaxation_times and not linearised:
            raise InputError(
                "tissue: prony",
                "no series where springs turn",
                tissue.name,
                "take linearised=True: springs remember about the body at rest alone",
            )
        size, support = checked_size(size), checked_support(support)
        around = around or central_press(size)
        lines = quarter_mesh(tissue, size, support, around, mesh or lattice_size())
        super().__init__(
            tissue,
            Boxes(x=lines.x, y=lines.y, z=lines.z, slab_layer=lines.slab_layer),
            Lattice(),
            size=size,
            support=support,
            around=around,
            solver=solver,
            massless=massless,
            large=not linearised,
        )

    @property
    def boxes(self) -> Boxes:
        """The lattice of the quarter 0 <= x <= a/2, 0 <= y <= b/2."""
        return self._grid

    def deformation(self, state: FEAState) -> dict[str, Deformation]:
        """Return how far each layer's boxes are stretched and their volume changed, on the mean over each box."""
        lattice = DeformedLattice(self.boxes, self._tissue.layers, np.arange(0))
        gradients = np.stack([lattice.gradients(field) for field in self._quarters(state)])
        found = {}
        for number, name in enumerate(self._tissue.layer_names):
            here = gradients[:, self.boxes.element_layer == number].reshape(-1, 3, 3)
            stretch, volume = np.linalg.svd(here, compute_uv=False), np.linalg.det(here)
            found[name] = Deformation(
                stretch=(float(stretch.min()), float(stretch.max())),
                volume_ratio=(float(volume.min()), float(volume.max())),
            )
        return found
