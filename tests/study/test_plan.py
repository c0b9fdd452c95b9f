"""What the study does with layers that remember and have laws for large strain."""

from importlib.resources import files

import pytest

from trocar.model import Support
from trocar.study.plan import Plan
from trocar.tissues.law import NeoHookean

MORE = """
[layer.memory]
prony = [[0.6, 0.05]]
status = "chosen"
reason = "a test"
source = "here"
method = { setting = "choice", technique = "none" }
[layer.law]
law = "neo-hookean"
status = "chosen"
reason = "a test"
source = "here"
method = { setting = "choice", technique = "none" }
"""


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    preset = (files("trocar.tissues") / "presets" / "liver.toml").read_text(encoding="utf-8")
    first, *layers = preset.split("[[layer]]")
    place = tmp_path_factory.mktemp("tissue") / "mine.toml"
    place.write_text("[[layer]]".join([first, *(layer + MORE for layer in layers)]), encoding="utf-8")
    return Plan(tissue=str(place))


def test_small_presses_are_linear_and_remember(plan):
    layers = plan.central(plan.small).tissue.layers
    assert {layer.prony for layer in layers} == {((0.6, 0.05),)}
    assert not plan.central(plan.small).tissue.large_deformation


def test_under_clamped_sides_nothing_relaxes(plan):
    for support in (Support.EDGES, Support.EDGES_AND_BASE):
        assert not plan.central(plan.small, support).tissue.relaxation_times


def test_a_hard_press_has_the_laws(plan):
    assert {layer.law for layer in plan.layers.layers} == {NeoHookean()}
