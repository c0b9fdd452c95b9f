"""A patch of small pads on a wave model, standing still: how each sinks under all, no wave left out.

A pad presses with a Gaussian of width p (one standard deviation) and feels the deflection at its centre. Waves that
the model's series holds, through the window exp(-(s k)^2/2) that ends where the series does, are summed and know the
block's sides; shorter ones are the near field, a function of distance alone (`near_field`). So the answer does not
depend on how long the series is, and a pad may be far narrower than its shortest wave.
"""

from __future__ import annotations

from functools import cached_property, partial
from typing import Protocol

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.near_field import NearField, near_field
from trocar.waves.series import Series

_ENDS = 4.5  # highest wavenumber of the series times the window's width: 4e-5 is left there
_REACH = 7.0  # of the near field, in widths of the window: 1e-9 of a Gaussian is beyond


class Pressable(Protocol):
    """A wave model as its pads see it."""

    @property
    def series(self) -> Series:
        """The waves that are summed."""
        ...

    @property
    def least_window(self) -> float:
        """Width of the narrowest window whose waves are the model's own [m]; `compliance` answers for shorter ones."""
        ...

    @property
    def wave_compliance(self) -> FloatArray:
        """Every face's static amplitude per unit amplitude of pressure [m/Pa], shape (faces, M + 1, N + 1)."""
        ...

    def held_back(self, across: FloatArray) -> FloatArray | None:
        """Return what clamped sides add under a pressure's waves [Pa]: (faces, M' + 1, N' + 1) [m], or None."""
        ...

    def mutually_held_back(self, pressures: FloatArray) -> FloatArray:
        """Return what clamped sides add to how pressures of 1 N sink under each other, (n, M + 1, N + 1) to (n, n)."""
        ...

    def compliance(self, k: FloatArray, *, finest: float) -> FloatArray:
        """Return every face's static amplitude per unit amplitude of pressure [m/Pa], (J,) to (J, faces)."""
        ...


class Pads:
    """Pads at fixed places on a model.

    Args:
        model: the tissue.
        places: centres on the top face [m], shape (n, 2).
        width: of a pad's Gaussian, one standard deviation [m].

    Raises:
        InputError: the pads are too wide: the model's own presses serve such.
    """

    def __init__(self, model: Pressable, places: FloatArray, width: float) -> None:
        self._model, self._places = model, places
        series = model.series
        self._window = max(_ENDS / min(series.kx[-1], series.ky[-1]), model.least_window)
        if not 0 < width < self._window:
            raise InputError(
                "pads: width", f"above 0 and below the series' resolution, {self._window:g} m", width
            )
        self._near: NearField = near_field(
            partial(model.compliance, finest=width),
            pad=width,
            window=self._window,
            reach=_REACH * self._window,
            first=min(series.kx[1], series.ky[1]),
        )
        self._sin_x = np.sin(np.outer(places[:, 0], series.kx))
        self._sin_y = np.sin(np.outer(places[:, 1], series.ky))
        k2 = series.kx[:, None] ** 2 + series.ky[None, :] ** 2
        a, b = series.size
        self._passed = 4 / (a * b) * np.exp(-0.5 * self._window**2 * k2)

    @cached_property
    def compliance(self) -> FloatArray:
        """How deep each pad's centre sinks per newton on another [m/N], shape (n, n)."""
        apart = np.linalg.norm(self._places[:, None] - self._places[None], axis=2)
        total = self._near.at(apart)[:, :, 0]
        shapes = (self._sin_x[:, :, None] * self._sin_y[:, None, :]).reshape(len(total), -1)
        total += (shapes * (self._model.wave_compliance[0] * self._passed).ravel()) @ shapes.T
        pressures = shapes.reshape(len(total), *self._passed.shape) * self._passed
        total += self._model.mutually_held_back(pressures)
        return np.asarray(0.5 * (total + total.T), dtype=np.float64)

    def deflection(self, forces: FloatArray, points: FloatArray) -> FloatArray:
        """Return how far every face is pushed in at points [m], shape (m, >= 2), under forces [N]; (faces, m)."""
        across = self._passed * ((self._sin_x * forces[:, None]).T @ self._sin_y)
        waves = self._model.wave_compliance * across
        held = self._model.held_back(across)
        if held is not None:
            waves[:, : held.shape[1], : held.shape[2]] += held
        series = self._model.series
        summed = np.stack([series.vertical(face, points) for face in waves])
        for place, force in zip(self._places, forces.tolist(), strict=True):
            if force:
                summed += force * self._near.at(np.linalg.norm(points[:, :2] - place, axis=1)).T
        return summed
