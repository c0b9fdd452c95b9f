"""FEASolid under large deformation in time: energy, damping, order, the linear step as its limit."""

from __future__ import annotations

import numpy as np
import pytest

from trocar.model import Press
from trocar.reference import FEASolid, FEAState, MeshSize
from trocar.tissues import Fibre, Law, Layer, NeoHookean, Ogden, Tissue

SIZE = (0.016, 0.016)
COARSE = MeshSize(
    per_radius=0.6, growth=1.5, top=1.5, deepening=1.5
)  # 8 elements: the step is tested, not the block
PRESS = Press(x=0.008, y=0.008, radius=3e-3, force=0.6)
CENTRE = np.array([[0.008, 0.008, 0.0]])


def solid(law: Law, loss_factor: float = 0.0) -> FEASolid:
    shared = {"law": law, "loss_factor": loss_factor}
    tissue = Tissue(
        layers=(
            Layer(
                name="wall", thickness=1e-3, young_modulus=2e5, poisson_ratio=0.45, density=1050.0,
                prestress_x=2e4, prestress_y=9e3, **shared,
            ),
            Layer(name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0, **shared),
        )
    )  # fmt: skip
    return FEASolid(tissue, size=SIZE, support="base", around=(PRESS,), mesh=COARSE)


def energies(model: FEASolid, state: FEAState) -> tuple[float, float]:
    """Kinetic energy, and what layers, prestress and the sides it pulls at store; of the quarter [J]."""
    assert model._large is not None
    part = model._large.part((False, False))
    field, velocity = (part.domain.field(each) for each in (state.displacement, state.velocity))
    moving = 0.5 * float(part.freed(velocity) @ (part.mass @ part.freed(velocity)))
    return moving, part.deformed.energy(field) - float((part.at_rest * field).sum())


@pytest.mark.parametrize(
    ("law", "allowed"),
    [
        (NeoHookean(), 1e-5),
        (Ogden(terms=((1.0, 8.0),)), 1e-4),
        (
            Fibre(k1=5e4, k2=2.0, dispersion=0.1, angle=0.6),
            2e-2,
        ),  # going slack is a kink, for which Gauss points miss
    ],
    ids=["neo-hookean", "ogden", "fibre"],
)
def test_undamped_energy_stays(law: Law, allowed: float) -> None:
    """Let go from a third of the thickness; most of the energy turns kinetic, none is lost."""
    model = solid(law)
    state = model.static((PRESS,))
    first, kinetic = energies(model, state)[1], 0.0
    for _ in range(15):
        state = model.step(state, (), (), 1e-3)
        moving, stored = energies(model, state)
        kinetic = max(kinetic, moving / first)
        assert moving + stored == pytest.approx(first, rel=allowed)
    assert kinetic > 0.5


def test_a_load_does_the_work_that_turns_into_energy() -> None:
    """Force times displacement of every step is the energy it adds, the damping's share taken off."""
    model = solid(NeoHookean())
    assert model._large is not None
    part = model._large.part((False, False))
    state, work = model.init(), 0.0
    for number in range(10):
        load0, load1 = ((PRESS.with_force(0.06 * n),) for n in (number, number + 1))
        mean = part.domain.forces(model._forces((PRESS.with_force(0.06 * (number + 0.5)),)))
        before = part.domain.field(state.displacement)
        state = model.step(state, load0, load1, 1e-3)
        work += float((mean * (part.domain.field(state.displacement) - before)).sum())
    assert sum(energies(model, state)) == pytest.approx(work, rel=1e-5)


def test_damping_only_takes_energy() -> None:
    model = solid(NeoHookean(), loss_factor=0.3)
    state = model.static((PRESS,))
    totals = [sum(energies(model, state))]
    for _ in range(20):
        state = model.step(state, (), (), 1e-3)
        totals.append(sum(energies(model, state)))
    assert np.all(np.diff(totals) < 1e-6 * totals[0])
    assert totals[-1] < 1e-2 * totals[0]


def test_the_step_is_of_second_order() -> None:
    """Half the step, a quarter of the error; damped, so that the order is that of the damping too."""
    model, ends = solid(NeoHookean(), loss_factor=0.3), []
    for count in (10, 20, 40):
        state = model.init()
        for number in range(count):
            load0, load1 = ((PRESS.with_force(0.6 * n / count),) for n in (number, number + 1))
            state = model.step(state, load0, load1, 0.01 / count)
        ends.append(float(model.displacement(state, CENTRE)[0, 2]))
    assert (ends[0] - ends[1]) / (ends[1] - ends[2]) > 3.5


def test_small_motion_is_the_linear_model_s() -> None:
    model = solid(NeoHookean(), loss_factor=0.1)
    linear = FEASolid(model.tissue.linearised, size=SIZE, support="base", around=(PRESS,), mesh=COARSE)
    tap = (PRESS.with_force(1e-5),)
    one, two = model.init(), linear.init()
    for _ in range(5):
        one, two = model.step(one, tap, tap, 5e-4), linear.step(two, tap, tap, 5e-4)
        expected = linear.displacement(two, CENTRE)
        np.testing.assert_allclose(
            model.displacement(one, CENTRE), expected, atol=1e-4 * np.abs(expected).max()
        )
    forces = [each.reaction(state, tap)[2] for each, state in ((model, one), (linear, two))]
    assert forces[0] == pytest.approx(forces[1], rel=1e-3)


def test_a_held_load_ends_in_equilibrium() -> None:
    model = solid(Ogden(terms=((1.0, 8.0),)), loss_factor=0.5)
    state = model.step(model.init(), (PRESS.with_force(0.0),), (PRESS,), 2e-3)
    for _ in range(20):
        state = model.step(state, (PRESS,), (PRESS,), 2e-3)
    expected = model.displacement(model.static((PRESS,)), CENTRE)
    # what the steps do not resolve rings on: the average of two ends damps nothing by itself
    np.testing.assert_allclose(
        model.displacement(state, CENTRE), expected, atol=1e-2 * np.abs(expected).max()
    )


def test_the_same_step_gives_the_same_bits() -> None:
    model = solid(NeoHookean())
    start = model.step(model.init(), (PRESS,), (PRESS,), 1e-3)
    one, two = (model.step(start, (PRESS,), (PRESS,), 1e-3) for _ in range(2))
    assert np.array_equal(model.displacement(one, CENTRE), model.displacement(two, CENTRE))
