"""Membranes fitted to layers: which coefficients make coupled sheets answer a tool as the solid does.

Three linear-response moments of the solid at the top face are matched:

    static      the deflection of every face under tools of several radii, in the middle and in a corner of the
                block, and on a line from the middle outwards; tensions, bending stiffnesses and couplings come from
                nonlinear least squares in their logarithms
    damping     p^T K^-1 C K^-1 p, the first moment in time; linear in the retardation times of sheets and beds
    inertia     p^T K^-1 M K^-1 p, the second; linear in the areal densities
    memory      where layers have a Prony series: see `fit_memory`

The last two are bounded least squares, weighted by what each wavenumber adds to the deflection under the tool: no
density is negative, and retardation times keep to a few times those of the layers. Without the upper
bound a bed that hardly stretches can be given any time, up to one at which the equations of motion lose their sign;
without the lower one a bed that bears the block may be given none, and the block rings for seconds.
A fit holds for the block it was made for: its size, its support, and tools from 5 to 12 mm across.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from math import ceil, pi
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares, lsq_linear, nnls

from trocar.model import FloatArray, Profile, Support
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.clamped import SIDE_MODES, ClampedSides
from trocar.waves.fit_memory import fit_memory, relaxed_share, relaxing_solid
from trocar.waves.footprint import transform
from trocar.waves.series import Series
from trocar.waves.stack import Coupling, Stack, derived_stack, sheet_compliance
from trocar.waves.thin_layer import ThinLayers, Wavenumbers, horizontal_shear, vertical_and_along

RADII = (2.5e-3, 3e-3, 4e-3, 6e-3)  # [m] tools of 5, 6, 8 and 12 mm
_REACH = 8.25  # highest wavenumber times the smallest radius: a flat tool's peak within 0.1 %
_MOST_MODES = 95  # a side, whatever the tool
_SHARES = (0.5, 0.25)  # of both sides, where the tools stand: in the middle and in a corner
_STATIONS = (0.5, 1.0, 1.5, 2.5)  # where the profile beside a central tool is matched, in tool radii
_LOG_RANGE = 14.0  # coefficients stay within e^14 of their derived values
_LOG_STIFFER = (
    3.0  # a bed stays below e^3 of its derived stiffness, which is already that of no give sideways
)
_SLOWER = 3.0  # times the slowest layer's retardation time at most, and the fastest's over this at least


@dataclass(frozen=True)
class Fit:
    """What a fit found.

    Attributes:
        stack: the coefficients.
        error: largest relative difference from the solid, of any face's deflection under a tool of any of the radii,
            in the middle of the block or in a corner, also while layers relax [1]. Some tissues no stack of sheets can
            imitate: look at it.
    """

    stack: Stack
    error: float


class _Row(NamedTuple):
    """A place of the profile: beside a tool of some radius [m], by `station` radii along x."""

    radius: float
    share: float  # of both sides, where the tool stands
    station: float


@dataclass(frozen=True)
class _Target:
    """What the solid does, and how a compliance per wavenumber turns into deflections along the profile."""

    at: Wavenumbers
    compliance: FloatArray  # faces under a unit pressure amplitude [m/Pa], (J, faces)
    damping: FloatArray  # first moment at the top face, (J,)
    inertia: FloatArray  # second moment at the top face, (J,)
    profile: FloatArray  # under the tools, and beside the central ones, (rows, J)
    tools: int  # how many of the rows are under the tools: radii times shares
    deflection: FloatArray  # what the solid does along the profile, its clamps included, (rows, faces)

    @property
    def under(self) -> FloatArray:
        return self.profile[: self.tools]


def fitted_stack(
    tissue: Tissue, *, size: tuple[float, float], support: Support, radii: tuple[float, ...] = RADII
) -> Fit:
    """Fit a stack of sheets, one per layer, to `WaveSolid`'s response.

    Args:
        tissue: the layers. Where a layer's prestress differs between x and y, the mean enters the fit and the
            difference is added to its sheet's tensions afterwards.
        size: sides a, b [m].
        support: which block the coefficients are for.
        radii: of the tools the fit is made under [m].
    """
    even = Tissue(layers=tuple(_evenly_prestressed(layer) for layer in tissue.layers), name=tissue.name)
    target = _target(even, size, support, radii)
    stack = _fit_static(even, target, support)
    stack = _fit_rates(even, stack, target)
    error = _error(stack, target)
    if tissue.relaxation_times:
        stack, missed = _fit_memory(even, stack, target, support)
        error = max(error, missed)
    sheets = []
    for sheet, layer in zip(stack.sheets, tissue.layers, strict=True):
        half = 0.5 * (layer.prestress_x - layer.prestress_y) * layer.thickness
        sheets.append(replace(sheet, tension_x=sheet.tension_x + half, tension_y=sheet.tension_y - half))
    return Fit(stack=replace(stack, sheets=tuple(sheets)), error=error)


def _error(stack: Stack, target: _Target) -> float:
    reached = target.under @ _response(_coefficients(stack), len(stack.sheets), target.at)
    return float(np.abs(reached / target.deflection[: target.tools] - 1).max())


def _fit_memory(tissue: Tissue, stack: Stack, target: _Target, support: Support) -> tuple[Stack, float]:
    """Return the stack with series, and how far it then misses the solid's deflection while both relax."""
    layers = vertical_and_along(tissue, base_held=support.base_held)
    longterm = target.under @ target.compliance
    wanted = np.array([target.under @ place for place in relaxing_solid(layers, target.at)]) / longterm
    stack = fit_memory(tissue, stack, target.at, wanted, target.under)
    reached = relaxed_share(stack, layers.relaxation, target.at, target.under)
    missed = reached / (wanted * target.deflection[: target.tools]) - 1
    return stack, float(np.abs(missed).max())


def _evenly_prestressed(layer: Layer) -> Layer:
    mean = 0.5 * (layer.prestress_x + layer.prestress_y)
    return replace(layer, prestress_x=mean, prestress_y=mean)


def _target(tissue: Tissue, size: tuple[float, float], support: Support, radii: tuple[float, ...]) -> _Target:
    a, b = size
    series = Series(size, _highest_modes(size, radii))
    kx, ky = (grid.ravel() for grid in np.meshgrid(series.kx[1:], series.ky[1:], indexing="ij"))
    k_all = np.hypot(kx, ky)
    _, first, places = np.unique(np.round(k_all * a, 9), return_index=True, return_inverse=True)
    at = Wavenumbers(k_all[first], kx[first] ** 2, ky[first] ** 2)

    layers = vertical_and_along(tissue, base_held=support.base_held)
    compliance, damping, inertia = _moments(layers, at)

    def weights(row: _Row) -> FloatArray:
        """Return what each wavenumber adds at a station beside a tool."""
        x, y = row.share * a, row.share * b
        shape = np.sin(kx * x) * np.sin(ky * y) * np.sin(kx * (x + row.radius * row.station)) * np.sin(ky * y)
        weight = 4 / (a * b) * transform(Profile.FLAT, k_all * row.radius) * shape
        return np.asarray(np.bincount(places, weight, minlength=len(first)), dtype=np.float64)

    under = [_Row(radius, share, 0.0) for radius in radii for share in _SHARES]
    rows = under + [_Row(radius, 0.5, station) for radius in radii for station in _STATIONS]
    profile = np.array([weights(row) for row in rows])
    deflection = profile @ compliance
    if support.sides_clamped:
        deflection += _clamped(layers, horizontal_shear(tissue, base_held=support.base_held), size, rows)
    return _Target(at, compliance, damping, inertia, profile, len(under), deflection)


def _clamped(
    layers_wv: ThinLayers, layers_s: ThinLayers, size: tuple[float, float], rows: list[_Row]
) -> FloatArray:
    """Return what clamped sides add to the deflection along the profile, shape (rows, faces)."""
    series = Series(size, SIDE_MODES)
    sides = ClampedSides(layers_wv, layers_s, series)
    a, b = size
    kx, ky = series.kx[:, None], series.ky[None, :]
    none = np.zeros(series.shape)

    @cache
    def waves(radius: float, share: float) -> FloatArray:
        shape = np.sin(kx * share * a) * np.sin(ky * share * b)
        found: FloatArray = sides.under_load(
            4 / (a * b) * transform(Profile.FLAT, np.hypot(kx, ky) * radius) * shape, none, none
        )[0]
        return found

    def read(row: _Row) -> FloatArray:
        x, y = row.share * a + row.radius * row.station, row.share * b
        sines = np.sin(series.kx * x), np.sin(series.ky * y)
        faces: FloatArray = np.einsum("m,n,mnf->f", *sines, waves(row.radius, row.share))
        return faces

    return np.array([read(row) for row in rows])


def _highest_modes(size: tuple[float, float], radii: tuple[float, ...]) -> tuple[int, int]:
    m, n = (min(ceil(_REACH * side / min(radii) / pi), _MOST_MODES) for side in size)
    return m, n


def _moments(layers: ThinLayers, at: Wavenumbers) -> tuple[FloatArray, FloatArray, FloatArray]:
    top = np.zeros((len(at.k), layers.size, 1))
    top[:, layers.unknown(0, 0)] = 1.0
    response = np.linalg.solve(layers.stiffness(at), top)[..., 0]
    faces = [layers.unknown(layer, 0) for layer in range(len(layers.faces))]
    damping = np.einsum("ja,jab,jb->j", response, layers.damping(at), response)
    inertia = np.einsum("ja,ab,jb->j", response, layers.mass, response)
    return np.asarray(response[:, faces], dtype=np.float64), np.asarray(damping), np.asarray(inertia)


def _fit_static(tissue: Tissue, target: _Target, support: Support) -> Stack:
    start = derived_stack(tissue, support)
    layers = len(start.sheets)
    first = _coefficients(start)
    # A prestress is a tension whatever else a layer does; the fit adds to it.
    prestress = np.zeros(len(first))
    prestress[:layers] = [layer.prestress_x * layer.thickness for layer in tissue.layers]
    first -= prestress
    free = np.ones(len(first), dtype=bool)
    free[-1] = support.base_held
    peaks = np.abs(target.deflection).max(axis=0)

    def coefficients(logarithms: FloatArray) -> FloatArray:
        values = first.copy()
        values[free] *= np.exp(logarithms)
        return values + prestress

    def misfit(logarithms: FloatArray) -> FloatArray:
        response = _response(coefficients(logarithms), layers, target.at)
        residual: FloatArray = ((target.profile @ response - target.deflection) / peaks).ravel()
        return residual

    highest = np.full(len(first), _LOG_RANGE)
    highest[2 * layers :] = _LOG_STIFFER
    bounds = (np.full(int(free.sum()), -_LOG_RANGE), highest[free])
    found = least_squares(misfit, np.zeros(len(bounds[0])), bounds=bounds, x_scale=1.0, max_nfev=200)
    values = coefficients(found.x)
    sheets = tuple(
        replace(sheet, tension_x=float(t), tension_y=float(t), bending=float(d))
        for sheet, t, d in zip(start.sheets, values[:layers], values[layers : 2 * layers], strict=True)
    )
    return Stack(sheets=sheets, couplings=tuple(Coupling(stiffness=float(c)) for c in values[2 * layers :]))


def _coefficients(stack: Stack) -> FloatArray:
    """Return tensions along x, bending stiffnesses and couplings, one after the other."""
    return np.array(
        [sheet.tension_x for sheet in stack.sheets]
        + [sheet.bending for sheet in stack.sheets]
        + [coupling.stiffness for coupling in stack.couplings]
    )


def _response(values: FloatArray, layers: int, at: Wavenumbers) -> FloatArray:
    """Return each sheet's amplitude per unit pressure amplitude on the top one, shape (J, layers)."""
    return sheet_compliance(values[:layers], values[layers : 2 * layers], values[2 * layers :], at.k)


def _fit_rates(tissue: Tissue, stack: Stack, target: _Target) -> Stack:
    layers = len(stack.sheets)
    values = _coefficients(stack)
    response = _response(values, layers, target.at)
    k2 = target.at.k[:, None] ** 2
    own = (values[layers : 2 * layers] * k2**2 + values[:layers] * k2) * response**2
    gaps = response - np.concatenate([response[:, 1:], np.zeros((len(response), 1))], axis=1)
    beds = values[2 * layers :] * gaps**2
    weight = np.abs(target.under).sum(axis=0)
    densities, _ = nnls(weight[:, None] * response**2, weight * target.inertia)
    times = _retardation_times(tissue, weight[:, None] * np.hstack([own, beds]), weight * target.damping)
    least = 1e-3 * densities.max()  # a sheet must weigh something to move
    sheets = tuple(
        replace(sheet, areal_density=float(max(m, least)), retardation_time=float(t))
        for sheet, m, t in zip(stack.sheets, densities, times[:layers], strict=True)
    )
    couplings = tuple(
        replace(coupling, retardation_time=float(t))
        for coupling, t in zip(stack.couplings, times[layers:], strict=True)
    )
    return Stack(sheets=sheets, couplings=couplings)


def _retardation_times(tissue: Tissue, columns: FloatArray, wanted: FloatArray) -> FloatArray:
    times = [layer.retardation_time for layer in tissue.layers]
    slowest, fastest = max(times), min(times)
    if slowest == 0:
        return np.zeros(columns.shape[1])
    bounds = (fastest / slowest / _SLOWER, _SLOWER)
    found = lsq_linear(columns * slowest, wanted, bounds=bounds, method="bvls", tol=1e-12)
    fitted: FloatArray = np.clip(found.x, *bounds) * slowest  # the solver may leave a bound by a rounding
    return fitted
