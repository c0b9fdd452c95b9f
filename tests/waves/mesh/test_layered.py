"""Layers of varying thickness, and nodules."""

from math import pi

import numpy as np
import pytest
from PIL import Image

from trocar.errors import InputError
from trocar.tissues import Layer
from trocar.waves.mesh.inclusion import with_inclusion
from trocar.waves.mesh.layered import layered_mesh
from trocar.waves.mesh.solid_mesh import volumes_of
from trocar.waves.mesh.thickness_map import thickness_map
from waves.mesh.meshes import ACROSS, BLOCK, LAYERS, THROUGH, tetrahedra

LINES = (ACROSS, ACROSS, THROUGH)
NODULE = Layer(name="nodule", thickness=1e-3, young_modulus=5e4, poisson_ratio=0.45, density=1050)


def wedge(x, y):
    return 3e-3 + 0.2 * x


@pytest.mark.parametrize("flat", ["top", "base"])
def test_a_wedge_has_its_volume_and_a_plane_side(flat):
    mesh = layered_mesh(LAYERS, LINES, {"fat": wedge}, flat=flat)
    volume = volumes_of(mesh.corners, mesh.cells)
    mean = {"cover": 2e-4, "middle": 1e-3, "fat": 5e-3}
    for number, name in enumerate(LAYERS.layer_names):
        # the least of the volumes at a corner is that of the thinner end of an element: a twelfth of 4 mm over 5 mm
        assert volume[mesh.region == number].sum() == pytest.approx(0.02**2 * mean[name], rel=0.05)
    low, high = (mesh.corners[np.isin(BLOCK.corners[:, 2], z), 2] for z in (THROUGH[0], THROUGH[-1]))
    assert np.ptp(high if flat == "top" else low) < 1e-12
    assert np.ptp(low if flat == "top" else high) == pytest.approx(0.2 * 0.02)
    assert mesh.corners[:, 2].max() == pytest.approx(0.0, abs=1e-12)


def test_even_thickness_is_the_block():
    mesh = layered_mesh(LAYERS, LINES, {"fat": np.full((len(ACROSS), len(ACROSS)), 5e-3)})
    assert mesh.corners == pytest.approx(BLOCK.corners, abs=1e-12)


@pytest.mark.parametrize(
    ("thickness", "said"),
    [
        ({"bone": wedge}, "names of layers, of cover, middle, fat, got 'bone'"),
        ({"fat": np.ones((3, 3))}, r"a value at each of \(13, 13\) lines"),
        ({"fat": lambda x, y: np.full_like(x, np.nan)}, "finite numbers"),
        ({"fat": lambda x, y: 5e-3 - 0.3 * x}, "at least 0.05 mm everywhere.*got '-1 mm at x = 20"),
    ],
)
def test_a_thickness_that_is_none_is_refused(thickness, said):
    with pytest.raises(InputError, match=said):
        layered_mesh(LAYERS, LINES, thickness)


def test_one_face_is_flat():
    with pytest.raises(InputError, match="flat: expected one of top, base, got 'both'"):
        layered_mesh(LAYERS, LINES, {}, flat="both")


def test_maps_in_files_agree(tmp_path):
    table = np.array([[4.0, 5.0, 6.0], [2.0, 3.0, 4.0]])  # rows from the largest y down
    np.savetxt(tmp_path / "map.csv", table, delimiter=",")
    np.save(tmp_path / "map.npy", table)
    Image.fromarray(np.round((table - 2) * 60).astype(np.uint8)).save(tmp_path / "map.png")
    x, y = np.array([0.0, 0.02, 0.01]), np.array([0.0, 0.01, 0.005])
    for name in ("map.csv", "map.npy", "map.png"):
        read = thickness_map(tmp_path / name, (0.02, 0.01), black_mm=2.0, white_mm=2.0 + 255 / 60)
        assert read(x, y) == pytest.approx([2e-3, 6e-3, 4e-3], rel=1e-12)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("map.csv", b"1,2\n3\n", "as many in each row"),
        ("map.csv", b"", "2 to 4096 rows"),
        ("map.csv", b"1,x\n3,4\n", "could not convert string to float"),
        ("map.csv", b"1,nan\n3,4\n", "rows and columns of finite numbers"),
        ("map.csv", b"1,2\n", "2 to 4096 rows"),
        ("map.npy", b"no array", "a whole .npy file"),
        ("map.png", b"no picture", "a whole .png file"),
        ("map.txt", b"1", "a .csv, .npy or .png file"),
        ("none.csv", None, "got 'No such file or directory'"),
    ],
)
def test_a_file_that_is_no_map_is_refused(tmp_path, name, content, said):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=said):
        thickness_map(tmp_path / name, (0.02, 0.02), black_mm=1, white_mm=2)
    with pytest.raises(InputError, match="pass black_mm and white_mm"):
        thickness_map(tmp_path / "map.png", (0.02, 0.02))


@pytest.mark.parametrize("mesh", [BLOCK, tetrahedra(BLOCK)], ids=["hexahedra", "tetrahedra"])
def test_a_nodule_has_its_volume(mesh):
    radii = (4e-3, 3e-3, 1.5e-3)
    found = with_inclusion(mesh, (0.01, 0.01, -3e-3), radii, NODULE)
    inside = found.region == len(LAYERS.layers)
    volume = np.abs(volumes_of(mesh.corners, mesh.cells))
    # within half an element, and what 6 samples along an edge miss of the ellipsoid
    slack = volume[inside].max() / 2 + 0.03 * 4 / 3 * pi * np.prod(radii)
    assert volume[inside].sum() == pytest.approx(4 / 3 * pi * np.prod(radii), abs=slack)
    assert found.materials[-1] is NODULE
    middle = mesh.corners[mesh.cells[inside]].mean(axis=(0, 1))
    assert middle == pytest.approx([0.01, 0.01, -3e-3], abs=5e-4)


@pytest.mark.parametrize(
    ("centre", "radii", "said"),
    [
        ((0.1, 0.0, 0.0), (1e-3, 1e-3, 1e-3), "one inside the mesh, which lies between"),
        ((0.01, 0.01, -3e-3), (1e-4, 1e-4, 1e-4), "make the elements there smaller"),
        ((0.01, 0.01, -3e-3), (1e-3, 0.0, 1e-3), "three lengths above 0"),
        ((0.01, float("nan"), -3e-3), (1e-3, 1e-3, 1e-3), "a place"),
    ],
)
def test_a_nodule_that_is_none_is_refused(centre, radii, said):
    with pytest.raises(InputError, match=said):
        with_inclusion(BLOCK, centre, radii, NODULE)
