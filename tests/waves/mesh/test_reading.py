"""A mesh in a file becomes a tissue, or a sentence that says what to do."""

import meshio
import numpy as np
import pytest

from trocar.errors import InputError
from trocar.waves.mesh import mesh_file
from trocar.waves.mesh.reading import _UP
from trocar.waves.mesh.solid_mesh import SolidMesh, volumes_of
from waves.mesh.mesh_files import ball, block_file
from waves.mesh.meshes import BLOCK, LAYERS, tetrahedra

BY_NAME = {layer.name: layer for layer in LAYERS.layers}


@pytest.mark.parametrize("kind", ["hexahedron", "tetra"])
def test_a_file_of_gmsh_is_the_mesh_that_was_written(tmp_path, kind):
    path = block_file(tmp_path / "block.msh", kind=kind, file_format="gmsh22", binary=False)
    mesh = SolidMesh.read(path, BY_NAME, held="base")
    expected = BLOCK if kind == "hexahedron" else tetrahedra(BLOCK)
    assert mesh.corners == pytest.approx(expected.corners, abs=1e-12)
    assert (mesh.cells == expected.cells).all()
    assert (mesh.region == expected.region).all()
    assert sorted(map(sorted, mesh.held[0].faces.tolist())) == sorted(
        map(sorted, expected.held[0].faces.tolist())
    )
    assert len(mesh.surfaces["surface"]) == len(expected.surfaces["cover"])
    assert mesh.materials == LAYERS.layers


@pytest.mark.parametrize("ending", [".vtk", ".vtu", ".inp", ".mesh"])
def test_other_formats_hold_the_same_solid(tmp_path, ending):
    corners, cells = 1e3 * BLOCK.corners, BLOCK.cells
    path = tmp_path / f"block{ending}"
    meshio.Mesh(corners, [("hexahedron", cells)]).write(path)
    mesh = SolidMesh.read(path, LAYERS.layers[0], held="below")
    assert volumes_of(mesh.corners, mesh.cells).sum() == pytest.approx(0.02 * 0.02 * 0.0062)
    assert len(mesh.held[0].faces) == len(BLOCK.held[0].faces)


def test_groups_of_abaqus_are_regions_and_supports(tmp_path):
    path = tmp_path / "block.inp"
    low = np.flatnonzero(BLOCK.corners[:, 2] < -6.1e-3)
    meshio.Mesh(
        1e3 * BLOCK.corners,
        [("hexahedron", BLOCK.cells)],
        point_sets={"bed": low},
        cell_sets={layer.name: [np.flatnonzero(BLOCK.region == i)] for i, layer in enumerate(LAYERS.layers)},
    ).write(path)
    mesh = SolidMesh.read(path, BY_NAME, held="bed")
    assert (mesh.region == BLOCK.region).all()
    assert len(mesh.held[0].faces) == len(BLOCK.held[0].faces)


def test_quadratic_elements_give_their_corners(tmp_path):
    corners = np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]])
    pairs = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
    points = np.concatenate([corners, [(corners[i] + corners[j]) / 2 for i, j in pairs]])
    path = tmp_path / "one.vtu"
    meshio.Mesh(points, [("tetra10", np.arange(10)[None])]).write(path)
    mesh = SolidMesh.read(path, LAYERS.layers[0])
    assert mesh.corners.shape == (4, 3)


def test_every_way_up_keeps_right_hands():
    for name, rows in _UP.items():
        assert np.linalg.det(rows) == pytest.approx(1)
        assert np.array(rows) @ np.eye(3)["xyz".index(name[1])] * (
            1 if name[0] == "+" else -1
        ) == pytest.approx([0, 0, 1])


@pytest.mark.parametrize("ending", [".stl", ".obj", ".ply"])
def test_a_closed_surface_is_filled(tmp_path, ending):
    three, triangles = ball()
    path = tmp_path / f"ball{ending}"
    meshio.Mesh(three, [("triangle", triangles)]).write(path)
    mesh = SolidMesh.read(path, LAYERS.layers[0], spacing=4e-3)
    a, b, c = np.moveaxis(1e-3 * three[triangles], 1, 0)
    enclosed = np.einsum("kc,kc->k", a, np.cross(b, c)).sum() / 6
    # second order in the spacing: at a fifth of the radius the chords of the ball's surface lose 2 %
    assert volumes_of(mesh.corners, mesh.cells).sum() == pytest.approx(enclosed, rel=0.02)


def test_elements_that_are_all_numbered_the_other_way_are_read(tmp_path):
    mesh = tetrahedra(BLOCK)
    path = block_file(tmp_path / "b.vtu", kind="tetra", cells=mesh.cells[:, [1, 0, 2, 3]])
    assert volumes_of(*_read(path)).min() > 0


def _read(path, **options):
    mesh = SolidMesh.read(path, LAYERS.layers[0], **options)
    return mesh.corners, mesh.cells


def _hole(tmp_path):
    three, triangles = ball()
    meshio.Mesh(three, [("triangle", triangles[:-3])]).write(tmp_path / "hole.stl")
    return tmp_path / "hole.stl"


def _two_balls(tmp_path):
    three, triangles = ball(4, 5.0)
    both = np.concatenate([three, three + 30.0])
    meshio.Mesh(both, [("triangle", np.concatenate([triangles, triangles + len(three)]))]).write(
        tmp_path / "b.ply"
    )
    return tmp_path / "b.ply"


def _written(name, text):
    def write(tmp_path):
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


def _block(name="b.vtu", **options):
    return lambda tmp_path: block_file(tmp_path / name, **options)


def _torn(tmp_path):
    path = block_file(tmp_path / "b.vtu")
    path.write_bytes(path.read_bytes()[:3000])
    return path


CORNERS = 1e3 * BLOCK.corners
INVERTED = BLOCK.cells.copy()
INVERTED[7] = INVERTED[7][[1, 0, 2, 3, 5, 4, 6, 7]]
WEDGE = ("wedge", np.array([[0, 1, 2, 3, 4, 5]]))


@pytest.mark.parametrize(
    ("file", "options", "said"),
    [
        (_block(cells=INVERTED), {}, "1 flat or inverted, the first 7"),
        (_block(points=1e-3 * CORNERS), {}, "it looks like m; pass unit='m'"),
        (_block(points=CORNERS), {"unit": "m"}, "it looks like cm or mm; pass unit='cm'"),
        (_block(), {"unit": "inch"}, "unit: expected one of m, cm, mm, um"),
        (_block(), {"up": "z"}, "up: expected one of"),
        (_block(), {"held": "bed"}, "held: expected one of .*below, as in .*, got 'bed'"),
        (_block(points=np.append(CORNERS, [[0.0, 0, 0]], axis=0)), {}, "1 in none.*pass drop_unused=True"),
        (_block(extra=[WEDGE]), {}, "got 'wedge'; mesh it with tetrahedra alone"),
        (_block(extra=[("tetra", BLOCK.cells[:1, [0, 1, 2, 5]])]), {}, "both in one file"),
        (
            _block(cells=np.concatenate([BLOCK.cells[:-1], BLOCK.cells[-1:] + 1000])),
            {},
            "elements of nodes 0 to",
        ),
        (_torn, {}, "expected a whole .vtu file"),
        (_hole, {}, "edges of holes .*close the holes"),
        (_two_balls, {}, "one closed surface, got '2 pieces'"),
        (_written("a.stl", ""), {}, "a.stl: .*the file holds no triangles"),
        (_written("a.stl", "solid a\nendsolid a\n"), {}, "a.stl: .*the file holds no triangles"),
        (_written("a.stl", 84 * "\0"), {}, "a.stl: .*the file holds no triangles"),
        (_written("a.off", "OFF\n0 0 0\n"), {}, "a.off: .*the file holds no triangles"),
        (_written("a.msh", "hello"), {}, "a whole .msh file"),
        (_written("a.step", "hello"), {}, "a file that ends in"),
        (lambda tmp_path: tmp_path / "none.vtu", {}, "a mesh file that can be read.*No such file"),
        (lambda tmp_path: _folder(tmp_path / "folder.vtu"), {}, "a mesh file that can be read.*directory"),
    ],
)
def test_a_file_that_cannot_be_a_tissue_is_refused(tmp_path, file, options, said):
    with pytest.raises(InputError, match=said):
        _read(file(tmp_path), **options)


def _folder(path):
    path.mkdir()
    return path


def test_what_no_element_has_can_be_left_out(tmp_path):
    path = block_file(tmp_path / "b.vtu", points=np.append(CORNERS, [[0.0, 0, 99.0]], axis=0))
    corners, _ = _read(path, drop_unused=True)
    assert corners == pytest.approx(BLOCK.corners, abs=1e-12)


def test_regions_need_materials(tmp_path):
    path = block_file(tmp_path / "block.msh", file_format="gmsh22", binary=False)
    with pytest.raises(InputError, match=r"regions of the file: cover \(144 elements\), .*got 'bone'"):
        SolidMesh.read(path, {"bone": LAYERS.layers[0]})
    with pytest.raises(InputError, match="name a layer for every region"):
        SolidMesh.read(path, {"fat": LAYERS.layers[2]})


def test_a_million_nodes_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "many.vtk"
    meshio.Mesh(np.zeros((1_000_000, 3)), [("tetra", [[0, 1, 2, 3]])]).write(path)
    with pytest.raises(InputError, match="at most 200000 nodes, got 1000000; make larger elements"):
        _read(path)
    monkeypatch.setattr(mesh_file, "LARGEST_FILE", 1_000)
    with pytest.raises(InputError, match="at most 0 MB"):
        _read(path)
