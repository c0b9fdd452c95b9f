"""What `trocar train --mesh` says of an organ on the way."""

from dataclasses import replace

import meshio

from trocar.cli import main
from trocar.cli.organ import left_out
from trocar.simulation.live_organ import organ_mesh
from waves.mesh.mesh_files import ball, block_file
from waves.mesh.meshes import LAYERS


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
    path = block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    assert left_out(str(path), organ_mesh(str(path), LAYERS, held="base"), LAYERS) == ""


def test_a_layer_that_no_region_is_named_after_is_named(tmp_path):
    path = block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    organ = organ_mesh(str(path), LAYERS, held="base")
    more = replace(LAYERS, layers=(replace(LAYERS.layers[0], name="film"), *LAYERS.layers))
    assert (
        left_out(str(path), organ, more) == f"The organ is without film: {path} has no region of that name."
    )


def test_the_start_says_so(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["train", "--no-browser", "--mesh", "liver", "--tissue", "liver", "--ports", "oblik"]) == 2
    assert "The organ is of parenchyma alone, without capsule: the liver" in capsys.readouterr().err
