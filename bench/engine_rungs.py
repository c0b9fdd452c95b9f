"""Other engines from coarse to fine: which there are, what they are called, how a case's block is made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

from engine_meshes import Lattice, even, graded

from trocar.model import FloatArray
from trocar.study.cost.accuracy import CASES, LARGE
from trocar.study.report.figures.style import BLACK, MODEL_MARKS, ORANGE
from trocar.study.stiffening import Dent


class Engine(Protocol):
    """A block that an engine moves."""

    mesh: Lattice

    @property
    def dofs(self) -> int:
        """Unknowns."""

    def rest(self, forces: FloatArray) -> FloatArray:
        """Go to rest under forces on the nodes [N], shape (nodes, 3); return their displacements [m]."""

    def step(self, forces: FloatArray, dt: float) -> None:
        """Go on by dt [s]."""

    def displacement(self) -> FloatArray:
        """Return the nodes' displacements [m], shape (nodes, 3)."""


@dataclass(frozen=True, kw_only=True)
class Rung:
    """One engine at one resolution.

    Attributes:
        engine: its name in the table.
        setting: how fine.
        share: of a small force that it is pressed with, so that strains are small and rounding smaller.
        build: makes it of a case's dent.
        cases: that it is for.
    """

    engine: str
    setting: str
    share: float
    build: Callable[[Dent], Engine]
    cases: Sequence[str] = CASES


def _flex(mesh: Callable[[Dent], Lattice], dent: Dent, **how: Any) -> Engine:
    from mujoco_flex import MujocoFlex  # noqa: PLC0415 - only where it is installed

    return MujocoFlex(dent.tissue, mesh(dent), **how)


def _descent(mesh: Callable[[Dent], Any], rounds: int, dent: Dent) -> Engine:
    from newton_vbd import NewtonVBD  # noqa: PLC0415 - only where it is installed

    return NewtonVBD(dent.tissue, mesh(dent), rounds=rounds)


def _tetrahedra(per_radius: float, dent: Dent) -> Lattice:
    return graded(dent.tissue, dent.size, dent.load(1.0), per_radius)


def _boxes(across: int, order: int, dent: Dent) -> Lattice:
    return even(dent.tissue, dent.size, across, order)


def mujoco_rungs() -> Iterator[Rung]:
    """Yield MuJoCo's, coarse to fine."""
    for order, name, ladder in ((1, "8", (12, 16, 24, 32)), (2, "27", (6, 10, 14, 18))):
        for across in ladder:
            build = partial(_flex, partial(_boxes, across, order))
            yield Rung(
                engine=f"MuJoCo, {name}-node boxes", setting=f"{across} a side", share=1e-3, build=build
            )
    for per_radius in (1.5, 2.0, 3.0, 4.0):
        mesh = partial(_tetrahedra, per_radius)
        words = f"{per_radius:g} a radius"
        yield Rung(engine="MuJoCo, tetrahedra", setting=words, share=1e-3, build=partial(_flex, mesh))
        yield Rung(
            engine="MuJoCo, neo-Hookean",
            setting=words,
            share=1e-3,
            build=partial(_flex, mesh, neo_hookean=True),
            cases=(LARGE,),
        )


def newton_rungs() -> Iterator[Rung]:
    """Yield Newton's, coarse to fine."""
    for rounds in (10, 40):
        for per_radius in (1.5, 2.0):
            yield Rung(
                engine=f"Newton, {rounds} rounds",
                setting=f"{per_radius:g} a radius",
                share=0.25,
                build=partial(_descent, partial(_tetrahedra, per_radius), rounds),
            )


ENGINES = {"mujoco": mujoco_rungs, "newton": newton_rungs}
MARKS = MODEL_MARKS | {
    "MuJoCo, 8-node boxes": ("<", ORANGE),
    "MuJoCo, 27-node boxes": (">", ORANGE),
    "MuJoCo, tetrahedra": ("P", ORANGE),
    "MuJoCo, neo-Hookean": ("p", ORANGE),
    "Newton, 10 rounds": ("1", BLACK),
    "Newton, 40 rounds": ("2", BLACK),
}
