"""The finite-element reference: a layered block, static and dynamic, on scikit-fem.

    M u'' + C u' + K u + sum over branches G y = f(t),    C = sum over layers of tau K_layer

(Prony series: `branches`) on 20-node bricks with selective reduced integration (`assembly`), a quarter of the block
at a time (`parity`): small displacements and strains, isotropic layers perfectly bonded, in-plane prestress as
geometric stiffness, dead traction. Layers with a hyperelastic law follow large deformation instead, on the same bricks
(`large`, `moving`). It shares no code with the wave models it judges.
"""

from __future__ import annotations

from trocar.errors import InputError
from trocar.model import Load, Support
from trocar.reference.arguments import central_press, checked_size, checked_support
from trocar.reference.block import MeshSize, quarter_mesh
from trocar.reference.block_model import BlockModel
from trocar.reference.finite_elements import FiniteElements
from trocar.reference.mesh import Bricks
from trocar.reference.state import FEAState
from trocar.reference.stress import (
    Deformation,
    deformations,
    largest_cauchy_mises,
    largest_compression,
    largest_von_mises,
)
from trocar.tissues import Tissue


class FEASolid(BlockModel[Bricks]):
    """Solve a layered block by finite elements; a `TissueModel`.

    Args:
        tissue: the layers.
        size: sides a, b of the block [m].
        support: how the block is held, or its name.
        around: presses the mesh is made for: their footprints are finely meshed, their forces do not matter.
            Loads elsewhere are correct but coarse. None: a 1/15 of the shorter side in the middle.
        mesh: how finely.
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep.
        solver: "superlu", "pardiso" (Intel MKL, from the extra `trocar[pardiso]`) or "auto", the fastest
            installed.

    Raises:
        InputError: an argument is not possible.
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str,
        around: Load = (),
        mesh: MeshSize | None = None,
        solver: str = "auto",
        massless: bool = False,
    ) -> None:
        if tissue.large_deformation and tissue.relaxation_times:
            raise InputError(
                "tissue: prony",
                "no series beside laws for large strain",
                tissue.name,
                "finite elements remember in linear layers alone",
            )
        size, support = checked_size(size), checked_support(support)
        around = around or central_press(size)
        super().__init__(
            tissue,
            quarter_mesh(tissue, size, support, around, mesh or MeshSize()),
            FiniteElements(),
            size=size,
            support=support,
            around=around,
            solver=solver,
            massless=massless,
            large=tissue.large_deformation,
        )

    @property
    def bricks(self) -> Bricks:
        """The mesh of the quarter 0 <= x <= a/2, 0 <= y <= b/2."""
        return self._grid

    def stress(self, state: FEAState, *, prestress: bool = True) -> dict[str, float]:
        """Return the largest von Mises stress [Pa] of each layer, at the Gauss points; of Cauchy stress.

        Args:
            state: of this model.
            prestress: whether the layers' prestress is part of it, as it is of what tears them.

        Raises:
            InputError: the state carries stress in branches of a Prony series, which are not counted.
        """
        if state.memory:
            raise InputError(
                "stress", "an equilibrium, where no Prony branch bears stress", f"a state at {state.time:g} s"
            )
        largest = largest_cauchy_mises if self._large else largest_von_mises
        values = largest(self.bricks, self._tissue.layers, self._quarters(state), prestress=prestress)
        return dict(zip(self._tissue.layer_names, values, strict=True))

    def strength_ratio(self, state: FEAState) -> dict[str, float]:
        """Return the largest von Mises stress of each layer over its tensile strength [1]; torn above 1."""
        stress = self.stress(state)
        return {layer.name: stress[layer.name] / layer.tensile_strength for layer in self._tissue.layers}

    def compression(self, state: FEAState) -> dict[str, float]:
        """Return the largest share of its thickness that each layer loses anywhere [1]; 1 at most is real."""
        values = largest_compression(self.bricks, self._tissue.layers, self._quarters(state))
        return dict(zip(self._tissue.layer_names, values, strict=True))

    def deformation(self, state: FEAState) -> dict[str, Deformation]:
        """Return how far each layer is stretched and its volume changed: converged is not yet possible."""
        found = deformations(self.bricks, self._tissue.layers, self._quarters(state))
        return dict(zip(self._tissue.layer_names, found, strict=True))
