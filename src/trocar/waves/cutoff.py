"""How many modes a tool needs: its footprint passes no short waves.

Of what a footprint of radius R puts into a wavenumber k, the share A(k R) is left (`footprint`). At short
wavelengths every elastic block answers as a half-space, whose compliance falls as 1/k (Johnson 1985, Contact
Mechanics, section 3.2); membranes fall faster. Under the tool's centre the waves beyond a cut-off K then add
the share

    integral of A from K R on / integral of A from 0 on

of the deflection. It is erfc(K R/sqrt 8) for a Gaussian. For the others it oscillates below an envelope,
which follows from A at large arguments: sqrt(2/pi) (K R)^(-3/2) for the flat disc, 4/(pi (K R)^2) for the
Hertz sphere.

The rule needs no model and asks for more than a membrane needs; where the compliance of every mode is known,
`measured_cutoff` adds up what the modes do.
"""

from __future__ import annotations

from math import ceil, isfinite, pi

import numpy as np
from scipy.special import erfcinv

from trocar.errors import InputError
from trocar.model import FloatArray, Profile
from trocar.waves.footprint import transform


def cutoff_for(radius: float, profile: Profile, tolerance: float) -> float:
    """Return the wavenumber [1/m] beyond which waves add less than `tolerance` to a tool's deflection.

    Args:
        radius: of the footprint [m].
        profile: how the traction is spread.
        tolerance: relative error allowed [1], above 0 and below 1.

    Raises:
        InputError: the radius or the tolerance is not possible.
    """
    if not (isfinite(radius) and radius > 0):
        raise InputError("cut-off: radius", "a finite number above 0 [m]", radius)
    if not 0 < tolerance < 1:
        raise InputError("cut-off: tolerance", "a number above 0 and below 1", tolerance)
    match profile:
        case Profile.GAUSSIAN:
            reach = 8**0.5 * float(erfcinv(tolerance))
        case Profile.FLAT:
            reach = (2 / pi) ** (1 / 3) * tolerance ** (-2 / 3)
        case _:  # the Hertz sphere
            reach = (4 / (pi * tolerance)) ** 0.5
    return reach / radius


def modes_for(
    radius: float, profile: Profile, size: tuple[float, float], tolerance: float
) -> tuple[int, int]:
    """Return the highest m and n of the series that a tool needs: those of the cut-off along each side.

    Args:
        radius: of the footprint [m].
        profile: how the traction is spread.
        size: sides a, b of the block [m].
        tolerance: relative error allowed in the deflection under the tool's centre [1].

    Raises:
        InputError: an argument is not possible.
    """
    if not all(isfinite(side) and side > 0 for side in size):
        raise InputError("cut-off: size", "two finite sides above 0 [m]", size)
    cutoff = cutoff_for(radius, profile, tolerance)
    return ceil(cutoff * size[0] / pi), ceil(cutoff * size[1] / pi)


def measured_cutoff(
    compliance: FloatArray, size: tuple[float, float], radius: float, profile: Profile, tolerance: float
) -> float:
    """Return the smallest wavenumber [1/m] beyond which a model's own waves add less than `tolerance`.

    The sum is that of the static deflection under the tool's centre, averaged over its places on the block,
    in the layer that needs most; a slow press needs the same modes, a fast one hears less of the short waves'
    inertia.

    Args:
        compliance: of every mode and layer [m/Pa], shape (M, N, layers); see
            `WaveMembrane.static_compliance`.
        size: sides a, b of the block [m].
        radius: of the footprint [m].
        profile: how the traction is spread.
        tolerance: relative error allowed [1].

    Raises:
        InputError: the radius or the tolerance is not possible, or the model has too few modes to tell.
    """
    rule = cutoff_for(radius, profile, tolerance)
    rows, columns, layers = compliance.shape
    kx = pi / size[0] * np.arange(1, rows + 1)
    ky = pi / size[1] * np.arange(1, columns + 1)
    if min(kx[-1], ky[-1]) < rule:
        raise InputError(
            "cut-off: modes", f"waves up to {rule:.4g} [1/m] along both sides", min(kx[-1], ky[-1])
        )
    k = np.hypot(kx[:, None], ky[None, :]).ravel()
    order = np.argsort(k)[::-1]
    share = np.abs(compliance.reshape(-1, layers) * transform(profile, radius * k)[:, None])[order]
    beyond = np.cumsum(share, axis=0) / share.sum(axis=0)
    last = int(np.searchsorted(beyond.max(axis=1), tolerance))
    return float(k[order][last])
