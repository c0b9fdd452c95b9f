"""Press the liver of about 20,000 nodes with two instruments that move, in ticks of 1 ms: set-up, nearness, time.

Run: python bench/organ_tick.py [--spacing-mm 12.5] [--modes 60] [--window-mm W] [--places 6] [--ticks 20000]. Prints

  what the sites of the surface cost to set up, in seconds of processor time and MiB;
  what modes that are fast do within a tick, and what would change if they were left to follow at once;
  how far the static answer at places between sites, drawn at random, lies from `WaveMesh.static`'s, and that to a press
  that appears within a tick from `WaveMesh.step`'s, for a Gaussian press as wide as the window, read likewise;
  how far W of a tick, the depth below an even pressure and the heights of patches at random, found at knots, lie from
  those found at every point;
  what a patch's answer, its height and its normal change by in steps of 0.01 mm, at most;
  the time of a tick: two balls of 4 mm, 2 mm deep, on circles at 60 mm/s; both patches are placed, the modes go on and
  are read, W is built with the near field, forces are solved for and held. Beside it a fixed compiled sum, so that
  times of two machines can be compared.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from dataclasses import replace
from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit
from stopwatch import timed

from trocar import tissue
from trocar.contact.normal import press
from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.mesh_patch import between, go_on, hold, place_patch, push_each_other, read_patches
from trocar.waves.mesh.mesh_tick import MeshTick, MeshTickState, at_rest, make_mesh_tick
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.press_grid import PressGrid, press_grid
from trocar.waves.mesh.surface_modes import SurfaceModes, surface_modes
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.near_field import half_space, near_field
from trocar.waves.tick import FAR

DT, MOTION = 1e-3, 60  # [s] a tick; ticks that a press lasts
RADIUS, DEPTH, SPACING, WIDTH = 2e-3, 2e-3, 0.2, 0.4  # of a ball [m]; of its points, in radii; in spacings
CLOSE = np.array([[0.125, 0.05], [0.14, 0.065]])  # [m]
CENTRES, CIRCLE, SPEED = np.array([[0.10, 0.045], [0.15, 0.06]]), 0.012, 0.06  # [m], [m/s]
PRODUCTS = 20_000  # of the fixed sum
HURRIED = (150, 200)  # [Hz]
KNOTTED, TRIED = ([0.05, 0.03], [0.17, 0.08]), 60  # [m] where patches are compared, and how many
TURNS, AGREED = 100, 1e-12  # of patches that push each other in, as in a scene


class Touch(NamedTuple):
    """What a tick of two balls needs beside the mesh's."""

    near: np.ndarray
    own: np.ndarray
    across: np.ndarray
    sunk: np.ndarray
    below: np.ndarray
    rest: np.ndarray
    forces: np.ndarray
    touching: np.ndarray
    holding: np.ndarray
    factor: np.ndarray
    order: np.ndarray
    wrong: np.ndarray


def touch_of(near: np.ndarray) -> Touch:
    """Return the arrays of two balls whose points have a near field."""
    pads, two = near.shape[0], (2, near.shape[0])
    return Touch(
        near=near, own=np.zeros((2, pads, pads)), across=np.zeros((pads, pads)), sunk=np.zeros(two),
        below=np.zeros(two), rest=np.zeros(two), forces=np.zeros(two), touching=np.zeros(two, dtype=np.bool_),
        holding=np.zeros(two, dtype=np.bool_), factor=np.zeros((2, pads, pads)),
        order=np.zeros((2, pads + 1), dtype=np.int64), wrong=np.zeros(pads, dtype=np.bool_),
    )  # fmt: skip


@njit
def ticked(tick: MeshTick, state: MeshTickState, touch: Touch, places: np.ndarray) -> bool:
    """Advance by one tick, two balls at places; return whether forces were found."""
    pads, points = touch.near.shape[0], tick.offsets.shape[1]
    for t in range(2):
        place_patch(tick, state, t, places[t, 0], places[t, 1])
    go_on(tick, state)
    read_patches(tick, state, touch.sunk)
    for t in range(2):
        for i in range(pads):
            p, q = tick.offsets[t, i // points], tick.offsets[t, i % points]
            away = RADIUS * RADIUS - p * p - q * q
            dips = state.on[t, i] and away > 0.0
            below = DEPTH - RADIUS + sqrt(max(away, 0.0)) + state.heights[t, i] - touch.sunk[t, i]
            touch.below[t, i] = below if dips else -1.0
        push_each_other(tick, state, t, t, touch.own[t])
        touch.own[t] += touch.near
    meet = between(tick, state, 0, 1) > FAR * min(touch.own[0, 0, 0], touch.own[1, 0, 0])
    if meet:
        push_each_other(tick, state, 0, 1, touch.across)
    touch.order[:, -1] = 0
    largest, rest = np.abs(touch.below).max(), touch.rest
    rest[:] = touch.below
    well = True
    for turn in range(TURNS):
        change = 0.0
        for t in range(2):
            if meet:
                for i in range(pads):
                    pushed = 0.0
                    for k in range(pads):
                        force = touch.forces[1 - t, k]
                        if force != 0.0:
                            pushed += force * (touch.across[i, k] if t == 0 else touch.across[k, i])
                    now = touch.below[t, i] - pushed
                    change = max(change, abs(now - rest[t, i]))
                    rest[t, i] = now
            well = well and press(
                touch.own[t], rest[t], touch.holding[t], touch.touching[t], touch.forces[t],
                touch.factor[t], touch.order[t], touch.wrong,
            )  # fmt: skip
        if not meet or (turn > 0 and change <= AGREED * largest):
            break
    hold(tick, state, touch.forces)
    return well


@njit
def reference(count: int) -> float:
    """Return a sum of products, one after the other, that takes some fifty microseconds."""
    total = 0.0
    for number in range(count):
        total = 0.5 * total + number
    return total


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--spacing-mm", type=float, default=12.5)
    parser.add_argument("--modes", type=int, default=60)
    parser.add_argument("--window-mm", type=float)
    parser.add_argument("--places", type=int, default=6)
    parser.add_argument("--ticks", type=int, default=20_000)
    parser.add_argument("--cache", help="a folder that modes are kept in; else they are made anew")
    arguments = parser.parse_args()
    window = None if arguments.window_mm is None else 1e-3 * arguments.window_mm
    with tempfile.TemporaryDirectory() as folder:
        cache = BasisCache(arguments.cache or folder)
        mesh = Liver().mesh(tissue("liver").layers[-1], spacing=1e-3 * arguments.spacing_mm)
        model = WaveMesh(mesh, modes=arguments.modes, cache=cache)
        print(f"{model.elements.nodes.shape[1]} nodes, {model.dofs} unknowns, {arguments.modes} modes")
        timed("modes", lambda: model.lowest)
        grid = timed("sites", lambda: press_grid(model.elements, model.layer_names[0], window=window))
        modes = timed("their modes", lambda: surface_modes(model, grid))
        timed("tick", lambda: make_mesh_tick(modes, grid, DT, offsets=np.zeros((1, 1))))
        described(grid, modes)
        hurried(grid, modes)
        places = chosen(model, grid, arguments.places)
        at_rest_as(model, grid, modes, places)
        moving_as(model, grid, modes, places[:2])
    jumps(grid, modes)
    for points in (7, 5):
        knotted(grid, modes, points)
    for points in (7, 5):
        for centres in (CENTRES, CLOSE):
            speed(grid, modes, mesh.materials[0], points, centres, arguments.ticks)


def described(grid: PressGrid, modes: SurfaceModes) -> None:
    """Print sizes."""
    size = modes.rest.nbytes / 2**20
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
    print(
        f"  window {1e3 * grid.window:.2f} mm, {len(grid.places)} sites every {1e3 * grid.spacing:.2f} mm, "
        f"{len(modes.squares)} modes to {sqrt(modes.squares.max()) / (2 * np.pi):.0f} Hz, "
        f"table {size:.0f} MiB, the process at most {peak:.0f} MiB\n"
        f"  left to follow at once: {100 * np.trace(modes.rest) / np.trace(modes.static):.2f} % on the mean, "
        f"{100 * np.diag(modes.rest).max() / np.diag(modes.static).max():.2f} % at most"
    )


def hurried(grid: PressGrid, modes: SurfaceModes) -> None:
    """Print what fast modes do within a tick, and what it would change if they followed at once."""

    def answer(some: SurfaceModes) -> np.ndarray:
        return np.diag(make_mesh_tick(some, grid, DT, offsets=np.zeros((1, 1))).at_once)

    def part(kept: np.ndarray, rest: np.ndarray) -> SurfaceModes:
        return replace(modes, squares=modes.squares[kept], shapes=modes.shapes[:, kept], rest=rest)

    fastest = part(modes.squares == modes.squares.max(), np.zeros_like(modes.rest))
    whole, reached = answer(modes), answer(fastest).sum() / np.trace(fastest.static)
    print(f"  within a tick the fastest mode gets to {reached:.2f} of its static answer")
    for hertz in HURRIED:
        kept = modes.squares < (2 * np.pi * hertz) ** 2
        gone = part(~kept, np.zeros_like(modes.rest)).static
        more = answer(part(kept, modes.rest + gone)) / whole - 1
        print(
            f"  with the {(~kept).sum()} above {hertz} Hz at once W of a site would grow by "
            f"{100 * np.median(more):.1f} %, {100 * more.max():.0f} % at most"
        )


def load_at(grid: PressGrid, place: np.ndarray) -> Press:
    """Return a press of 1 N that passes what a site does."""
    x, y = place.tolist()
    return Press(x=x, y=y, radius=sqrt(2) * grid.window, force=1.0, profile=Profile.GAUSSIAN)


def chosen(model: WaveMesh, grid: PressGrid, count: int) -> np.ndarray:
    """Return places at random whose footprints lie on the surface and that give way."""
    rng, found = np.random.default_rng(0), []
    while len(found) < count:
        place = rng.uniform(0.0, model.size)
        try:
            forces = model.nodal_forces(load_at(grid, place))
        except InputError:
            continue
        if forces.reshape(3, -1)[:, ~model.elements.held.any(axis=0)].sum(axis=1)[2] < -0.9:
            found.append(place)
    return np.array(found)


def site_weights(grid: PressGrid, modes: SurfaceModes, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sites around a place and their weights."""
    tick = make_mesh_tick(modes, grid, DT, offsets=np.zeros((1, 1)))
    state = at_rest(tick)
    assert place_patch(tick, state, 0, *place.tolist())
    count = state.counts[0]
    return state.sites[0, :count], state.weights[0, :count]


def at_rest_as(model: WaveMesh, grid: PressGrid, modes: SurfaceModes, places: np.ndarray) -> None:
    """Compare with the static answer."""
    static, apart = modes.static, []
    for place in places:
        sites, weights = site_weights(grid, modes, place)
        ours = weights @ static[np.ix_(sites, sites)] @ weights
        load = load_at(grid, place)
        theirs = model.nodal_forces(load) @ model.field(model.static((load,))).ravel()
        steep = np.degrees(np.arccos(weights @ grid.normals[sites, 2]))
        apart.append(ours / theirs - 1)
        print(
            f"  at {1e3 * place[0]:5.1f}, {1e3 * place[1]:5.1f} mm, {steep:2.0f} degrees: {1e3 * theirs:.3f} mm/N, "
            f"ours {100 * apart[-1]:+.2f} %",
            flush=True,
        )
    print(f"  static: {100 * np.abs(apart).max():.2f} % at most")


def moving_as(model: WaveMesh, grid: PressGrid, modes: SurfaceModes, places: np.ndarray) -> None:
    """Compare with steps under a press that appears within a tick and stays."""
    for place in places:
        tick = make_mesh_tick(modes, grid, DT, offsets=np.zeros((1, 1)))
        state, slow, load = at_rest(tick), model.init(), (load_at(grid, place),)
        nodal, sunk, own = model.nodal_forces(load[0]), np.zeros((1, 1)), np.zeros((1, 1))
        ours, theirs = [], []
        for _ in range(MOTION):
            place_patch(tick, state, 0, *place.tolist())
            go_on(tick, state)
            read_patches(tick, state, sunk)
            push_each_other(tick, state, 0, 0, own)
            hold(tick, state, np.ones((1, 1)))
            ours.append(sunk[0, 0] + own[0, 0])
            slow = model.step(slow, load, load, DT)
            theirs.append(nodal @ model.field(slow).ravel())
        wrong = np.abs(np.array(ours) - np.array(theirs)) / np.abs(theirs).max()
        print(
            f"  in motion at {1e3 * place[0]:.1f}, {1e3 * place[1]:.1f} mm: {100 * wrong.max():.2f} % of the deepest "
            f"at most, in the first tick {100 * (ours[0] / theirs[0] - 1):+.1f} % of {1e3 * theirs[0]:.3f} mm",
            flush=True,
        )


def jumps(grid: PressGrid, modes: SurfaceModes) -> None:
    """Print what changes in a step of 0.01 mm along a line over eight sites."""
    tick = make_mesh_tick(modes, grid, DT, offsets=np.zeros((1, 1)))
    state, own, found = at_rest(tick), np.zeros((1, 1)), []
    line = CENTRES[0] + 1e-5 * np.arange(int(8e5 * grid.spacing))[:, None] * np.array([0.8, 0.6])
    for x, y in line.tolist():
        assert place_patch(tick, state, 0, x, y)
        push_each_other(tick, state, 0, 0, own)
        sites = state.sites[0, : state.counts[0]]
        weights = state.weights[0, : state.counts[0]]
        shapes = weights @ modes.shapes[sites]
        static = shapes @ (shapes / modes.squares) + weights @ modes.rest[np.ix_(sites, sites)] @ weights
        found.append([own[0, 0], static, state.frames[0, 0, 2], *state.frames[0, 3]])
    values = np.array(found)
    once, twice = np.abs(np.diff(values, axis=0)).max(axis=0), np.abs(np.diff(values, 2, axis=0)).max(axis=0)
    for name, column in (("W of a tick", 0), ("static compliance", 1)):
        mean = values[:, column].mean()
        print(
            f"  {name} changes by {100 * once[column] / mean:.4f} % in 0.01 mm at most, that by "
            f"{100 * twice[column] / mean:.5f} %; over {len(line) / 100:.0f} mm by "
            f"{100 * np.ptp(values[:, column]) / mean:.1f} %"
        )
    print(
        f"  height changes by {1e6 * once[2]:.2f} um, that by {1e6 * twice[2]:.4f} um; "
        f"the normal by {np.degrees(once[3:].max()):.4f} degrees, that by {np.degrees(twice[3:].max()):.5f}"
    )


def patches(points: int) -> tuple[float, np.ndarray]:
    """Return how far apart a ball's points lie [m], and the offsets of those of two balls [m]."""
    spacing = SPACING * RADIUS * 7 / points
    return spacing, np.tile(spacing * (np.arange(points) - (points - 1) / 2), (2, 1))


def knotted(grid: PressGrid, modes: SurfaceModes, points: int) -> None:
    """Compare a patch's knots with looking at the mesh at every point."""
    tick = make_mesh_tick(modes, grid, DT, offsets=patches(points)[1])
    exact = tick._replace(knots=tick.offsets, onto=np.zeros((2, 0, 0)))
    pads, apart = points * points, []
    states, answers = (at_rest(tick), at_rest(exact)), np.zeros((2, pads, pads))
    for x, y in np.random.default_rng(1).uniform(*KNOTTED, (TRIED, 2)).tolist():
        for its, state, answer in zip((tick, exact), states, answers, strict=True):
            assert place_patch(its, state, 0, x, y)
            push_each_other(its, state, 0, 0, answer)
        ours, theirs = answers
        apart.append(
            [
                100 * np.abs(ours - theirs).max() / theirs.max(),
                100 * abs(ours.mean() / theirs.mean() - 1),
                1e6 * np.abs(states[0].heights - states[1].heights).max(),
            ]
        )
    middle, most = np.median(apart, axis=0), np.max(apart, axis=0)
    print(
        f"  {points} x {points} points from {tick.knots.shape[1]} x {tick.knots.shape[1]} knots: an entry of W "
        f"{middle[0]:.2f} % of the largest apart, {most[0]:.2f} % at most; depth below an even pressure "
        f"{middle[1]:.3f} %, {most[1]:.3f} % at most; heights {middle[2]:.1f} um, {most[2]:.1f} um at most"
    )


def speed(
    grid: PressGrid, modes: SurfaceModes, layer: object, points: int, centres: np.ndarray, ticks: int
) -> None:
    """Print how long a tick takes."""
    spacing, offsets = patches(points)
    tick = make_mesh_tick(modes, grid, DT, offsets=offsets)
    at = np.stack(np.meshgrid(offsets[0], offsets[0], indexing="ij"), axis=-1).reshape(-1, 2)
    field = near_field(half_space(layer), pad=WIDTH * spacing, window=grid.window, reach=7 * grid.window)
    near = field.at(np.linalg.norm(at[:, None] - at[None], axis=2))[..., 0]
    state, touch = at_rest(tick), touch_of(np.ascontiguousarray(near))
    turn = SPEED / CIRCLE * DT * np.arange(ticks)
    circle = CIRCLE * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    places = centres + np.stack([circle, circle[:, ::-1]], axis=1)
    apart = 1e3 * np.linalg.norm(places[:, 0] - places[:, 1], axis=1)
    times, still, force = np.empty(ticks), np.empty(ticks), np.empty(ticks)
    ticked(tick, state, touch, places[0])
    reference(PRODUCTS)
    for number in range(ticks):
        began = time.perf_counter()
        well = ticked(tick, state, touch, places[number])
        ended = time.perf_counter()
        reference(PRODUCTS)
        times[number], still[number] = ended - began, time.perf_counter() - ended
        force[number] = touch.forces[0].sum()
        assert well
    (median, high), (quiet, loud) = (1e6 * np.percentile(each, (50, 99)) for each in (times, still))
    print(
        f"  {points} x {points} points, {apart.min():.0f} to {apart.max():.0f} mm apart: "
        f"median {median:.1f} us, 99 % below {high:.1f} us "
        f"(a fixed sum: {quiet:.1f} and {loud:.1f} us); {state.counts[0]} sites to a patch, "
        f"force {1e3 * force[1000:].mean():.2f} mN +- {1e3 * force[1000:].std():.2f}, "
        f"from tick to tick {1e3 * np.abs(np.diff(force[1000:])).max():.4f} mN at most",
        flush=True,
    )


if __name__ == "__main__":
    main()
