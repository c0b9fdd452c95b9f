"""Rigid tips against Hertz and Boussinesq, against themselves, and through `compare`."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.study.cases.experiment import case_from_tissue
from trocar.study.cases.tool import Contact, Tip, Tool
from trocar.study.compare import compare
from trocar.study.rigid import RigidTips
from trocar.tissues import Layer, Tissue
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

SIDE = 0.06
BLOCK = Tissue(
    layers=(Layer(name="block", thickness=0.06, young_modulus=1e6, poisson_ratio=0.48, density=1e3),)
)
STIFFNESS = 1e6 / (1 - 0.48**2)  # plane strain [Pa]
RADIUS = 2.5e-3


def tool(tip=Tip.SPHERE, place=(0.03, 0.03), peak=0.05):
    return Tool(diameter=2 * RADIUS, position=place, peak=peak, rate=0.05, tip=tip, contact=Contact.RIGID)


@pytest.fixture(scope="module")
def block():
    return WaveSolid(BLOCK, size=(SIDE, SIDE), modes=(96, 96))


@pytest.fixture(scope="module")
def far_sides(block):
    """What the block's sides and base take from a half space's deflection under any small tool [m/N]."""
    press = Press(x=0.03, y=0.03, radius=4e-3, force=1.0)
    sinks = -block.displacement(block.static((press,)), np.array([[0.03, 0.03, 0.0]]))[0, 2]
    return sinks - 2 / (np.pi * 4e-3 * STIFFNESS)  # Johnson 1985, eq. 3.29: 2 F/(pi a E*) under the middle


@pytest.mark.parametrize("force", [1e-3, 0.03, 0.3])
def test_a_sphere_on_a_deep_block_sinks_as_hertz_says(block, far_sides, force):
    found = RigidTips(block, (tool(),)).press(np.array([force]))
    hertz = (0.75 * force / (STIFFNESS * np.sqrt(RADIUS))) ** (2 / 3)
    # Eight rings; a ball is steeper than Hertz's paraboloid by a quarter of (a/R)^2, 0.02 at 0.3 N.
    assert found.depths[0] == pytest.approx(hertz + far_sides * force, rel=0.015)
    assert found.touching[0] == pytest.approx(np.sqrt(RADIUS * hertz), rel=0.12)  # to a ring
    assert found.forces.sum() == pytest.approx(force, rel=1e-9)


def test_a_flat_punch_on_a_deep_block_sinks_as_boussinesq_says(block, far_sides):
    found = RigidTips(block, (tool(Tip.FLAT),)).press(np.array([1.0]))
    assert found.depths[0] == pytest.approx(1 / (2 * RADIUS * STIFFNESS) + far_sides, rel=0.01)
    assert found.touching[0] == pytest.approx(RADIUS, rel=1e-9)


def test_a_light_touch_after_a_deep_one_is_what_it_is_alone(block):
    tips = RigidTips(block, (tool(),))
    tips.press(np.array([1.0]))
    after = tips.press(np.array([0.01])).depths[0]
    assert after == pytest.approx(RigidTips(block, (tool(),)).press(np.array([0.01])).depths[0], rel=0.02)
    again = tips.press(np.array([1.0])).depths[0]
    assert again == pytest.approx(RigidTips(block, (tool(),)).press(np.array([1.0])).depths[0], rel=0.01)


@pytest.mark.parametrize("tip", list(Tip))
def test_nothing_reaches_into_the_tip_between_the_pads(tip):
    skin = tissue("skin")
    for model in (
        WaveSolid(skin, size=(SIDE, SIDE), modes=(96, 96)),
        WaveMembrane.fitted(skin, size=(SIDE, SIDE), modes=(64, 64)),
    ):
        found = RigidTips(model, (tool(tip),)).press(np.array([0.07]))
        radii = np.linspace(0, found.touching[0], 60)
        angles = np.linspace(0, np.pi / 3, 12)
        where = 0.03 + np.stack(
            [np.outer(radii, np.cos(angles)).ravel(), np.outer(radii, np.sin(angles)).ravel()], 1
        )
        away = np.linalg.norm(where - 0.03, axis=1)
        rise = RADIUS - np.sqrt(RADIUS**2 - away**2) if tip is Tip.SPHERE else 0.0
        above = found.depths[0] - rise - found.pads.deflection(found.forces, where)[0]
        # A fiftieth of a millimetre at 0.6 to 1 mm of depth, between the outermost pads.
        assert above.max() < 2e-5
        if tip is Tip.SPHERE:
            assert (
                np.abs(above).max() < 2e-5
            )  # it touches everywhere; under a flat tip a stiff skin leaves the middle


def test_two_tips_feel_each_other_and_do_not_know_left_from_right():
    skin = tissue("skin")
    model = WaveSolid(skin, size=(SIDE, SIDE), modes=(64, 64))
    left, right = tool(place=(0.026, 0.03)), tool(place=(0.034, 0.03))
    both = RigidTips(model, (left, right)).press(np.array([0.05, 0.05]))
    alone = RigidTips(model, (left,)).press(np.array([0.05]))
    assert both.depths[0] == pytest.approx(both.depths[1], rel=1e-6)
    assert both.depths[0] > 1.1 * alone.depths[0]
    one = RigidTips(model, (left, right)).press(np.array([0.05, 0.0]))
    assert one.depths[0] == pytest.approx(alone.depths[0], rel=0.01)
    assert one.depths[1] == 0.0


def test_compare_presses_rigid_tips():
    case = case_from_tissue(tissue=tissue("skin"), size=(SIDE, SIDE), tools=(tool(),), period=0.1)
    history = compare(case, ("wave-solid",))["wave-solid"]
    top = history.deflection["epidermis"]
    direct = RigidTips(WaveSolid(tissue("skin"), size=(SIDE, SIDE)), case.tools).press(np.array([0.05]))
    assert top.max() == pytest.approx(direct.depths[0], rel=0.005)
    assert top[0] == top[-1] == 0.0
    assert (np.diff(top[: top.argmax() + 1]) > 0).all()
    assert top == pytest.approx(top[::-1], rel=1e-9)  # down as up
    flat = replace(case, tools=(tool(Tip.FLAT),))
    shallow = compare(flat, ("wave-solid",))["wave-solid"].deflection["epidermis"]
    assert shallow == pytest.approx(shallow.max() * history.force / 0.05, rel=1e-6)
    assert shallow.max() < top.max()


def test_finite_elements_take_no_rigid_tip():
    case = case_from_tissue(tissue=tissue("skin"), size=(SIDE, SIDE), tools=(tool(),), period=0.5)
    with pytest.raises(InputError, match="wave-membrane or wave-solid, which take a rigid tip, got 'fea'"):
        compare(case, ("wave-solid", "fea"), builders={})  # refused before anything is built


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"tilt": 0.1}, "upright, for a rigid tip"),
        ({"contact": Contact.DEAD}, '"rigid" for a sphere'),
    ],
)
def test_what_a_rigid_tip_cannot_do_is_refused(change, words):
    with pytest.raises(InputError, match=words):
        replace(tool(), **change)


def test_rigid_tips_do_not_overlap():
    with pytest.raises(InputError, match="at least 5 mm from the first tool"):
        case_from_tissue(
            tissue=tissue("skin"), size=(SIDE, SIDE), tools=(tool(), tool(place=(0.0349, 0.03))), period=0.1
        )


@pytest.mark.parametrize("forces", [(1e-6, 3.0), (0.5, 1e-5)])
def test_a_light_tip_in_the_dent_of_a_heavy_one_is_found(block, forces):
    """It hangs over a hollow that deepens towards its neighbour, and still presses with its own force."""
    found = RigidTips(block, (tool(place=(0.027, 0.03)), tool(Tip.FLAT, place=(0.033, 0.03)))).press(
        np.array(forces)
    )
    pads = len(found.forces) // 2
    assert [found.forces[:pads].sum(), found.forces[pads:].sum()] == pytest.approx(forces, rel=1e-6)
    assert (found.forces >= 0).all()


def test_rigid_tips_neither_move_fast_nor_mix_with_dead_loads():
    dead = Tool(diameter=5e-3, position=(0.02, 0.03), peak=0.05, rate=0.05)
    with pytest.raises(InputError, match=r"tool\[1\].contact"):
        case_from_tissue(tissue=tissue("skin"), size=(SIDE, SIDE), tools=(tool(), dead))
    with pytest.raises(InputError, match="false with a rigid tip"):
        case_from_tissue(tissue=tissue("skin"), size=(SIDE, SIDE), tools=(tool(),), dynamic=True, period=1e-3)
