"""A case on a mesh through the models: what a block as a mesh says, slopes, motion, and models that take none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Support
from trocar.study.cases.experiment import Case, Sampling
from trocar.study.cases.reading import load_case
from trocar.study.cases.tool import Tool
from trocar.study.compare import Comparison, compare
from trocar.study.linear_range import linear_range, range_on_mesh
from trocar.study.models import MODELS, usual_models
from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid

PAD = Layer(
    name="pad",
    thickness=6e-3,
    young_modulus=2e4,
    poisson_ratio=0.45,
    density=1e3,
    loss_factor=0.3,
    loss_frequency=50,
)
TOOL = Tool(diameter=8e-3, position=(0.01, 0.012), peak=0.02, rate=0.02)
BLOCK = Case(
    title="a pad",
    tissue=Tissue(layers=(PAD,)),
    size=(0.02, 0.02),
    support=Support.EDGES_AND_BASE,
    tools=(TOOL,),
    sampling=Sampling(period=0.5),
)
LINES = lines_around(BLOCK.tissue, BLOCK.size, BLOCK.load_at(0.0), support=BLOCK.support, coarser=2.5)
MESHED = replace(BLOCK, mesh=block_mesh(BLOCK.tissue, LINES, support=BLOCK.support))
LIVER = Path(__file__).parent.parent.parent / "examples" / "liver.toml"


@pytest.fixture(scope="module")
def liver(tmp_path_factory):
    """The example on fewer elements, pressed on a slope."""
    text = LIVER.read_text("utf-8").replace("spacing_mm = 24", "spacing_mm = 40")
    file = tmp_path_factory.mktemp("liver") / "liver.toml"
    file.write_text(text.replace("[120, 45]", "[160, 45]"), "utf-8")
    return load_case(file)


@pytest.fixture(scope="module")
def pressed(liver):
    return compare(liver)["wave-mesh"]


def test_a_block_as_a_mesh_says_what_the_block_does():
    def build(case):
        return WaveMesh(block_mesh(case.tissue, LINES, support=case.support), massless=True)

    one = compare(BLOCK, ("wave-mesh",), builders={"wave-mesh": build})["wave-mesh"]
    other = compare(MESHED)["wave-mesh"]
    assert other.deflection["pad"] == pytest.approx(one.deflection["pad"], rel=1e-9)
    assert one.block.max() > 1e-5


def test_what_comes_out_says_how_many_elements_there_are():
    told = Comparison(case=MESHED, histories=()).as_dict()["case"]
    assert told["elements"] == len(MESHED.mesh.cells)
    assert Comparison(case=BLOCK, histories=()).as_dict()["case"]["elements"] is None


def test_two_tools_and_a_tap_are_followed_on_a_mesh():
    pair = replace(MESHED, tools=(TOOL, replace(TOOL, rate=0.04)))
    both, one = compare(pair)["wave-mesh"], compare(MESHED)["wave-mesh"]
    assert both.block.max() > 1.3 * one.block.max()
    tap = replace(TOOL, peak=0.02, rate=2.0)
    moving = replace(MESHED, tools=(tap,), sampling=Sampling(period=5e-3, dynamic=True))
    still = replace(moving, sampling=Sampling(period=5e-3))
    followed, at_rest = compare(moving)["wave-mesh"], compare(still)["wave-mesh"]
    assert followed.block[-1] > 0.0  # it has not come back yet
    assert at_rest.block[-1] == 0.0
    assert followed.block.max() == pytest.approx(at_rest.block.max(), rel=0.5)


def test_a_slope_is_pushed_in_along_its_normal(liver, pressed):
    assert list(pressed.deflection) == ["surface"]
    depth = pressed.deflection["surface"]
    assert depth == pytest.approx(depth.max() * pressed.force / liver.peak_force, abs=1e-15)
    model = MODELS["wave-mesh"](liver)
    (tool,) = liver.tools
    state = model.static((tool.press(tool.peak),))
    centre = np.array([[*tool.position, 0.0]])
    moved, normal = model.displacement(state, centre)[0], model.elements.seen("surface", centre)[1][0]
    inwards = float(-moved @ normal)
    assert inwards > 1.03 * -moved[2] > 0.0
    assert (
        inwards * (1 - 1e-9) <= depth.max() < 1.1 * inwards
    )  # on long elements the deepest point lies beside


def test_a_block_of_its_skin_says_where_a_mesh_leaves_the_linear_range(liver, pressed):
    found = pressed.linear_range
    block = Tissue(layers=(replace(liver.mesh.materials[0], thickness=liver.mesh.thickness),))
    (tool,) = liver.tools
    model = WaveSolid(block, size=liver.size, support=Support.BASE)
    expected = linear_range(model, block, (tool.press(tool.peak),))
    assert found.force_limit == pytest.approx(expected.force_limit)
    assert found.inside
    hard = range_on_mesh(liver.mesh, "surface", (tool.press(1.1 * found.force_limit),))
    assert not hard.inside


def test_models_for_blocks_take_no_mesh():
    assert usual_models(MESHED) == ("wave-mesh",)
    for name in set(MODELS) - {"wave-mesh"}:
        with pytest.raises(InputError, match="models: expected wave-mesh, which takes a mesh, got"):
            compare(MESHED, ("wave-mesh", name))


def test_size_and_support_are_the_meshs_own():
    for change in ({"size": (0.03, 0.02)}, {"support": Support.BASE}):
        with pytest.raises(InputError, match="the mesh's own size and support"):
            replace(MESHED, **change)
