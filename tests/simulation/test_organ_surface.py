"""What is shown of an organ: its rest shape, the dent under a tip along the normal, and the other faces."""

import numpy as np
import pytest

from trocar.contact.instrument import TipKind
from trocar.errors import InputError
from trocar.simulation import FORCE, RECORD, amplitudes, at_rest, line, played, poses_along
from trocar.simulation.live_organ import live_organ, organ_mesh
from trocar.simulation.organ import Organ, make_organ_scene
from trocar.simulation.organ_surface import OrganSurface
from trocar.study.contact.scenes import upright
from trocar.tissues.catalogue import tissue
from trocar.tissues.nodule import Nodule
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.organ_name import ORGANS
from trocar.waves.mesh.press_grid import cubic_table
from trocar.waves.mesh.wave_mesh import WaveMesh

GRID = (51, 31)
DEEP = 4e-3
ON = (0.12, 0.05)


@pytest.fixture(scope="module")
def organ():
    return Organ.of(WaveMesh(Liver().mesh(tissue("liver").layers[-1], spacing=0.025), modes=30), name="liver")


@pytest.fixture(scope="module")
def shown(organ):
    """Return the surface, its picture at rest, and picture and record under a probe that is pressed in and still."""
    tools = upright((TipKind.GRASPER, TipKind.PROBE), ((0.08, 0.05), ON))
    scene = make_organ_scene(organ, tools)
    surface, state = OrganSurface(scene, organ, grid=GRID), at_rest(scene)
    picture = np.zeros((1, *scene.modes))
    at_first = surface.moved(picture, np.zeros((2, RECORD)))
    height = organ.model.elements.heights("surface", np.array([ON]))[0]
    down = line((*ON, height + 2e-3), (*ON, height - DEEP), 300)
    records = played(
        scene, poses_along(tools, (None, np.concatenate([down, np.repeat(down[-1:], 600, axis=0)]))), state
    )
    amplitudes(scene, state, picture)
    return surface, at_first, surface.moved(picture, records[-1]), records[-1]


def test_nodes_lie_on_the_organ_and_those_beside_it_are_left_out(organ, shown):
    surface = shown[0]
    heights = heights_on(organ)
    drawn, on = np.isfinite(surface.rest), np.isfinite(heights)
    assert drawn[on].all()
    assert set(np.flatnonzero((drawn & ~on).ravel())) == set(surface.rim)
    assert np.abs(surface.rest - heights)[on].max() < 1e-12
    assert np.isnan(surface.rest[0, 0])
    assert np.nanmax(surface.rest) <= 0.0


def test_nodes_next_beside_the_organ_are_drawn_to_its_outline(organ, shown):
    surface = shown[0]
    on = np.isfinite(heights_on(organ))
    near = sum(np.roll(on, (j, i), (0, 1)) for j in (-1, 0, 1) for i in (-1, 0, 1)) > 0
    assert set(surface.rim) == set(np.flatnonzero((near & ~on).ravel()))
    assert np.isfinite(organ.model.elements.heights("surface", surface.rim_places)).all()
    outward = nodes_of(organ).reshape(-1, 2)[surface.rim] - surface.rim_places
    beyond = surface.rim_places + 1e-5 * outward / np.maximum(
        np.linalg.norm(outward, axis=1, keepdims=True), 1e-9
    )
    assert np.isnan(organ.model.elements.heights("surface", beyond)).mean() > 0.95  # it may wind in and out


def test_the_other_faces_look_outwards_and_close_the_organ(organ, shown):
    corners, normals, faces = shown[0].sides
    a, b, c = (corners[faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    middle = (a + b + c) / 3
    assert (np.einsum("kc,kc->k", across, normals[faces].mean(axis=1)) > 0).mean() > 0.95  # sharp rims apart
    below = middle[:, 2] < np.quantile(corners[:, 2], 0.2)
    assert (across[below, 2] < 0).mean() > 0.9
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(len(corners)))


def nodes_of(organ):
    x, y = (np.linspace(0, side, n) for side, n in zip(organ.size, GRID, strict=True))
    return np.stack(np.meshgrid(x, y), axis=-1)


def heights_on(organ):
    return organ.model.elements.heights("surface", nodes_of(organ).reshape(-1, 2)).reshape(GRID[::-1])


def test_at_rest_nothing_is_moved(shown):
    heights, along = shown[1]
    assert heights.shape == (1, GRID[1], GRID[0])
    assert along.shape == (2, GRID[1], GRID[0])
    assert not heights.any()
    assert not along.any()


def test_the_dent_is_as_deep_as_the_tip_stands_and_goes_along_the_normal(organ, shown):
    _, _, (heights, along), record = shown
    node = np.unravel_index(np.argmin(heights[0]), heights[0].shape)
    x, y = (np.linspace(0, side, n) for side, n in zip(organ.size, GRID, strict=True))
    assert np.hypot(x[node[1]] - ON[0], y[node[0]] - ON[1]) < 6e-3
    moved = np.array([along[0][node], along[1][node], heights[0][node]])
    normal = organ.model.elements.seen("surface", np.array([[x[node[1]], y[node[0]]]]))[1][0]
    assert moved @ normal < -0.98 * np.linalg.norm(moved)
    # The node nearest to the tip is up to 3 mm beside it.
    assert 0.6 * DEEP < np.linalg.norm(moved) < 1.05 * DEEP
    assert record[1, FORCE + 2] > 0.02


def test_every_outer_face_is_drawn_by_the_grid_or_among_the_sides(organ, shown):
    corners, _, faces = shown[0].sides
    assert faces.max() == len(corners) - 1
    low = organ.model.mesh.corners[:, 2].min()
    assert corners[:, 2].min() == pytest.approx(low)
    a, b, c = (corners[faces[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    outer = organ.model.mesh
    assert areas.min() > 0
    assert areas.sum() < 0.75 * 2 * np.prod(outer.size)  # its upper side is drawn by the grid


def test_sites_between_which_places_lie_give_a_cubic_of_their_heights(organ):
    places = organ.grid.places[:, :2]
    inner = places[np.linalg.norm(places - ON, axis=1) < 0.02]
    table = cubic_table(organ.grid, inner + 1e-9)
    assert np.asarray(table.sum(axis=1)).ravel() == pytest.approx(1.0)
    heights = organ.grid.places[np.linalg.norm(places - ON, axis=1) < 0.02, 2]
    assert table @ organ.grid.places[:, 2] == pytest.approx(heights, abs=1e-8)
    assert cubic_table(organ.grid, np.array([[-1.0, -1.0], [0.0, 0.0]])).nnz == 0


def test_a_liver_of_the_lowest_layer_is_made_by_name():
    mesh = organ_mesh("liver", tissue("liver"))
    assert ORGANS == ("liver",)
    assert [layer.name for layer in mesh.materials] == ["parenchyma"]


def test_regions_of_a_file_take_the_layers_of_their_names(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = Liver().mesh(tissue("liver").layers[-1], spacing=0.03)
    half = mesh.corners[mesh.cells].mean(axis=1)[:, 0] < 0.1
    regions = {"capsule": [np.flatnonzero(half)], "parenchyma": [np.flatnonzero(~half)]}
    path = tmp_path / "organ.inp"
    meshio.Mesh(1e3 * mesh.corners, [("tetra", mesh.cells)], cell_sets=regions).write(path)
    read = organ_mesh(str(path), tissue("liver"))
    assert sorted(layer.name for layer in read.materials) == ["capsule", "parenchyma"]
    alone = organ_mesh(str(path), tissue("silicone-pad"))
    assert [layer.name for layer in alone.materials] == ["body"]


@pytest.mark.parametrize("name", ["kidney", "organ.pdf"])
def test_no_such_organ_is_a_sentence(name):
    with pytest.raises(InputError, match="liver, or a file"):
        organ_mesh(name, tissue("liver"))


def test_what_was_prepared_is_kept(tmp_path):
    mesh = Liver().mesh(tissue("liver").layers[-1], spacing=0.03)
    told, found = [], []

    def tell(done, total):
        told.append(done / total)

    def find(done, total):
        found.append(done / total)

    one = live_organ(mesh, name="liver", cache=BasisCache(tmp_path), found=find, progress=tell)
    assert found[-1] == 1.0
    assert len(found) > 2
    assert told[-1] == 1.0
    assert sorted(told) == told
    asked = len(told)
    again = live_organ(mesh, cache=BasisCache(tmp_path), progress=tell)
    assert len(told) == asked
    assert np.array_equal(one.modes.rest, again.modes.rest)
    assert one.block.name == "liver"
    assert one.block.layers[0].thickness == pytest.approx(one.thickness)


def test_a_nodule_in_an_organ_lies_under_its_surface():
    lump = Nodule(x=ON[0], y=ON[1], depth=9e-3, radius=6e-3, young_modulus=9e4)
    mesh = organ_mesh("liver", tissue("liver"), nodules=(lump,))
    held = mesh.corners[mesh.cells[mesh.region == 1]]
    height = Elements(mesh).heights("surface", np.array([ON]))[0]
    assert len(held) > 20
    assert held.mean(axis=(0, 1))[:2] == pytest.approx(ON, abs=2e-3)
    assert held[..., 2].mean() == pytest.approx(height - 9e-3, abs=1.5e-3)
    assert [layer.name for layer in mesh.materials] == ["parenchyma", "nodule 1"]
    assert mesh.materials[1].retardation_time == mesh.materials[0].retardation_time


@pytest.mark.parametrize(
    ("change", "words"),
    [({"x": 0.001, "y": 0.001}, "over the organ"), ({"radius": 5e-4}, "ellipsoid as large as")],
)
def test_a_nodule_that_cannot_be_is_a_sentence(change, words):
    lump = Nodule(**({"x": ON[0], "y": ON[1], "depth": 9e-3, "radius": 6e-3, "young_modulus": 9e4} | change))
    with pytest.raises(InputError, match=words):
        organ_mesh("liver", tissue("liver"), nodules=(lump,))
