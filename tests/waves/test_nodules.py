"""Nodules as springs: how a ball eases itself, what it feels, and what it takes from a dent."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.special import j1

from trocar.errors import InputError
from trocar.model import Support
from trocar.tissues import Layer, Tissue
from trocar.tissues.nodule import Nodule
from trocar.waves.buried import strains
from trocar.waves.easing import ball_points, ball_polynomials, ease_in_ball
from trocar.waves.image import image_in_layers
from trocar.waves.nodules import springs_under
from trocar.waves.solid import WaveSolid
from trocar.waves.springs import NO_SPRINGS
from trocar.waves.tick import make_tick

FAT = Layer(name="fat", thickness=0.02, young_modulus=1e4, poisson_ratio=0.48, density=950)
BLOCK = Tissue(name="fat", layers=(FAT,))
SIDE, TOOL, WINDOW, DT = 0.04, 4e-3, 2e-3, 1e-3
STIFF = Nodule(x=0.02, y=0.02, depth=8e-3, radius=5e-3, young_modulus=1e5)


@pytest.fixture(scope="module")
def waves():
    return WaveSolid(BLOCK, size=(SIDE, SIDE), support=Support.BASE, modes=(40, 40), dynamic_modes=(40, 40))


@pytest.fixture(scope="module")
def tick(waves):
    return make_tick(waves, DT, window=WINDOW, offsets=np.zeros((1, 1)))


def taken(springs, waves):
    """Return what springs take from how far 1 N over a disc in the middle sinks, in the mean over it [m]."""
    k = [pi / SIDE * (each + 1.0) for each in (springs.row, springs.column)]
    number = springs.row * waves.surface_modes[1] + springs.column
    yielding = waves.surface_oscillators.yielding[number, 0, 0]
    rim = np.hypot(*k) * TOOL
    spread = np.exp(-0.25 * WINDOW**2 * (k[0] ** 2 + k[1] ** 2)) * 2 * j1(rim) / rim
    felt = springs.feel.T @ (spread * yielding * np.sin(k[0] * SIDE / 2) * np.sin(k[1] * SIDE / 2))
    own = np.eye(springs.feel.shape[1]) + springs.feel.T @ (yielding[:, None] * springs.feel)
    return float(felt @ np.linalg.solve(own, felt))


# What axially symmetric finite elements of 0.25 mm say (bench/nodule.py), of 8.47 mm without the nodule [m].
@pytest.mark.parametrize(
    ("nodule", "truth"),
    [
        (STIFF, 2.67e-3),
        (replace(STIFF, depth=10e-3), 1.65e-3),
        (replace(STIFF, radius=3e-3), 0.696e-3),
    ],
)
def test_a_nodule_takes_from_a_dent_what_finite_elements_say(waves, tick, nodule, truth):
    found = taken(springs_under((nodule,), waves, BLOCK, tick, window=WINDOW), waves)
    assert found == pytest.approx(truth, rel=0.05)  # a bound from below, its stress a polynomial of degree 2
    assert found < truth


def test_a_nodule_that_is_hardly_stiffer_takes_what_the_strain_without_it_says(waves, tick):
    """To first order: V times the energy that the difference of moduli would store under the load's own strain."""
    weak = replace(STIFF, young_modulus=1.001e4)
    kx, ky = (pi / SIDE * (np.arange(1, 41)[index] + 0.0) for index in np.indices((40, 40)).reshape(2, -1))
    points, shares = ball_points(8, 6, 12)
    places = np.array([weak.x, weak.y, -weak.depth]) + weak.radius * points
    rim = np.hypot(kx, ky) * TOOL
    load = np.sin(kx * SIDE / 2) * np.sin(ky * SIDE / 2) * 2 * j1(rim) / rim
    strain = np.einsum("j,jqa->qa", load, strains(BLOCK, places, (SIDE, SIDE), kx, ky))
    volume = strain[:, :3].sum(axis=1)
    shape = (strain**2).sum(axis=1) - volume**2 / 3
    stored = 3e-3 * FAT.bulk_modulus / 3 * volume**2 + 2e-3 * FAT.shear_modulus * shape
    ball = 4 / 3 * pi * weak.radius**3
    found = taken(springs_under((weak,), waves, BLOCK, tick, window=WINDOW), waves)
    # Tolerance: strain beyond degree 2, 1.4 % of the energy, and springs of 1 % that are left out
    assert found == pytest.approx(ball * float(shares @ stored), rel=0.03)


def test_a_ball_strained_evenly_eases_itself_as_hill_says():
    bulk, shear = FAT.bulk_modulus, FAT.shear_modulus
    own = ease_in_ball(FAT, 0)[0, :, 0]
    volume, shape = 1 / (3 * bulk + 4 * shear), 3 * (bulk + 2 * shear) / (5 * shear * (3 * bulk + 4 * shear))
    mean = np.zeros((6, 6))
    mean[:3, :3] = 1 / 3
    assert own == pytest.approx(volume * mean + shape * (np.eye(6) - mean), rel=1e-9, abs=1e-12 / shear)


def test_polynomials_of_a_ball_are_upright_on_each_other():
    points, shares = ball_points(8, 6, 12)
    table = ball_polynomials(points, 2)
    assert table.shape[1] == 10
    assert (table * shares[:, None]).T @ table == pytest.approx(np.eye(10), abs=1e-12)


def test_easing_is_positive_and_even_stress_does_not_bend():
    own = ease_in_ball(FAT, 2)
    flat = own.reshape(60, 60)
    assert flat == pytest.approx(flat.T, abs=1e-12 * np.abs(flat).max())
    assert np.linalg.eigvalsh(flat)[0] >= -1e-12 * np.abs(flat).max()
    assert np.abs(own[0][:, 1:]).max() == 0.0


def test_a_surface_that_is_free_eases_and_one_far_away_does_nothing():
    deep = Tissue(layers=(replace(FAT, thickness=0.06),))
    shallow, buried = (replace(STIFF, radius=3e-3, depth=depth) for depth in (6e-3, 30e-3))
    near, far = (image_in_layers(deep, nodule, deep.layers[0], 0)[0, :, 0] for nodule in (shallow, buried))
    assert np.linalg.eigvalsh(near)[0] > 0
    assert np.abs(far).max() < 0.02 * np.abs(near).max()  # as the cube of the distance: 0.8 %


@pytest.mark.parametrize(
    ("nodules", "words"),
    [
        ((replace(STIFF, x=0.003),), "nodule: x"),
        ((replace(STIFF, depth=16e-3),), "wholly in one of the layers"),
        ((replace(STIFF, young_modulus=9e3),), "stiffer than fat"),
        ((STIFF,) * 5, "at most 4"),
        ((STIFF, replace(STIFF, x=0.026)), "10 mm apart at least"),
    ],
)
def test_nodules_that_cannot_be_are_refused(waves, tick, nodules, words):
    with pytest.raises(InputError, match=words):
        springs_under(nodules, waves, BLOCK, tick, window=WINDOW)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"depth": float("nan")}, "depth"),
        ({"radius": 9e-3}, "less than its depth"),
        ({"poisson_ratio": 0.5}, "poisson"),
    ],
)
def test_impossible_numbers_of_a_nodule_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        replace(STIFF, **changes)


def test_none_is_no_spring(waves, tick):
    assert springs_under((), waves, BLOCK, tick, window=WINDOW) is NO_SPRINGS
