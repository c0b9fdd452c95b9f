"""Modal forces against quadrature over the footprint in its own polar coordinates."""

from math import cos, sin

import numpy as np
import pytest

from trocar.model import Press, Profile
from trocar.waves.footprint import modal_forces, transform
from trocar.waves.series import Series

SERIES = Series((0.06, 0.05), (40, 40))


def quadrature(press):
    """Integrate the unit traction against the three shape families, rings by Gauss, angles evenly."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    reach = 4.0 if press.profile is Profile.GAUSSIAN else 1.0  # eight standard deviations
    r, w = 0.5 * reach * (nodes + 1), 0.5 * reach * weights
    if press.profile is Profile.SPHERE:  # r = sin(t) removes the root at the rim
        t, w = np.pi / 4 * (nodes + 1), np.pi / 4 * weights
        r, w = np.sin(t), w * np.cos(t)
    pressure = {
        Profile.FLAT: np.ones_like(r),
        Profile.SPHERE: np.sqrt(np.clip(1 - r**2, 0, None)),
        Profile.GAUSSIAN: np.exp(-2 * r**2),
    }[press.profile]
    w = w * r * pressure
    w /= w.sum()
    angle = np.linspace(0, 2 * np.pi, 128, endpoint=False)
    along, across = press.semi_axes
    p = along * np.outer(r, np.cos(angle))
    q = across * np.outer(r, np.sin(angle))
    x = (press.x + p * cos(press.azimuth) - q * sin(press.azimuth)).ravel()
    y = (press.y + p * sin(press.azimuth) + q * cos(press.azimuth)).ravel()
    weight = np.repeat(w / len(angle), len(angle))
    sin_x, cos_x = np.sin(np.outer(SERIES.kx, x)), np.cos(np.outer(SERIES.kx, x))
    sin_y, cos_y = np.sin(np.outer(y, SERIES.ky)), np.cos(np.outer(y, SERIES.ky))
    shapes = [(cos_x * weight) @ sin_y, (sin_x * weight) @ cos_y, (sin_x * weight) @ sin_y]
    return np.stack(shapes) * np.array(press.force_vector)[:, None, None]


@pytest.mark.parametrize("profile", list(Profile))
@pytest.mark.parametrize(("tilt", "azimuth"), [(0.0, 0.0), (0.6, 0.0), (0.6, 1.1), (0.9, -2.5)])
def test_closed_forms_match_quadrature(profile, tilt, azimuth):
    press = Press(x=0.022, y=0.031, radius=0.003, force=1.7, profile=profile, tilt=tilt, azimuth=azimuth)
    # 60 rings and 128 angles resolve 40 modes over 3 to 5 mm to rounding; Hertz's rim costs some.
    assert modal_forces(press, SERIES) == pytest.approx(quadrature(press), abs=1e-9)


def test_a_tilted_force_has_three_components():
    press = Press(x=0.03, y=0.025, radius=0.003, force=2.0, tilt=0.5, azimuth=0.3)
    x, y, z = press.force_vector
    assert np.hypot(np.hypot(x, y), z) == pytest.approx(2.0)
    assert z == pytest.approx(-2.0 * cos(0.5))
    assert y / x == pytest.approx(np.tan(0.3))


@pytest.mark.parametrize("profile", list(Profile))
def test_the_transform_is_one_at_zero_and_smooth_where_its_series_takes_over(profile):
    rho = np.array([0.0, 0.01 - 1e-9, 0.01 + 1e-9])
    values = transform(profile, rho)
    assert values[0] == 1.0
    assert values[1] == pytest.approx(values[2], abs=1e-10)
