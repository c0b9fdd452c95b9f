"""A live mesh's tick: patches anywhere on its surface, the exact step, and what they push each other in by."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.tissues import Layer
from trocar.waves.mesh.mesh_patch import (
    between,
    go_on,
    hold,
    let_go,
    place_patch,
    push_each_other,
    read_patches,
    stand,
    write_picture,
)
from trocar.waves.mesh.mesh_tick import at_rest, make_mesh_tick, picture_length, sunk_sites
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.press_grid import press_grid
from trocar.waves.mesh.surface_modes import surface_modes
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.near_field import half_space, near_field
from waves.mesh.meshes import COARSE

DT, WINDOW = 1e-3, 2.2e-3
LOSSY = replace(COARSE, materials=tuple(replace(one, loss_factor=0.3) for one in COARSE.materials))
JELLY = Layer(
    name="liver", thickness=0.03, young_modulus=4.5e3, poisson_ratio=0.48, density=1060, loss_factor=0.4
)
ONE, PATCHES = np.zeros((1, 1)), np.array([[-4e-4, 0.0, 4e-4], [-5e-4, 0.0, 5e-4]])
MANY = np.tile(np.linspace(-1.2e-3, 1.2e-3, 7), (2, 1))  # more points than knots


class Live:
    """A mesh with its sites and modes."""

    def __init__(self, mesh, window, modes):
        self.model = WaveMesh(mesh, modes=modes)
        self.grid = press_grid(self.model.elements, self.model.layer_names[0], window=window)
        self.modes = surface_modes(self.model, self.grid)

    def tick(self, offsets):
        tick = make_mesh_tick(self.modes, self.grid, DT, offsets=offsets)
        return tick, at_rest(tick)


@pytest.fixture(scope="module")
def block():
    return Live(LOSSY, WINDOW, 20)


@pytest.fixture(scope="module")
def organ():
    return Live(Liver().mesh(JELLY, spacing=0.025), 0.009, 60)


def press_at(x, y, window):
    """A press of the library that passes what a site does."""
    return Press(x=x, y=y, radius=sqrt(2) * window, force=1.0, profile=Profile.GAUSSIAN)


@pytest.mark.parametrize(("name", "x", "y"), [("block", 0.0097, 0.0102), ("organ", 0.121, 0.053)])
def test_a_press_between_sites_is_that_of_the_mesh_at_rest_and_in_motion(name, x, y, request):
    live = request.getfixturevalue(name)
    tick, state = live.tick(ONE)
    load = (press_at(x, y, live.grid.window),)
    nodal, slow = live.model.nodal_forces(load[0]), live.model.init()
    sunk, own, found = np.zeros((1, 1)), np.zeros((1, 1)), []
    for _ in range(30):
        assert place_patch(tick, state, 0, x, y)
        go_on(tick, state)
        read_patches(tick, state, sunk)
        push_each_other(tick, state, 0, 0, own)
        hold(tick, state, np.ones((1, 1)))
        slow = live.model.step(slow, load, load, DT)
        found.append((sunk[0, 0] + own[0, 0], nodal @ live.model.field(slow).ravel()))
    ours, theirs = np.array(found).T
    # Both leave out what lies beyond their modes, and not the same.
    assert np.abs(ours - theirs).max() < 0.025 * theirs.max()
    sites, weights = state.sites[0, : state.counts[0]], state.weights[0, : state.counts[0]]
    static = weights @ live.modes.static[np.ix_(sites, sites)] @ weights
    assert static == pytest.approx(nodal @ live.model.field(live.model.static(load)).ravel(), rel=0.02)


def test_two_patches_store_energy_wherever_they_stand(organ):
    tick, state = organ.tick(PATCHES)
    places = np.stack(np.meshgrid(np.arange(3), np.arange(3), indexing="ij"), axis=-1).reshape(-1, 2)
    apart = 4e-4 * np.linalg.norm(places[:, None] - places[None], axis=2)
    field = near_field(half_space(JELLY), pad=1.6e-4, window=organ.grid.window, reach=7 * organ.grid.window)
    near, both = field.at(apart)[..., 0], np.zeros((18, 18))
    rng = np.random.default_rng(3)
    for x, y in rng.uniform([0.05, 0.03], [0.17, 0.08], (10, 2)).tolist():
        place_patch(tick, state, 0, x, y)
        place_patch(tick, state, 1, x + 6e-3, y - 2e-3)
        for one in range(2):
            for other in range(2):
                part = np.zeros((9, 9))
                push_each_other(tick, state, one, other, part)
                both[9 * one : 9 * one + 9, 9 * other : 9 * other + 9] = part + (one == other) * near
        assert both == pytest.approx(both.T, abs=1e-12 * both.max())
        assert between(tick, state, 0, 1) == pytest.approx(both[4, 13], rel=0.5)  # of a site close by
        assert (
            np.linalg.eigvalsh(both)[0] > 0.5 * np.linalg.eigvalsh(near)[0]
        )  # what is added takes none away


def test_a_patch_lies_in_the_tangent_plane_and_its_points_on_the_surface(organ):
    tick, state = organ.tick(PATCHES)
    for x, y in ((0.06, 0.05), (0.12, 0.03), (0.18, 0.06)):
        assert place_patch(tick, state, 0, x, y)
        origin, along, across, normal = state.frames[0]
        turn = np.stack([along, across, normal])
        assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(turn) == pytest.approx(1)
        assert origin[:2] == pytest.approx((x, y))
        a, b = np.meshgrid(tick.offsets[0], tick.offsets[0], indexing="ij")
        points = (
            origin
            + a.ravel()[:, None] * along
            + b.ravel()[:, None] * across
            + state.heights[0][:, None] * normal
        )
        seen = np.array([centre_height(tick, state, *point[:2]) for point in points])
        assert points[:, 2] == pytest.approx(
            seen, abs=1e-8
        )  # three drops from a neighbour's height, some 0.05 mm off
        assert state.on[0].all()


def test_a_place_stands_as_a_patch_there_does(organ):
    tick, state = organ.tick(PATCHES)
    cubic, frame = np.zeros(8), np.zeros((4, 3))
    for x, y in ((0.06, 0.05), (0.12, 0.03)):
        place_patch(tick, state, 1, x, y)
        assert stand(tick, x, y, cubic, frame)
        assert np.array_equal(frame, state.frames[1])
    assert not stand(tick, -1.0, 0.05, cubic, frame)
    assert not stand(tick, 0.001, 0.001, cubic, frame)


def centre_height(tick, state, x, y):
    """Height of the surface where the second patch is put [m]."""
    assert place_patch(tick, state, 1, x, y)
    return state.frames[1, 0, 2]


def each_a_knot(tick):
    """The same tick, its patches looking at the mesh at every point."""
    return tick._replace(knots=tick.offsets, onto=np.zeros((len(tick.offsets), 0, 0)))


def test_knots_answer_nearly_as_every_point_does(organ):
    tick, state = organ.tick(MANY)
    exact, other = each_a_knot(tick), at_rest(tick)
    (own, across), (own_exact, across_exact) = np.zeros((2, 2, 49, 49))
    assert tick.knots.shape == (2, 3)
    for x, y in np.random.default_rng(4).uniform([0.06, 0.035], [0.16, 0.075], (10, 2)).tolist():
        for its, standing, mine, cross in (
            (tick, state, own, across),
            (exact, other, own_exact, across_exact),
        ):
            assert place_patch(its, standing, 0, x, y)
            assert place_patch(its, standing, 1, x + 6e-3, y - 2e-3)
            push_each_other(its, standing, 0, 0, mine)
            push_each_other(its, standing, 1, 0, cross)
        assert state.ranks.tolist() == [9, 9]
        assert other.ranks.tolist() == [49, 49]
        # The cubic's curvature jumps from cell to cell, a parabola's does not.
        assert own == pytest.approx(own_exact, abs=6e-3 * own_exact.max())
        assert across == pytest.approx(across_exact, abs=6e-3 * own_exact.max())
        assert state.heights == pytest.approx(other.heights, abs=2e-5)


@pytest.mark.parametrize("x", [0.121, 0.0], ids=["inside", "rim"])
def test_what_a_patch_reads_and_what_it_presses_do_the_same_work(organ, x):
    tick, state = organ.tick(MANY)
    x = x or rim(tick, state)
    assert place_patch(tick, state, 0, x, 0.053)
    assert place_patch(tick, state, 1, 0.13, 0.053)
    rng, sunk = np.random.default_rng(5), np.zeros((2, 49))
    forces = rng.uniform(0.0, 1.0, (2, 49)) * state.on
    state.amplitudes[:] = rng.standard_normal(len(state.amplitudes))
    read_patches(tick, state, sunk)
    hold(tick, state, forces)
    assert (forces * sunk).sum() == pytest.approx(state.force @ state.amplitudes, rel=1e-10)


def rim(tick, state):
    """A place where a patch stands with some of its points beside the surface [m]."""
    for x in np.arange(0.05, 0.0, -1e-4).tolist():
        if place_patch(tick, state, 0, x, 0.053) and not state.on[0].all():
            return x
    raise AssertionError("the surface has no rim")


def test_at_the_rim_every_point_is_a_knot(organ):
    tick, state = organ.tick(MANY)
    exact, other = each_a_knot(tick), at_rest(tick)
    own, own_exact = np.zeros((2, 49, 49))
    x = rim(tick, state)
    place_patch(tick, state, 0, x, 0.053)
    place_patch(exact, other, 0, x, 0.053)
    push_each_other(tick, state, 0, 0, own)
    push_each_other(exact, other, 0, 0, own_exact)
    assert 0 < state.on[0].sum() < 49
    assert np.array_equal(state.on, other.on)
    assert np.array_equal(own, own_exact)
    assert not own[~state.on[0]].any()


def test_nothing_jumps_where_a_patch_passes_a_site(organ):
    tick, state = organ.tick(ONE)
    x, y = organ.grid.spacing * np.array([27, 11])  # the grid begins at so many spacings before 0
    own, found, step = np.zeros((1, 1)), [], 1e-7
    for away in (-2, -1, 1, 2):
        place_patch(tick, state, 0, x + away * step, y + 1e-3)
        push_each_other(tick, state, 0, 0, own)
        found.append([own[0, 0], *state.frames[0, 0, 2:], *state.frames[0, 3]])
    before, last, first, after = np.array(found)
    slope = (last - before) / step
    assert after - first == pytest.approx(slope * step, abs=1e-4 * np.abs(slope).max() * step)
    assert first - last == pytest.approx(2 * slope * step, abs=1e-4 * np.abs(slope).max() * step)


def test_beside_the_surface_a_patch_presses_nothing(organ):
    tick, state = organ.tick(PATCHES)
    sunk, out = np.zeros((2, 9)), np.ones((9, 9))
    for x, y in ((-1.0, 0.05), (0.001, 0.001), (0.1, float("nan")), (1e300, 0.0)):
        assert not place_patch(tick, state, 0, x, y)
        assert not state.on[0].any()
    hold(tick, state, np.ones((2, 9)))
    go_on(tick, state)
    read_patches(tick, state, sunk)
    push_each_other(tick, state, 0, 0, out)
    assert not state.force.any()
    assert not sunk.any()
    assert not out.any()


def test_all_sites_are_read_as_a_patch_reads_them_and_swing_out(organ):
    tick, state = organ.tick(ONE)
    picture, sunk, own = np.zeros((1, 1, picture_length(tick))), np.zeros((1, 1)), np.zeros((1, 1))
    middle = int(np.argmin(np.linalg.norm(organ.grid.places[:, :2] - [0.12, 0.05], axis=1)))
    x, y = organ.grid.places[middle, :2].tolist()
    for _ in range(30):
        place_patch(tick, state, 0, x + 1e-12, y + 1e-12)  # on a site, to rounding of the division
        go_on(tick, state)
        read_patches(tick, state, sunk)
        push_each_other(tick, state, 0, 0, own)
        hold(tick, state, np.ones((1, 1)))
    write_picture(tick, state, picture)
    assert sunk_sites(tick, picture)[middle] == pytest.approx(sunk[0, 0] + own[0, 0], rel=1e-6)
    let_go(state)
    for _ in range(5000):
        go_on(tick, state)
    write_picture(tick, state, picture)
    assert (
        np.abs(sunk_sites(tick, picture)).max() < 1e-3 * sunk[0, 0]
    )  # the lowest mode, 8 Hz, loses e^(-w^2 tau t/2)


def test_what_is_no_patch_is_refused(organ):
    with pytest.raises(InputError, match="tick: offsets"):
        organ.tick(np.array([0.0, 1e-3]))
    with pytest.raises(InputError, match="dt"):
        make_mesh_tick(organ.modes, organ.grid, 0.0, offsets=ONE)
