"""A layered block as MuJoCo's soft bodies ("flexes"), one a layer, that share the nodes between them.

Tetrahedra are piecewise linear, St. Venant-Kirchhoff or (an experiment of MuJoCo's) stable neo-Hookean; boxes have 8 or
27 nodes and are linear, each turned with its own rotation. Time goes by the `discrete` integrator, the only one that
takes stiffness implicitly: (M + h D + h^2 K) a = f(q, v) - h K v, with D = tau K (MuJoCo 4.0, Computation,
"Numerical integration"), solved by conjugate gradients to its default 1e-8. An equilibrium is that step with a long h
from rest, over and over: Newton's method.
"""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np
from engine_meshes import Lattice, Tetrahedra

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.tissues import Tissue

_MASS = (
    1e6  # milligrams in a kilogram: MuJoCo takes accelerations as nought where squared forces add up to 1e-15
)
_LONG = 0.03  # [s], beside which inertia is little
_ROUGH, _FINE = (
    1e-4,
    1e-8,
)  # of the residual: what a round towards rest is solved to, and a step; the latter MuJoCo's own
_ROUNDS_OF_SOLVER = 20_000  # of conjugate gradients; MuJoCo's 100 leave fine meshes unsolved
_MOST_ROUNDS = 60
_STILL = 1e-5  # of the largest displacement: what a round may change at most in the end


class MujocoFlex:
    """A block that MuJoCo moves.

    Args:
        tissue: the layers; prestress is left out.
        mesh: of the whole block.
        neo_hookean: whether tetrahedra follow the stable neo-Hookean law.
    """

    def __init__(self, tissue: Tissue, mesh: Lattice, *, neo_hookean: bool = False) -> None:
        self.mesh = mesh
        self.layer_names = tissue.layer_names
        spec = mujoco.MjSpec.from_string(_model(tissue, mesh))
        for flex in spec.flexes:
            flex.elastic3d = int(neo_hookean)
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        mujoco.set_mju_user_warning(lambda words: None)  # `_go` tells of it; else a log file is left behind
        self._free = ~mesh.held

    @property
    def dofs(self) -> int:
        """Unknowns."""
        return int(self._model.nv)

    def rest(self, forces: FloatArray) -> FloatArray:
        """Go to equilibrium from where the block is now, and return the displacements of the nodes [m].

        Args:
            forces: on the nodes [N], shape (nodes, 3).

        Raises:
            SolverError: it does not come to rest.
        """
        data, change = self._data, np.inf
        self._push(forces, _LONG)
        self._model.opt.tolerance = _ROUGH
        for _ in range(_MOST_ROUNDS):
            before = data.qpos.copy()
            data.qvel[:] = 0.0
            self._go()
            largest = np.abs(data.qpos).max()
            change = np.abs(data.qpos - before).max() / largest if largest > 0 else np.inf
            if change < _STILL:
                return self.displacement()
        raise SolverError(f"MuJoCo comes to no rest: the last of {_MOST_ROUNDS} rounds changed {change:.1g}")

    def step(self, forces: FloatArray, dt: float) -> None:
        """Go on by dt [s] under forces on the nodes [N], shape (nodes, 3)."""
        self._push(forces, dt)
        self._model.opt.tolerance = _FINE
        self._go()

    def displacement(self) -> FloatArray:
        """Return the displacements of the nodes [m], shape (nodes, 3)."""
        result = np.zeros((len(self._free), 3))
        result[self._free] = self._data.qpos.reshape(-1, 3)
        return result

    def _go(self) -> None:
        mujoco.mj_step(self._model, self._data)
        told = [name for name, kind in mujoco.mjtWarning.__members__.items() if self._warned(int(kind))]
        if told:
            raise SolverError(f"MuJoCo gave up at {self._data.time:g} s: {', '.join(told)}")

    def _warned(self, kind: int) -> bool:
        return kind < int(mujoco.mjtWarning.mjNWARNING) and self._data.warning[kind].number > 0

    def _push(self, forces: FloatArray, dt: float) -> None:
        self._model.opt.timestep = dt
        self._data.qfrc_applied[:] = _MASS * forces[self._free].ravel()


def _model(tissue: Tissue, mesh: Lattice) -> str:
    """Return the block in MuJoCo's XML: a body with three slides for every free node."""
    return "".join(
        (
            '<mujoco><compiler boundmass="0" boundinertia="0"/>',
            f'<option integrator="discrete" gravity="0 0 0" iterations="{_ROUNDS_OF_SOLVER}">',
            '<flag contact="disable"/></option>',
            "<worldbody>",
            *_bodies(tissue, mesh),
            "</worldbody><deformable>",
            *(_flex(tissue, mesh, layer) for layer in range(len(tissue.layers))),
            "</deformable></mujoco>",
        )
    )


def _bodies(tissue: Tissue, mesh: Lattice) -> Iterator[str]:
    slides = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
    for number, (place, mass) in enumerate(zip(mesh.nodes.T, mesh.masses(tissue), strict=True)):
        if not mesh.held[number]:
            inertia = f'<inertial pos="0 0 0" mass="{_MASS * mass:.17g}" diaginertia="1e-9 1e-9 1e-9"/>'
            yield f'<body name="n{number}" pos="{_words(place)}">{inertia}{slides}</body>'


def _flex(tissue: Tissue, mesh: Lattice, layer: int) -> str:
    own = mesh.layer_nodes(layer)
    held = mesh.held[own]
    names = " ".join("world" if fixed else f"n{number}" for number, fixed in zip(own, held, strict=True))
    places = _words(np.where(held, mesh.nodes[:, own], 0.0).T)
    if isinstance(mesh, Tetrahedra):
        chosen = mesh.tetrahedra[mesh.tetrahedron_layer == layer]
        new = np.full(len(mesh.held), -1)
        new[own] = np.arange(len(own))
        body = f'body="{names}" vertex="{places}" element="{_words(new[chosen])}"'
    else:
        body = _boxes(mesh, layer, names, places)
    stuff = tissue.layers[layer]
    return (
        f'<flex name="layer{layer}" dim="3" radius="0" {body}>'
        f'<contact contype="0" conaffinity="0" selfcollide="none"/>'
        f'<elasticity young="{_MASS * stuff.young_modulus:.17g}" poisson="{stuff.poisson_ratio:.17g}" '
        f'damping="{stuff.retardation_time:.17g}"/></flex>'
    )


def _boxes(mesh: Lattice, layer: int, names: str, places: str) -> str:
    """Return nodes and cells; MuJoCo wants a skin of tetrahedra over them, here the boxes' own corners."""
    slabs = np.flatnonzero(mesh.slab_layer == layer)
    skin = Tetrahedra(
        x=mesh.x, y=mesh.y, z=mesh.z[slabs[0] : slabs[-1] + 2], slab_layer=np.zeros(len(slabs), dtype=int)
    )
    kind = {1: "trilinear", 2: "quadratic"}[mesh.order]
    count = skin.nodes.shape[1]
    return (
        f'dof="{kind}" cellcount="{_words(np.array(skin.shape))}" node="{names}" nodecoord="{places}" '
        f'body="{" ".join(["world"] * count)}" vertex="{_words(skin.nodes.T)}" element="{_words(skin.tetrahedra)}"'
    )


def _words(numbers: FloatArray) -> str:
    return " ".join(f"{number:.17g}" for number in numbers.ravel())
