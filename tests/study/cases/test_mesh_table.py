"""The table [mesh] of a case file: what it means, and every mistake in it refused at its key."""

import meshio
import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.calibration.response import check_model
from trocar.study.cases.reading import load_case
from waves.mesh.mesh_files import ball, block_file

BALL = 'file = "ball.stl"\nspacing_mm = 8'
LAYER = """
[[layer]]
name = "{name}"
young_modulus_kpa = {modulus}
poisson_ratio = 0.48
density_kg_m3 = 1060
"""
REST = """
[[tool]]
diameter_mm = {diameter}
position_mm = [{x}, {y}]
peak_n = 0.1
rate_n_s = 0.1
[sampling]
period_s = 0.5
"""


def written(folder, mesh, layers=(("jelly", 5),), more="", x=20, y=20, diameter=4):
    """Write a case file with the lines of a table [mesh]."""
    file = folder / "case.toml"
    materials = "".join(LAYER.format(name=name, modulus=modulus) for name, modulus in layers)
    tool = REST.format(x=x, y=y, diameter=diameter)
    file.write_text(f'title = "a mesh"\n[mesh]\n{mesh}\n{materials}{tool}{more}', "utf-8")
    return file


def ball_file(folder):
    """Write a ball 40 mm wide beside the case."""
    corners, triangles = ball(6)
    meshio.Mesh(corners, [("triangle", triangles)]).write(folder / "ball.stl")


def test_the_liver_is_the_one_that_trocar_makes_closer_about_the_tool(tmp_path):
    case = load_case(written(tmp_path, 'file = "liver"\nspacing_mm = 40', x=120, y=45, diameter=12))
    even = load_case(written(tmp_path, 'file = "liver"\nspacing_mm = 40', x=60, y=45, diameter=12))
    assert case.faces == ("surface",)
    assert case.size == case.mesh.size
    assert case.size == pytest.approx((0.19, 0.11), rel=0.1)
    (layer,) = case.tissue.layers
    assert layer.thickness == case.mesh.thickness
    assert layer.young_modulus == case.mesh.materials[0].young_modulus == 5e3

    def closest(mesh):
        return np.linalg.norm(mesh.corners[:, :2] - [0.12, 0.045], axis=1).argsort()[:40]

    def spread(mesh):
        return np.ptp(mesh.corners[closest(mesh)], axis=0).max()

    assert spread(case.mesh) < spread(even.mesh)


def test_a_file_lies_beside_the_case_and_is_read_as_its_keys_say(tmp_path):
    ball_file(tmp_path)
    case = load_case(written(tmp_path, BALL))
    assert case.size == pytest.approx(
        (0.04, 0.04), rel=0.1
    )  # chords of the ball's six rings, a spacing of a fifth
    finer = load_case(written(tmp_path, 'file = "ball.stl"\nspacing_mm = 6'))
    assert len(finer.mesh.cells) > 1.5 * len(case.mesh.cells)
    wider = load_case(written(tmp_path, 'file = "ball.stl"\nunit = "cm"\nspacing_mm = 80', x=200, y=200))
    assert wider.size == pytest.approx(10 * np.array(case.size))
    block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    keys = 'file = "block.msh"\nunit = "mm"\nup = "+x"\nheld = "below"\ntouched = "above"'
    upright = load_case(written(tmp_path, keys, x=10, y=3))
    assert (*upright.size, upright.mesh.thickness) == pytest.approx((0.02, 6.2e-3, 0.02))


def test_layers_are_the_materials_of_a_files_regions(tmp_path):
    block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    three = (("fat", 8), ("cover", 100), ("middle", 40))
    case = load_case(written(tmp_path, 'file = "block.msh"\nheld = "base"', three, x=10, y=10))
    moduli = {one.name: one.young_modulus for one in case.mesh.materials}
    assert moduli == {"fat": 8e3, "cover": 1e5, "middle": 4e4}
    assert len(np.unique(case.mesh.region)) == 3
    one = load_case(written(tmp_path, 'file = "block.msh"', x=10, y=10))
    assert len(one.mesh.materials) == 1


@pytest.mark.parametrize(
    ("mesh", "more", "place", "said"),
    [
        ("", {}, "mesh.file", "got nothing; add the key"),
        ('file = "lver"', {}, "mesh.file", "liver, or a file that ends in"),
        ('file = "nothing.stl"', {}, "mesh.file", "nothing.stl"),
        ('file = "ball.stl"\nunits = "mm"', {}, "mesh.units", "did you mean unit?"),
        ('file = "ball.stl"\nunit = "inch"', {}, "mesh.unit", "one of m, cm, mm, um, got 'inch'"),
        ('file = "ball.stl"\nunit = "m"', {}, "mesh.file", "it looks like"),
        ('file = "ball.stl"\nup = "z"', {}, "mesh.up", "one of +z, -z"),
        ('file = "ball.stl"\nheld = "bed"', {}, "mesh.held", "one of above, below, as in"),
        ('file = "ball.stl"\ntouched = 3', {}, "mesh.touched", "printable text"),
        ('file = "ball.stl"\nspacing_mm = 0', {}, "mesh.spacing_mm", "a number from 0.01"),
        ('file = "ball.stl"\nspacing_mm = 0.02', {}, "mesh.spacing_mm", "take a larger one"),
        ('file = "block.msh"\nspacing_mm = 4', {"x": 10, "y": 10}, "mesh.spacing_mm", "leave it out"),
        ('file = "liver"\nup = "+y"', {}, "mesh.up", "no such key beside liver"),
        ('file = "liver"', {"x": 500}, "tool[0].position_mm", "a place on the organ"),
        (BALL, {"x": 2, "y": 2}, "tool[0].position_mm", "a place over the surface"),
        (BALL, {"x": 5.5, "y": 7.5, "diameter": 0.2}, "tool[0].position_mm", "75 degrees"),
        (BALL, {"layers": (("a", 1), ("b", 2))}, "layer[0].name", "a region of the mesh"),
        ('file = "block.msh"', {"layers": (("fat", 1), ("muscle", 2))}, "mesh.file", "elements without"),
        (BALL, {"more": "[block]\nsize_mm = [60, 60]\n"}, "mesh", "got both"),
    ],
)
def test_a_mistake_is_one_line_that_names_its_key(tmp_path, mesh, more, place, said):
    ball_file(tmp_path)
    block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    file = written(tmp_path, mesh, **more)
    with pytest.raises(InputError) as caught:
        load_case(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: {place}")
    assert said in message
    assert "\n" not in message


def test_a_thickness_beside_a_mesh_and_a_rigid_tip_on_one_are_refused(tmp_path):
    ball_file(tmp_path)
    file = written(tmp_path, BALL)
    text = file.read_text("utf-8")
    file.write_text(text.replace("poisson_ratio", "thickness_mm = 3\npoisson_ratio"), "utf-8")
    with pytest.raises(InputError, match=r"layer\[0\].thickness_mm: expected no such key beside \[mesh\]"):
        load_case(file)
    file.write_text(text.replace("diameter_mm", 'contact = "rigid"\ndiameter_mm'), "utf-8")
    with pytest.raises(InputError, match=r'tool\[0\].contact: expected "dead" on a mesh'):
        load_case(file)
    file.write_text(text.replace("[mesh]\n", "").replace(BALL, ""), "utf-8")
    with pytest.raises(InputError, match=r"layer\[0\].thickness_mm"):
        load_case(file)


def test_a_mesh_is_not_calibrated_on(tmp_path):
    ball_file(tmp_path)
    case = load_case(written(tmp_path, BALL))
    with pytest.raises(InputError, match=r"mesh: expected a \[block\]"):
        check_model(case, "wave-solid")
