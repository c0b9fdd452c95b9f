"""FEASolid: statics against closed forms, the whole block, symmetry and refinement."""

from __future__ import annotations

import numpy as np
import pytest

from reference import whole_block
from trocar.errors import InputError, SolverError
from trocar.model import Press, Profile, Support, TissueModel
from trocar.reference import FEASolid, MeshSize
from trocar.reference.convergence import refine, richardson
from trocar.reference.solver import Factorisation, choose_solver
from trocar.tissues import Layer, Tissue

SIZE = (0.03, 0.024)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2, side=0.8)
TILTED = Press(x=0.011, y=0.014, radius=2.5e-3, force=0.2, tilt=0.5, azimuth=0.7)
ROUND = Press(x=0.019, y=0.009, radius=3e-3, force=0.1, profile=Profile.SPHERE)


def two_layers(**wall: float) -> Tissue:
    return Tissue(
        layers=(
            Layer(**{"name": "wall", "thickness": 1e-3, "young_modulus": 2e5, "poisson_ratio": 0.45,
                     "density": 1050.0, "prestress_x": 2e4, "prestress_y": 9e3} | wall),
            Layer(name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0),
        )
    )  # fmt: skip


def solid(support: Support | str = "base", load: tuple[Press, ...] = (TILTED, ROUND)) -> FEASolid:
    return FEASolid(two_layers(), size=SIZE, support=support, around=load, mesh=COARSE)


@pytest.mark.parametrize("support", Support)
def test_quarters_add_up_to_the_whole_block(support: Support) -> None:
    load = (TILTED, ROUND)
    model = solid(support)
    bricks = whole_block.mirrored(model.bricks, SIZE)
    displacement = whole_block.solve(bricks, SIZE, model.tissue.layers, support, load)
    state, largest = model.static(load), np.abs(displacement).max()
    for layer in model.tissue.layer_names:
        line = bricks.upper_face(model.tissue.index(layer))
        face = np.flatnonzero(np.abs(bricks.nodes[2] - bricks.z[line]) < 1e-9)
        ours = model.displacement(state, bricks.nodes[:, face].T, layer)
        # both are direct solutions of one problem: rounding times a condition number of some 1e5
        np.testing.assert_allclose(ours, displacement[:, face].T, atol=1e-9 * largest, rtol=0)


@pytest.mark.parametrize("support", Support)
def test_supports_carry_the_load(support: Support) -> None:
    load = (TILTED, ROUND)
    model = solid(support)
    total = np.sum([press.force_vector for press in load], axis=0)
    np.testing.assert_allclose(
        model.reaction(model.static(load), load), -total, atol=1e-8 * np.abs(total).max()
    )


def test_a_press_at_a_clamped_side_is_carried_too() -> None:
    load = (Press(x=2e-3, y=0.012, radius=2e-3, force=0.1, tilt=0.0),)
    model = solid("edges", load)
    np.testing.assert_allclose(model.reaction(model.static(load), load), [0, 0, 0.1], atol=1e-9)


def test_central_press_needs_one_parity() -> None:
    central = (Press(x=0.015, y=0.012, radius=3e-3, force=1.0),)
    model = solid("base", central)
    assert len(model.static(central).displacement) == 1
    assert model.dofs == len(next(iter(model.static(central).displacement.values())).ravel()) - held_dofs(
        model
    )


def held_dofs(model: FEASolid) -> int:
    x, y, z = model.bricks.nodes
    base, left, front = z == z.min(), x == 0, y == 0
    right, back = x == x.max(), y == y.max()
    fixed = np.stack([base | front | right, base | left | back, base | left | front])
    return int(fixed.sum())


def test_response_is_linear_and_reciprocal() -> None:
    a, b = (Press(x=x, y=y, radius=2.5e-3, force=1.0) for x, y in ((0.011, 0.014), (0.019, 0.009)))
    model = FEASolid(two_layers(), size=SIZE, support="base", around=(a, b), mesh=COARSE)

    def under(state: object, press: Press) -> float:
        forces = model._forces((press,))
        shared = forces.keys() & state.displacement.keys()
        return 4 * sum(float((forces[parity] * state.displacement[parity]).sum()) for parity in shared)

    one, other = model.static((a,)), model.static((b,))
    assert under(one, b) == pytest.approx(under(other, a), rel=1e-9)  # Betti
    both = model.static((a.with_force(2.0), b.with_force(-3.0)))
    points = np.array([[0.012, 0.013, 0.0], [0.02, 0.01, 0.0]])
    expected = 2 * model.displacement(one, points, "fat") - 3 * model.displacement(other, points, "fat")
    found = model.displacement(both, points, "fat")
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_no_load_no_displacement() -> None:
    model = solid()
    points = np.array([[0.01, 0.01, 0.0]])
    for state in (model.init(), model.static(()), model.static((TILTED.with_force(0.0),))):
        assert not model.displacement(state, points).any()
        assert model.largest_deflection(state) == {"wall": 0.0, "fat": 0.0}
        assert model.compression(state) == {"wall": 0.0, "fat": 0.0}
        assert model.stress(state, prestress=False) == {"wall": 0.0, "fat": 0.0}


def test_lengths_and_moduli_scale() -> None:
    """Half the size at the same force: the deflection doubles; twice the moduli halve it."""

    def deflection(length: float, stiffness: float) -> float:
        pad = {"thickness": 0.006 * length, "young_modulus": 1e4 * stiffness, "poisson_ratio": 0.48}
        tissue = Tissue(layers=(Layer(name="pad", density=1e3, **pad),))
        press = Press(x=0.01 * length, y=0.01 * length, radius=2e-3 * length, force=0.1)
        size = (0.02 * length, 0.02 * length)
        model = FEASolid(tissue, size=size, support="edges", around=(press,), mesh=COARSE)
        return model.largest_deflection(model.static((press,)))["pad"]

    one = deflection(1.0, 1.0)
    assert deflection(0.5, 1.0) == pytest.approx(2 * one, rel=1e-7)
    assert deflection(1.0, 2.0) == pytest.approx(one / 2, rel=1e-7)


def test_meshes_converge_and_the_default_is_close() -> None:
    """A smooth press on one layer, so that the order is not spoilt by a rim or an interface."""
    tissue = Tissue(
        layers=(Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.4, density=1e3),)
    )
    press = Press(x=0.015, y=0.015, radius=5e-3, force=0.1, profile=Profile.GAUSSIAN)
    found, dofs = refine(tissue, size=(0.03, 0.03), support="base", load=(press,), mesh=COARSE)
    assert dofs[0] < dofs[1] < dofs[2]
    # quadratic elements: order 3 at a point, 4 in energy; the coarsest mesh has 3 elements along a half side
    assert 2.3 < found["pad"].order < 5.0
    model = FEASolid(tissue, size=(0.03, 0.03), support="base", around=(press,))
    default = model.largest_deflection(model.static((press,)))["pad"]
    assert default == pytest.approx(
        found["pad"].limit, rel=2e-3
    )  # the accuracy the default mesh is stated to have


def test_richardson_extrapolates_a_power_law() -> None:
    found = richardson(*(3.0 + 0.5 * h**2 for h in (0.4, 0.2, 0.1)))
    assert found.order == pytest.approx(2.0, rel=1e-12)
    assert found.limit == pytest.approx(3.0, rel=1e-12)
    swinging = richardson(1.0, 1.2, 1.1)
    assert np.isnan(swinging.order)
    assert swinging.uncertainty == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"size": (0.03, 0.0)}, "two finite sides"),
        ({"size": (0.03, np.nan)}, "two finite sides"),
        ({"support": "glued"}, "one of edges, edges\\+base, base"),
        ({"solver": "magic"}, "one of auto, superlu, pardiso"),
        ({"around": (Press(x=0.001, y=0.01, radius=0.002, force=1.0),)}, "footprint wholly on the block"),
    ],
)
def test_impossible_arguments_are_refused(change: dict[str, object], expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        FEASolid(two_layers(), **({"size": SIZE, "support": "base"} | change))


def test_impossible_questions_are_refused() -> None:
    model = solid()
    state = model.init()
    with pytest.raises(InputError, match=r"0 <= x <= 0\.03"):
        model.displacement(state, np.array([[0.031, 0.0, 0.0]]))
    with pytest.raises(InputError, match="shape"):
        model.displacement(state, np.zeros(3))
    with pytest.raises(InputError, match="one of wall, fat"):
        model.displacement(state, np.zeros((1, 3)), "bone")
    with pytest.raises(InputError, match="dt"):
        model.step(state, (), (), 0.0)
    with pytest.raises(InputError, match="1 presses, as in load0"):
        model.step(state, (TILTED,), (), 1e-3)
    with pytest.raises(InputError, match="per_radius"):
        MeshSize(per_radius=0.0)
    with pytest.raises(InputError, match="refinement"):
        MeshSize(refinement=5)


def test_an_unheld_matrix_is_not_solved() -> None:
    model = solid()
    stiffness = model._system.stiffness
    with pytest.raises(SolverError):
        Factorisation(stiffness, "superlu").solve(np.eye(1, stiffness.shape[0]).ravel())


def test_solvers_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    model = solid()
    assert model.solver_name == choose_solver("auto")
    plain = FEASolid(
        two_layers(), size=SIZE, support="base", around=(TILTED, ROUND), mesh=COARSE, solver="superlu"
    )
    found, expected = (m.largest_deflection(m.static((TILTED,)))["wall"] for m in (model, plain))
    assert found == pytest.approx(expected, rel=1e-8)
    monkeypatch.setattr("trocar.reference.solver.find_spec", lambda name: None)
    assert choose_solver("auto") == "superlu"
    with pytest.raises(InputError, match="install trocar\\[pardiso\\]"):
        choose_solver("pardiso")


def test_it_is_a_tissue_model() -> None:
    assert isinstance(solid(), TissueModel)
