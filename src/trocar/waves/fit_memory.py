"""How fitted sheets come to remember: Prony weights under which they relax as the layers do.

The solid's answer to a load in the Laplace domain is that of an elastic one with each layer's stiffness times
1 + sum of g s tau/(1 + s tau) (the correspondence principle: Christensen 1982, Theory of Viscoelasticity, ch. 2),
and so is the sheets'. At s = 1/tau of every relaxation time and without bound, every face's deflection under every
tool, as a share of the long-term one, is matched by nonlinear least squares in the weights of sheets and beds. None is
negative, so the sheets remain passive. Relaxation times are the layers' own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from trocar.model import FloatArray
from trocar.tissues.tissue import Tissue
from trocar.waves.stack import Stack, sheet_compliance, weight_of
from trocar.waves.thin_layer import ThinLayers, Wavenumbers

_LARGER = 4.0  # times the largest weight of any layer at that time, which no sheet and no bed exceeds
_SILENT = 1e-4  # of that: a smaller weight is none
_CHUNK = 512  # wavenumbers at a time


def stiffening(times: FloatArray) -> FloatArray:
    """Return s tau/(1 + s tau) of each relaxation time at each place fitted, the last one without bound; (D + 1, D)."""
    return np.vstack([times / (times[:, None] + times), np.ones(len(times))])


def relaxing_solid(layers: ThinLayers, at: Wavenumbers) -> FloatArray:
    """Return every face's amplitude per unit amplitude of pressure on top at each place, (D + 1, J, faces) [m/Pa]."""
    faces = [layers.unknown(layer, 0) for layer in range(len(layers.faces))]
    places = stiffening(layers.relaxation)
    found = np.empty((len(places), len(at.k), len(faces)))
    for start in range(0, len(at.k), _CHUNK):
        part = slice(start, start + _CHUNK)
        here = Wavenumbers(at.k[part], at.kx2[part], at.ky2[part])
        stiffness, branches = layers.stiffness(here), layers.remembered(here)
        top = np.zeros((len(here.k), layers.size, 1))
        top[:, layers.unknown(0, 0)] = 1.0
        for place, weights in enumerate(places):
            matrix = stiffness + np.tensordot(weights, branches, 1)
            found[place, part] = np.linalg.solve(matrix, top)[:, faces, 0]
    return found


def fit_memory(
    tissue: Tissue, stack: Stack, at: Wavenumbers, wanted: FloatArray, profile: FloatArray
) -> Stack:
    """Give a stack the series under which it relaxes as wanted.

    Args:
        tissue: the layers, some of which remember.
        stack: fitted to the long-term response.
        at: J wavenumbers.
        wanted: each face's deflection over its long-term one at each place (see `stiffening`) and row of the profile
            [1], shape (D + 1, rows, faces).
        profile: what each wavenumber adds under each tool, shape (rows, J).
    """
    series = {layer.prony for layer in tissue.layers}
    prestressed = any(layer.prestress_x or layer.prestress_y for layer in tissue.layers)
    if len(series) == 1 and not prestressed:  # every stiffness relaxes alike, whatever it is
        (prony,) = series
        return _with_series(stack, [prony] * (2 * len(stack.sheets)))
    times = np.array(tissue.relaxation_times)
    places, layers = stiffening(times), len(stack.sheets)
    respond = _response(stack, at, profile)
    longterm = respond(np.ones(2 * layers))
    own = np.array([[layer.relaxing(time) for time in times] for layer in tissue.layers])
    highest = np.tile(_LARGER * own.max(axis=0), 2 * layers)

    def misfit(weights: FloatArray) -> FloatArray:
        factors = 1 + places @ weights.reshape(2 * layers, len(times)).T
        found = np.array([respond(factor) for factor in factors]) / longterm
        residual: FloatArray = (found / wanted - 1).ravel()
        return residual

    start = np.clip(np.vstack([own, own]).ravel(), 0.02 * highest, 0.98 * highest)
    found = least_squares(misfit, start, bounds=(0.0, highest), x_scale=highest, max_nfev=100)
    weights = np.where(found.x > _SILENT * highest, found.x, 0.0).reshape(2 * layers, len(times))
    series_of = [zip(row.tolist(), times.tolist(), strict=True) for row in weights]
    return _with_series(stack, [tuple((g, time) for g, time in terms if g > 0) for terms in series_of])


def relaxed_share(stack: Stack, times: FloatArray, at: Wavenumbers, profile: FloatArray) -> FloatArray:
    """Return each sheet's deflection [m] at each place and row of the profile, shape (D + 1, rows, faces)."""
    series = [sheet.prony for sheet in stack.sheets] + [bed.prony for bed in stack.couplings]
    weights = np.array([[weight_of(prony, time) for time in times] for prony in series])
    respond = _response(stack, at, profile)
    return np.array([respond(factor) for factor in 1 + stiffening(times) @ weights.T])


def _response(stack: Stack, at: Wavenumbers, profile: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return what gives deflections, (rows, faces), from the factors by which sheets and beds are stiffer, (2 n,)."""
    tension = np.array([sheet.tension_x for sheet in stack.sheets])
    bending = np.array([sheet.bending for sheet in stack.sheets])
    bed = np.array([coupling.stiffness for coupling in stack.couplings])
    layers = len(tension)

    def respond(factors: FloatArray) -> FloatArray:
        own = factors[:layers]
        result: FloatArray = profile @ sheet_compliance(
            own * tension, own * bending, factors[layers:] * bed, at.k
        )
        return result

    return respond


def _with_series(stack: Stack, series: list[tuple[tuple[float, float], ...]]) -> Stack:
    layers = len(stack.sheets)
    sheets = zip(stack.sheets, series[:layers], strict=True)
    beds = zip(stack.couplings, series[layers:], strict=True)
    return Stack(
        sheets=tuple(replace(sheet, prony=prony) for sheet, prony in sheets),
        couplings=tuple(replace(bed, prony=prony) for bed, prony in beds),
    )
