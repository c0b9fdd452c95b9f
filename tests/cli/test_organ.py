"""What `trocar train --mesh` says of an organ on the way."""

import re
from dataclasses import replace

import meshio
import pytest

from trocar.cli import main
from trocar.cli.organ import left_out, name_of
from trocar.simulation.live_organ import organ_mesh
from trocar.tissues.catalogue import tissue
from waves.mesh.mesh_files import ball, block_file
from waves.mesh.meshes import BLOCK, LAYERS


def test_layers_that_a_file_without_regions_leaves_out_are_named(tmp_path):
    path = tmp_path / "ball.stl"
    points, triangles = ball()
    meshio.Mesh(points, [("triangle", triangles)]).write(path)
    said = left_out(str(path), organ_mesh(str(path), LAYERS), LAYERS)
    assert said.startswith(
        "The organ is of fat alone, the lowest layer of the tissue, without cover and middle: "
    )
    assert f"{path} has no regions of these names. Regions of a mesh file take the layers" in said


def test_nothing_is_said_where_every_layer_has_its_region(tmp_path):
    path = block_file(tmp_path / "block.msh", points=2e3 * BLOCK.corners, file_format="gmsh22", binary=False)
    assert left_out(str(path), organ_mesh(str(path), LAYERS, held="base"), LAYERS) == ""


def test_a_layer_that_no_region_is_named_after_is_named(tmp_path):
    path = block_file(tmp_path / "block.msh", points=2e3 * BLOCK.corners, file_format="gmsh22", binary=False)
    organ = organ_mesh(str(path), LAYERS, held="base")
    more = replace(LAYERS, layers=(replace(LAYERS.layers[0], name="film"), *LAYERS.layers))
    assert (
        left_out(str(path), organ, more) == f"The organ is without film: {path} has no region of that name."
    )


def test_the_page_is_told_organ_and_tissue():
    assert name_of("scans/spleen.stl", tissue("liver")) == "spleen of liver"
    assert name_of("liver", tissue("liver")) == "liver"


def test_the_start_says_so(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["train", "--no-browser", "--mesh", "liver", "--tissue", "liver", "--ports", "oblik"]) == 2
    assert "The organ is of parenchyma alone, without capsule: the liver" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("radius", "said"),
    [
        (2.5, r"a solid 20 to 1000 mm long, got '5 x 5 x 5 mm'; it looks like cm; give --mesh-unit cm"),
        (900.0, r"a solid 20 to 1000 mm long, got '1800 x 1800 x 1800 mm'; scale the mesh"),
        (9e4, r"got '1.8e\+05 x 1.8e\+05 x 1.8e\+05 mm'; it looks like um; give --mesh-unit um"),
    ],
)
def test_an_organ_of_another_unit_is_refused_with_its_size(tmp_path, capsys, radius, said):
    path = tmp_path / "ball.stl"
    points, triangles = ball(radius=radius)
    meshio.Mesh(points, [("triangle", triangles)]).write(path)
    assert main(["train", "--no-browser", "--mesh", str(path)]) == 2
    assert re.search(said, " ".join(capsys.readouterr().err.split()))


def test_a_group_that_the_file_lacks_is_a_sentence_about_the_option(tmp_path, capsys):
    path = block_file(tmp_path / "block.msh", points=5e3 * BLOCK.corners, file_format="gmsh22", binary=False)
    assert (
        main(["train", "--no-browser", "--mesh", str(path), "--tissue", "liver", "--mesh-held", "bed"]) == 2
    )
    assert "--mesh-held: expected one of base, above, below" in capsys.readouterr().err
