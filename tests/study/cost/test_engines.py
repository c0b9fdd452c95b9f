"""`bench/engines.py` without the engines: meshes, forces, cases and what is said where no engine is installed."""

import importlib
import sys
from collections import Counter
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from sample_tissues import three_layers
from trocar.errors import SolverError
from trocar.study.cost.accuracy import DYNAMIC, LARGE, STATIC, Trial
from trocar.study.stiffening import Dent

BENCH = Path(__file__).parents[3] / "bench"
OWN = ("engines", "engine_meshes", "engine_rungs", "engine_trials")
TISSUE, SIZE = three_layers(), (0.03, 0.02)
DENT = Dent(name="three layers", tissue=TISSUE, size=SIZE)


@pytest.fixture
def bench(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCH))
    yield {name: importlib.import_module(name) for name in OWN}
    for name in OWN:
        sys.modules.pop(name, None)


@pytest.fixture
def meshes(bench):
    made = bench["engine_meshes"]
    return (
        made.graded(TISSUE, SIZE, DENT.load(1.0), 0.75),
        made.even(TISSUE, SIZE, 4, 1),
        made.even(TISSUE, SIZE, 4, 2),
    )


def test_a_mesh_weighs_what_the_block_weighs(meshes):
    expected = SIZE[0] * SIZE[1] * sum(layer.thickness * layer.density for layer in TISSUE.layers)
    for mesh in meshes:
        masses = mesh.masses(TISSUE)
        assert masses.min() > 0.0
        assert masses.sum() == pytest.approx(expected, rel=1e-12)  # rounding


def test_tetrahedra_are_the_right_way_round_and_meet_face_to_face(meshes):
    mesh = meshes[0]
    a, b, c, d = (mesh.nodes[:, mesh.tetrahedra[:, i]].T for i in range(4))
    assert np.einsum("ni,ni->n", b - a, np.cross(c - a, d - a)).min() > 0.0
    faces = Counter(
        tuple(sorted(face)) for four in mesh.tetrahedra for face in combinations(map(int, four), 3)
    )
    nx, ny, nz = mesh.shape
    assert set(faces.values()) == {1, 2}
    assert sum(count == 1 for count in faces.values()) == 4 * (nx * ny + ny * nz + nx * nz)


def test_the_force_is_all_there_and_under_the_tool(meshes):
    load = DENT.load(0.2)
    for mesh in meshes:
        forces = mesh.forces(load)
        assert forces.sum(axis=0) == pytest.approx([0.0, 0.0, -0.2], abs=1e-14)
        assert mesh.nodes[:2] @ forces[:, 2] == pytest.approx(
            -0.2 * np.array([load[0].x, load[0].y]), rel=1e-9
        )


def test_faces_give_back_polynomials_of_their_order(meshes):
    points = np.random.default_rng(3).uniform(0.0, SIZE, (40, 2))
    for mesh, order in zip(meshes, (1, 1, 2), strict=True):
        tops = -np.cumsum([0.0, *(layer.thickness for layer in TISSUE.layers)])
        for layer, top in enumerate(tops[:-1]):
            x, y, z = mesh.nodes
            found = mesh.surface(points, layer) @ ((x + 2 * y) ** order + z)
            assert found == pytest.approx((points @ [1.0, 2.0]) ** order + top, abs=1e-14)


def test_a_layer_has_its_own_nodes_and_those_it_shares(meshes):
    for mesh in meshes:
        for layer, below in zip(range(2), range(1, 3), strict=True):
            shared = np.intersect1d(mesh.layer_nodes(layer), mesh.layer_nodes(below))
            assert np.ptp(mesh.nodes[2, shared]) == 0.0
            assert len(shared) == len(mesh.node_lines[0]) * len(mesh.node_lines[1])


class Sponge:
    """An engine without inertia: every free node sinks by the same length per force on the block."""

    def __init__(self, mesh, softness):
        self.mesh, self.softness, self.dofs, self.now = mesh, softness, 7, 0.0

    def rest(self, forces):
        self.step(forces, 1.0)
        if self.softness < 0:
            raise SolverError("no rest")
        return self.displacement()

    def step(self, forces, dt):
        self.now = self.softness * forces[:, 2].sum()

    def displacement(self):
        return np.where(self.mesh.held[:, None], 0.0, [0.0, 0.0, self.now])


@pytest.mark.parametrize("case", [STATIC, LARGE])
def test_an_engine_at_rest_is_held_against_the_worst_layer(bench, meshes, case):
    (found,) = run(bench, case, Sponge(meshes[0], 0.01), np.array([0.1, 0.11, 0.11]), force=11.0)
    assert found.error == pytest.approx(0.1, rel=1e-9)
    assert found.dofs == 7
    assert found.second_s > 0.0


def test_a_swing_is_read_every_millisecond(bench, meshes):
    times = 5e-4 * np.arange(81)
    answer = 2e-3 * np.where(times < 0.02, np.sin(np.pi * times / 0.02), 0.0)
    (found,) = run(bench, DYNAMIC, Sponge(meshes[2], 0.01), answer, force=0.2)
    late = np.pi * bench["engine_trials"].STEP / 2 / 0.02  # a step's force is that of its middle
    assert found.error == pytest.approx(late, rel=0.01)  # to first order in the step


def test_an_engine_that_comes_to_no_rest_is_told(bench, meshes):
    (found,) = run(bench, STATIC, Sponge(meshes[1], -1.0), np.ones(3), force=1.0)
    assert found.error is None
    assert found.failure == "no rest"
    assert "no rest" in bench["engines"].tabulate([found])


def run(bench, case, engine, answer, *, force):
    rung = bench["engine_rungs"].Rung(engine="sponge", setting="one", share=0.5, build=lambda dent: engine)
    trial = Trial(name=case, dent=DENT, load=DENT.load(force), answer=answer)
    return list(bench["engine_trials"].engine_points(trial, [rung]))


def test_without_any_engine_one_sentence_says_what_to_install(bench, monkeypatch, capsys):
    monkeypatch.setattr(bench["engines"], "find_spec", lambda name: None)
    assert bench["engines"].main([]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.splitlines() == [
        f"{name} is not installed: expected trocar[engines] (pip install 'trocar[engines]')"
        for name in ("mujoco", "newton")
    ]


def test_an_unknown_engine_is_refused(bench, capsys):
    with pytest.raises(SystemExit, match="2"):
        bench["engines"].main(["--engines", "bullet"])
    assert "expected some of mujoco, newton, got bullet" in capsys.readouterr().err


def test_every_engine_has_a_mark_in_the_figure(bench):
    rungs = bench["engine_rungs"]
    named = {rung.engine for make in rungs.ENGINES.values() for rung in make()}
    assert named <= set(rungs.MARKS)
