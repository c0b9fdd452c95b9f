"""A taut sheet on a lattice, against what is known of membranes, films and slits: none of it from here."""

from dataclasses import replace
from math import cos, pi, sqrt

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.waves.sheet.cut import cut_along
from trocar.waves.sheet.lattice import go_on, lag, make_lattice, move, moving, pull, stored, taut
from trocar.waves.sheet.sheet import Sheet

DT = 1e-3
FREE = Sheet(along=0.0, across=0.0, drag=0.0)


def grid(lattice):
    """Return x and y of the nodes at rest, shape (ny nx,)."""
    n = lattice.columns
    at = np.arange(len(lattice.free))
    return at % n * lattice.spacing, at // n * lattice.spacing


@pytest.mark.parametrize(("m", "n"), [(1, 1), (2, 1), (2, 3)])
def test_the_whole_sheet_swings_as_a_membrane(m, n):
    """f = 1/2 sqrt(T/rho) sqrt(m^2/a^2 + n^2/b^2), and four times as near with half the spacing."""
    a, b = size = (0.06, 0.045)
    errors = []
    for cells in (20, 40):
        sheet = replace(FREE, size=size, cells=cells)
        frequency = 0.5 * sheet.wave_speed * sqrt((m / a) ** 2 + (n / b) ** 2)
        lattice = make_lattice(sheet, 1e-4)
        state = taut(lattice)
        x, y = grid(lattice)
        shape = np.sin(m * pi * x / a) * np.sin(n * pi * y / b) * lattice.free
        state.places[2] = 1e-3 * shape
        swings = []
        ticks = round(2.25 / frequency / 1e-4)
        for _ in range(ticks):
            go_on(lattice, state)
            swings.append(float(shape @ state.places[2]))
        # It is the lattice's own mode, so what swings is one cosine: c(t + 1) + c(t - 1) = 2 cos(w) c(t).
        swings = np.array(swings)
        twice = (swings[2:] + swings[:-2]) @ swings[1:-1] / (swings[1:-1] @ swings[1:-1])
        found = np.arccos(twice / 2) / (2 * pi * 1e-4)
        errors.append(abs(found / frequency - 1))
    assert errors[1] < 0.01
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


def test_it_is_an_isotropic_film_with_a_ratio_of_a_third():
    """Energy of even strains, against E h/(2 (1 - nu^2)) (exx^2 + eyy^2 + 2 nu exx eyy + 2 (1 - nu) exy^2)."""
    sheet = replace(FREE, stretch=1e-9)  # what tension adds is not the film's
    lattice = make_lattice(sheet, DT)
    x, y = grid(lattice)
    nu = 1 / 3
    for exx, eyy, exy in ((1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (0.6, -0.2, 0.5)):
        state = taut(lattice)
        state.places[0] = 1e-2 * (exx * x + exy * y)
        state.places[1] = 1e-2 * (exy * x + eyy * y)
        known = exx**2 + eyy**2 + 2 * nu * exx * eyy + 2 * (1 - nu) * exy**2
        known *= 0.5e-4 * sheet.stiffness / (1 - nu**2) * sheet.size[0] * sheet.size[1]
        # Links along the rim are whole ones where half belongs to the sheet: one row in forty.
        assert stored(lattice, state) == pytest.approx(known, rel=0.03)


def test_stretching_it_into_its_frame_took_the_energy_of_a_film():
    sheet = FREE
    lattice = make_lattice(sheet, DT)
    known = sheet.tension * sheet.stretch * sheet.size[0] * sheet.size[1]  # half of both directions'
    assert stored(lattice, taut(lattice)) == pytest.approx(known, rel=0.03)


def test_a_whole_sheet_at_rest_stays_so():
    lattice = make_lattice(Sheet(), DT)
    state = taut(lattice)
    for _ in range(20):
        go_on(lattice, state)
    assert np.abs(state.places).max() < 1e-15


def opened(links, cells, stretch):
    """Return a slit's half length, places from its middle, how far it stands open there [m], and 4 sigma/E."""
    sheet = Sheet(size=(0.12, 0.12), cells=cells, stretch=stretch, along=2e-4, drag=300.0)
    lattice = make_lattice(sheet, DT)
    state = taut(lattice)
    h, n, row = lattice.spacing, lattice.columns, cells // 2
    half, y = links * h / 2, (row + 0.5) * h
    cut_along(lattice, state, 0.06 - half, y, 0.06 + half, y)
    for _ in range(100):
        go_on(lattice, state)
    assert np.abs(state.speeds).max() < 1e-7
    moved = state.places[1].reshape(-1, n)
    return half, grid(lattice)[0][:n] - 0.06, moved[row + 1] - moved[row], 4 * sheet.tension / sheet.stiffness


@pytest.mark.parametrize(("links", "cells"), [(7, 80), (11, 120)])
def test_a_slit_opens_as_griffith_says(links, cells):
    """4 sigma a/E in the middle, an ellipse along it (Griffith 1921; Westergaard 1939, plane stress).

    The frame is ten slits wide and holds it back by some percent, and the links at its ends let it go by as much.
    """
    half, x, gap, known = opened(links, cells, stretch=5e-3)
    assert gap.max() == pytest.approx(known * half, rel=0.05)
    inside = np.abs(x) < 0.5 * half
    ellipse = known * np.sqrt(half**2 - x[inside] ** 2)
    assert gap[inside] == pytest.approx(ellipse, rel=0.06)
    assert np.abs(gap[np.abs(x) > half + 1.5e-3]).max() < 0.1 * gap.max()


def test_tension_itself_holds_a_slit_back():
    """Its flanks turn, and a link that turns pulls back with its tension: with a twentieth of stretch by a tenth."""
    half, _, gap, known = opened(7, 80, stretch=0.05)
    loose = opened(7, 80, stretch=5e-3)[2].max() / (known / 10 * half)
    assert 0.85 < gap.max() / (known * half) / loose < 0.95


def test_no_cut_gives_energy():
    """What moves and is stored stays the same between cuts, to rounding, and falls with each."""
    lattice = make_lattice(FREE, DT)
    state = taut(lattice)
    x, y = grid(lattice)
    state.places[2] = 1e-3 * np.sin(pi * x / 0.06) * np.sin(2 * pi * y / 0.06) * lattice.free
    rng = np.random.default_rng(5)
    energies = []
    for step in range(400):
        cuts = step % 20 == 10
        if cuts:
            x0, y0, angle = rng.uniform(0.01, 0.05), rng.uniform(0.01, 0.05), rng.uniform(0, 2 * pi)
            dx, dy = 6e-3 * np.array([cos(angle), np.sin(angle)])
            cut_along(lattice, state, x0, y0, x0 + dx, y0 + dy)
        before = state.speeds.copy()
        lag(lattice, state)
        pull(lattice, state)
        # The scheme's own energy: velocities of both half steps, places between them (Hairer, Lubich and Wanner
        # 2006, Geometric Numerical Integration).
        energy = 0.5 * lattice.mass * float((before * state.speeds).sum()) + stored(lattice, state)
        if energies:
            assert energy < energies[-1] * (1 + 1e-12)
            if cuts:
                assert energy < energies[-1] * (1 - 1e-4)
            else:
                assert energy == pytest.approx(energies[-1], rel=1e-11)
        energies.append(energy)
        move(lattice, state)


def test_a_cut_sheet_comes_to_rest_open():
    lattice = make_lattice(Sheet(), DT)
    state = taut(lattice)
    whole = stored(lattice, state)
    cut_along(lattice, state, 0.02, 0.0292, 0.04, 0.0292)
    for _ in range(1500):
        go_on(lattice, state)
    assert moving(lattice, state) < 1e-9 * whole
    assert stored(lattice, state) < whole
    assert np.abs(state.places[1]).max() > 1e-3


def test_what_cannot_be_is_refused():
    for given in (
        {"thickness": 0.0},
        {"stretch": 0.5},
        {"cells": 2},
        {"drag": -1.0},
        {"size": (0.06, 0.0501)},
    ):
        with pytest.raises(InputError, match=next(iter(given)) if "size" not in given else "cells"):
            Sheet(**given)
    with pytest.raises(InputError, match="small steps"):
        make_lattice(Sheet(young_modulus=1e12), DT)
