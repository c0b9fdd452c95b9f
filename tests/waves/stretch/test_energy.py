"""What a stretched sheet stores."""

import numpy as np
import pytest

from trocar.tissues import Layer, Tissue
from trocar.waves.series import Series
from trocar.waves.stretch.energy import StretchEnergy
from trocar.waves.stretch.moduli import MembraneModuli

SIZE = (0.05, 0.08)
THICKNESS, MODULUS, RATIO = 1e-3, 5e5, 0.3
ALONG = MODULUS * THICKNESS / (1 - RATIO**2)
SHEET = MembraneModuli(
    along_x=ALONG, along_y=ALONG, across=RATIO * ALONG, shear=MODULUS * THICKNESS / (2 * (1 + RATIO))
)
UNEVEN = MembraneModuli(along_x=700.0, along_y=300.0, across=120.0, shear=150.0)
BED = Tissue(
    layers=(Layer(name="bed", thickness=0.01, young_modulus=2e4, poisson_ratio=0.48, density=1000.0),)
)


def shapes(seed, modes=(5, 6), count=2):
    return 1e-3 * np.random.default_rng(seed).standard_normal((count, *modes))


def test_one_wave_stores_what_the_plate_of_von_karman_does():
    """Stress function of one mode: E h W^2/32 ((a/b)^2 cos(2 pi x/a) + (b/a)^2 cos(2 pi y/b)), and the mean tension.

    The sides move neither in nor out. Timoshenko and Woinowsky-Krieger 1959, section 102; integrated by hand.
    """
    a, b = SIZE
    height = 2e-3
    w = np.zeros((3, 3))
    w[0, 0] = height
    sheet = StretchEnergy(Series(SIZE, (3, 3)), SHEET)
    x, y = (np.pi * height) ** 2 / (8 * a**2), (np.pi * height) ** 2 / (8 * b**2)
    mean = 0.5 * a * b * ALONG * (x**2 + y**2 + 2 * RATIO * x * y)
    uneven = MODULUS * THICKNESS * np.pi**4 * height**4 * a * b / 256 * (1 / a**4 + 1 / b**4)
    shape = sheet.at(w)
    assert sheet.energy(shape) == pytest.approx(mean + uneven, rel=1e-12)
    assert sheet.mean_tension(shape) == pytest.approx(
        (ALONG * (x + RATIO * y), ALONG * (y + RATIO * x)), rel=1e-12
    )


@pytest.mark.parametrize("moduli", [SHEET, UNEVEN])
@pytest.mark.parametrize("bed", [None, BED])
def test_the_resistance_is_the_slope_of_the_energy(moduli, bed):
    sheet = StretchEnergy(Series(SIZE, (5, 6)), moduli, bed)
    w, direction = shapes(1)
    ahead, behind = (sheet.energy(sheet.at(w + share * direction)) for share in (1e-4, -1e-4))
    slope = float(np.sum(sheet.gradient(sheet.at(w)) * direction))
    assert (ahead - behind) / 2e-4 == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("bed", [None, BED])
def test_the_discrete_gradient_gives_the_change_of_energy_exactly(bed):
    sheet = StretchEnergy(Series(SIZE, (5, 6)), UNEVEN, bed)
    start, end = (sheet.at(w) for w in shapes(2))
    change = sheet.energy(end) - sheet.energy(start)
    first, last = shapes(2)
    assert float(np.sum(sheet.between(start, end) * (last - first))) == pytest.approx(
        change, abs=1e-14 * (sheet.energy(start) + sheet.energy(end))
    )


def test_between_a_shape_and_itself_it_is_the_gradient():
    sheet = StretchEnergy(Series(SIZE, (5, 6)), UNEVEN)
    shape = sheet.at(shapes(3)[0])
    assert sheet.between(shape, shape) == pytest.approx(sheet.gradient(shape), rel=1e-12)


def test_a_bed_lets_the_sheet_give_way_less_the_stiffer_it_is():
    w = shapes(4)[0]
    stored = []
    for stiffness in (2e2, 2e4, 2e6, 2e12):
        bed = Tissue(
            layers=(
                Layer(name="bed", thickness=0.01, young_modulus=stiffness, poisson_ratio=0.48, density=1e3),
            )
        )
        sheet = StretchEnergy(Series(SIZE, (5, 6)), SHEET, bed)
        stored.append(sheet.energy(sheet.at(w)))
    free = StretchEnergy(Series(SIZE, (5, 6)), SHEET)
    assert free.energy(free.at(w)) < stored[0] < stored[1] < stored[2] < stored[3]
    # Glued down it cannot give way at all: then V is the integral of the local stretch's own energy.
    x, y = ((np.arange(200) + 0.5) / 200 * side for side in SIZE)
    kx, ky = (np.arange(1, count + 1) * np.pi / side for count, side in zip(w.shape, SIZE, strict=True))
    slope_x = np.cos(np.outer(x, kx)) * kx @ w @ np.sin(np.outer(y, ky)).T
    slope_y = np.sin(np.outer(x, kx)) @ w @ (np.cos(np.outer(y, ky)) * ky).T
    along_x, along_y, shear = slope_x**2 / 2, slope_y**2 / 2, slope_x * slope_y
    local = ALONG * (along_x**2 + along_y**2 + 2 * RATIO * along_x * along_y) + SHEET.shear * shear**2
    assert stored[3] == pytest.approx(0.5 * local.mean() * SIZE[0] * SIZE[1], rel=1e-6)


def test_x_and_y_are_alike():
    w = shapes(5)[0]
    one = StretchEnergy(Series(SIZE, (5, 6)), UNEVEN, BED)
    turned = MembraneModuli(
        along_x=UNEVEN.along_y, along_y=UNEVEN.along_x, across=UNEVEN.across, shear=UNEVEN.shear
    )
    other = StretchEnergy(Series(SIZE[::-1], (6, 5)), turned, BED)
    assert other.energy(other.at(w.T)) == pytest.approx(one.energy(one.at(w)), rel=1e-12)
