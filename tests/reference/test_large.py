"""FEASolid under large deformation: the assembled equations, Newton's order, refinement, balance, where it stops."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from reference.closed_forms import LAWS
from reference.test_patches import patch
from trocar.errors import SolverError
from trocar.model import Press, Profile, Support
from trocar.reference import FEASolid, MeshSize
from trocar.reference.assembly import stiffness
from trocar.reference.convergence import refine
from trocar.reference.deformed import DeformedBricks
from trocar.reference.mesh import Bricks
from trocar.reference.newton import Directions, balance
from trocar.reference.part import Static
from trocar.reference.solver import submatrix
from trocar.tissues import Fibre, Law, Layer, NeoHookean, Ogden, Tissue

SIZE = (0.03, 0.024)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2, side=0.8)
CENTRAL = (Press(x=0.015, y=0.012, radius=3e-3, force=1.0),)
TILTED = (Press(x=0.015, y=0.012, radius=3e-3, force=0.6, tilt=0.4),)
ANYWHERE = (
    Press(x=0.011, y=0.014, radius=2.5e-3, force=0.2, tilt=0.5, azimuth=0.7),
    Press(x=0.019, y=0.009, radius=3e-3, force=0.1, profile=Profile.SPHERE),
)
STIFFENING = Ogden(terms=((1.0, 8.0),))


def by_name(law: Law) -> str:
    return type(law).__name__


def two_layers(law: Law) -> Tissue:
    wall = {
        "thickness": 1e-3,
        "young_modulus": 2e5,
        "poisson_ratio": 0.45,
        "prestress_x": 2e4,
        "prestress_y": 9e3,
    }
    return Tissue(
        layers=(
            Layer(name="wall", density=1050.0, law=law, **wall),
            Layer(name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0, law=law),
        )
    )


def solid(law: Law, load: tuple[Press, ...] = CENTRAL, support: Support | str = "base") -> FEASolid:
    return FEASolid(two_layers(law), size=SIZE, support=support, around=load, mesh=COARSE)


# The assembled equations


@pytest.mark.parametrize("law", LAWS[:2], ids=by_name)
def test_the_tangent_at_rest_is_the_linear_stiffness(law: Law) -> None:
    model = solid(law)
    assert model._large is not None
    deformed = model._large.part((False, False)).deformed
    expected = submatrix(stiffness(model.bricks, model.tissue.layers), deformed.free)
    found = deformed.stiffness(np.zeros(model.bricks.nodes.shape))
    assert abs(found - expected).max() < 1e-13 * abs(expected).max()  # rounding


@pytest.mark.parametrize("law", LAWS, ids=by_name)
def test_the_stiffness_is_the_derivative_of_the_forces_and_these_of_the_energy(law: Law) -> None:
    model = solid(law)
    assert model._large is not None
    part = model._large.part((False, False))
    field = part.domain.field(model.static(CENTRAL).displacement)
    way = np.random.default_rng(0).normal(size=len(part.domain.free))
    step = 1e-9 * part.spread(way)
    ahead, behind = (part.deformed.forces(field + sign * step) for sign in (1, -1))
    slope = part.freed(ahead - behind) / 2e-9
    exact = part.deformed.stiffness(field) @ way
    # a millionth: where a fibre goes slack between the two, the stiffness jumps
    assert np.linalg.norm(slope - exact) < 1e-5 * np.linalg.norm(exact)
    work = (part.deformed.energy(field + step) - part.deformed.energy(field - step)) / 2e-9
    assert work == pytest.approx(float(part.freed(part.deformed.forces(field)) @ way), rel=1e-6)


def test_an_element_resists_every_deformation_at_rest_and_stretched() -> None:
    """Six motions cost nothing at rest, those of a rigid body; with reduced points alone it would be twelve."""
    _, layers = patch(NeoHookean())
    one = Bricks(
        x=np.array([0, 1e-3]),
        y=np.array([0, 2e-3]),
        z=np.array([0, 1.5e-3]),
        slab_layer=np.zeros(1, dtype=np.int64),
    )
    deformed = DeformedBricks(one, layers, np.arange(60))
    for stretches, costless in (
        ((1, 1, 1), 6),
        ((1.5, 0.8, 0.85), 3),
    ):  # turning a stressed body is not balanced
        field = (np.diag(stretches) - np.eye(3)) @ one.nodes
        values = np.linalg.eigvalsh(deformed.stiffness(field).toarray())
        assert np.sum(np.abs(values) < 1e-9 * values.max()) == costless


def test_newton_converges_quadratically() -> None:
    model = solid(NeoHookean())
    assert model._large is not None
    part = model._large.part((False, False))
    force = part.freed(part.domain.forces(model._forces(CENTRAL)))
    start = part.freed(part.domain.field(model.static((CENTRAL[0].with_force(0.8),)).displacement))
    found = balance(
        Static(part, force),
        start,
        scale=float(np.linalg.norm(force)),
        tolerance=1e-12,
        directions=Directions("superlu", reuse=False),
    )
    sizes = np.log(found.imbalances)
    near = [n for n in range(1, len(sizes) - 1) if np.exp(sizes[n]) < 0.1 and np.exp(sizes[n + 1]) > 1e-13]
    orders = [(sizes[n + 1] - sizes[n]) / (sizes[n] - sizes[n - 1]) for n in near]
    assert orders
    assert max(orders) > 1.8
    assert len(found.imbalances) <= 9


def test_old_factors_lead_to_the_same_equilibrium() -> None:
    model = solid(STIFFENING)
    assert model._large is not None
    part = model._large.part((False, False))
    force = part.freed(part.domain.forces(model._forces(CENTRAL)))
    ours = part.freed(part.domain.field(model.static(CENTRAL).displacement))
    exact = balance(
        Static(part, force),
        ours * 0.999,
        scale=float(np.linalg.norm(force)),
        tolerance=1e-11,
        directions=Directions("superlu", reuse=False),
    ).unknowns
    np.testing.assert_allclose(ours, exact, rtol=0, atol=1e-8 * np.abs(exact).max())


# FEASolid


@pytest.mark.parametrize("law", [NeoHookean(), STIFFENING], ids=by_name)
@pytest.mark.parametrize("load", [CENTRAL, ANYWHERE], ids=["central", "anywhere"])
def test_a_small_force_gives_the_linear_answer(law: Law, load: tuple[Press, ...]) -> None:
    model = solid(law, load)
    linear = FEASolid(two_layers(law).linearised, size=SIZE, support="base", around=load, mesh=COARSE)
    small = tuple(press.with_force(1e-5 * press.force) for press in load)
    points = np.array([[0.011, 0.014, 0.0], [0.02, 0.01, 0.0]])
    for layer in model.layer_names:
        one, two = (each.displacement(each.static(small), points, layer) for each in (model, linear))
        np.testing.assert_allclose(one, two, rtol=0, atol=1e-4 * np.abs(two).max())  # the next term: 1e-5
    assert model.stress(model.static(small)) == pytest.approx(linear.stress(linear.static(small)), rel=1e-3)


@pytest.mark.parametrize("support", Support)
@pytest.mark.parametrize("load", [CENTRAL, TILTED, ANYWHERE], ids=["quarter", "half", "whole"])
def test_supports_carry_the_load(support: Support, load: tuple[Press, ...]) -> None:
    model = solid(LAWS[2], load, support)
    total = np.sum([press.force_vector for press in load], axis=0)
    np.testing.assert_allclose(
        model.reaction(model.static(load), load), -total, atol=1e-8 * np.abs(total).max()
    )


def test_half_a_block_and_the_whole_say_the_same() -> None:
    model = solid(NeoHookean(), TILTED)
    assert model._large is not None
    unit = model._forces((TILTED[0].with_force(1.0),))
    half, whole = (model._large.equilibrium(part, unit, 0.6) for part in ((True, False), (True, True)))
    largest = max(np.abs(part).max() for part in half.values())
    for parity, part in whole.items():
        np.testing.assert_allclose(part, half.get(parity, 0.0 * part), rtol=0, atol=1e-8 * largest)


def test_a_load_reached_in_two_ways_is_the_same() -> None:
    direct, stepped = (solid(NeoHookean()) for _ in range(2))
    for force in (0.2, 0.7):
        stepped.static((CENTRAL[0].with_force(force),))
    points = np.array([[0.015, 0.012, 0.0], [0.02, 0.01, 0.0]])
    one, two = (model.displacement(model.static(CENTRAL), points) for model in (direct, stepped))
    np.testing.assert_allclose(one, two, rtol=0, atol=1e-8 * np.abs(two).max())


def test_stiffer_laws_move_less() -> None:
    depths = [
        model.largest_deflection(model.static(CENTRAL))["wall"]
        for model in (
            solid(NeoHookean()),
            solid(STIFFENING),
            solid(Fibre(k1=5e4, k2=2.0, dispersion=0.1, angle=0.6)),
        )
    ]
    assert depths[0] > depths[1] > depths[2]


def test_meshes_converge() -> None:
    """A smooth press, a sixth of the thickness deep, so that the order is not spoilt by a rim."""
    pad = Layer(
        name="pad", thickness=0.006, young_modulus=1e4, poisson_ratio=0.45, density=1e3, law=NeoHookean()
    )
    press = Press(x=0.01, y=0.01, radius=5e-3, force=0.14, profile=Profile.GAUSSIAN)
    coarse = MeshSize(per_radius=1.0, growth=1.0, top=0.6, deepening=1.0)
    found, dofs = refine(Tissue(layers=(pad,)), size=(0.02, 0.02), support="base", load=(press,), mesh=coarse)
    assert dofs[0] < dofs[1] < dofs[2]
    assert found["pad"].limit > 0.16 * pad.thickness
    assert 2.0 < found["pad"].order < 5.0  # quadratic elements: 3 at a point, 4 in energy
    assert found["pad"].uncertainty < 3e-3 * found["pad"].limit


@pytest.mark.parametrize(("share", "holds"), [(1.5, True), (2.6, False)])
def test_a_dead_pressure_of_twice_the_shear_modulus_is_not_stable(share: float, holds: bool) -> None:
    """A confined half-space is stable up to p = 2 mu: there [2 mu + p] [1 - p / (2 mu)] = 0 (finite-elements.md).

    Elements resolve the wave that grows only so far, and a pad is no half-space: hence the distance from 2.
    """
    pad = Layer(
        name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.49, density=1e3, law=NeoHookean()
    )
    model = FEASolid(
        Tissue(layers=(pad,)),
        size=(0.01, 0.01),
        support="base",
        mesh=MeshSize(top=1.0, per_radius=1.0, growth=1.0),
    )
    assert model._large is not None
    deformed = model._large.part((False, False)).deformed
    top = np.isclose(model.bricks.nodes[2], 0.0, rtol=0, atol=1e-9)
    assert top.any()
    squeezed = brentq(
        lambda s: pressure(pad, s) + share * pad.shear_modulus, 0.5, 1.0, xtol=1e-14
    )  # evenly, between walls that do not give
    field = np.zeros(model.bricks.nodes.shape)
    field[2] = (squeezed - 1.0) * (model.bricks.nodes[2] + pad.thickness)
    lowest = np.linalg.eigvalsh(deformed.stiffness(field).toarray())[0]
    assert bool(lowest > 0) == holds


def pressure(pad: Layer, stretch: float) -> float:
    """Nominal stress along z [Pa] of neo-Hooke between rigid walls."""
    lengths = np.array([1.0, 1.0, stretch])
    kirchhoff = pad.shear_modulus * stretch ** (-2 / 3) * (lengths**2 - (lengths**2).mean())
    return float((kirchhoff[2] + pad.bulk_modulus * (stretch - 1) * stretch) / stretch)


def test_it_says_where_and_why_it_stopped() -> None:
    """Under a dead pull Ogden's law with exponent 1 lets go: stress grows no faster than the sides draw in."""
    pad = Layer(
        name="pad",
        thickness=0.006,
        young_modulus=1e4,
        poisson_ratio=0.4,
        density=1e3,
        law=Ogden(terms=((1.0, 1.0),)),
    )
    pull = (Press(x=0.015, y=0.012, radius=2e-3, force=-5.0),)
    model = FEASolid(Tissue(layers=(pad,)), size=SIZE, support="base", around=pull, mesh=COARSE)
    with pytest.raises(SolverError) as caught:
        model.static(pull)
    message = str(caught.value)
    assert message.startswith("large deformation: reached ")
    assert " of 5 N and no more" in message
    assert "layer 'pad', element centred at (" in message
    assert "take less force" in message
    assert "\n" not in message


def test_an_impossible_equilibrium_is_reported() -> None:
    """Newton's method converges on tissue squeezed to nothing; the figures say so."""
    model = solid(NeoHookean(), support="edges+base")
    mild, hard = (
        model.deformation(model.static((CENTRAL[0].with_force(force),)))["fat"] for force in (0.1, 3.0)
    )
    assert mild.stretch[0] > 0.8
    assert hard.stretch[0] < 0.3
    assert hard.volume_ratio[0] > 0


def test_the_linear_model_is_what_it_was() -> None:
    linear = FEASolid(
        two_layers(NeoHookean()).linearised, size=SIZE, support="base", around=CENTRAL, mesh=COARSE
    )
    assert not linear.large_deformation
    one, two = (
        linear.largest_deflection(linear.static((CENTRAL[0].with_force(force),)))["fat"] for force in (1, 2)
    )
    assert two == pytest.approx(2 * one, rel=1e-12)
    tissue = replace(two_layers(NeoHookean()), name="large")
    assert FEASolid(tissue, size=SIZE, support="base").large_deformation
