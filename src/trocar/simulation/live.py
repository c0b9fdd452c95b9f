"""The tissue of a live scene, by name of its model, as trainer, tasks and benches have it."""

from __future__ import annotations

from trocar.errors import InputError
from trocar.model import Support
from trocar.simulation.live_fits import FITS
from trocar.tissues.catalogue import tissue
from trocar.tissues.tissue import Tissue
from trocar.waves.fit import Fit, fitted_stack
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

LIVE_MODELS = ("wave-membrane", "wave-solid")
LIVE_SIZE = (0.06, 0.06)  # [m] of the block
_MODES = (52, 52)  # as many as a scene's window passes


def live_model(
    layers: Tissue, model: str = LIVE_MODELS[0], *, size: tuple[float, float] = LIVE_SIZE
) -> WaveMembrane | WaveSolid:
    """Return a model that a scene can be made of, its base held.

    Args:
        layers: of the tissue.
        model: one of `LIVE_MODELS`.
        size: sides of the block [m].

    Raises:
        InputError: there is no such model.
    """
    if model == LIVE_MODELS[0]:
        fit = _kept(layers, size) or fitted_stack(layers, size=size, support=Support.BASE)
        return WaveMembrane(
            fit.stack,
            size=size,
            modes=_MODES,
            support=Support.BASE,
            fit_error=fit.error,
            tissue=layers,
        )
    if model == LIVE_MODELS[1]:
        return WaveSolid(layers, size=size, support=Support.BASE, modes=_MODES, dynamic_modes=_MODES)
    raise InputError("model", " or ".join(LIVE_MODELS), model)


def _kept(layers: Tissue, size: tuple[float, float]) -> Fit | None:
    """Return the coefficients that are kept for a tissue, if it is the preset they were fitted to."""
    fit = FITS.get(layers.name)
    return fit if fit is not None and size == LIVE_SIZE and layers == tissue(layers.name) else None
