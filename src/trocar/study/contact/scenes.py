"""Scenes that contact is examined in: a membrane fitted to layers, two instruments, undamped on request."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trocar.contact.instrument import Instrument, TipKind, default_instruments
from trocar.model import Support
from trocar.simulation import DT, Scene, make_scene
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.membrane import WaveMembrane

SIZE = (0.06, 0.06)  # [m]
MODES = (48, 48)  # enough for the window
BLOCK = Tissue(  # uniform, for instruments at full force
    layers=(
        Layer(
            name="block",
            thickness=0.012,
            young_modulus=1e6,
            poisson_ratio=0.48,
            density=1000.0,
            loss_factor=0.2,
            loss_frequency=50.0,
        ),
    )
)
_LENGTH, _RADIUS, _ABOVE = 0.31, 2.5e-3, 0.1  # [m] of a shaft, and of its port above the block


@dataclass(frozen=True, kw_only=True)
class Setting:
    """A scene and what it is made of.

    Attributes:
        tissue: the layers.
        model: the membrane fitted to them.
        instruments: left, right.
        scene: of both.
    """

    tissue: Tissue
    model: WaveMembrane
    instruments: tuple[Instrument, Instrument]
    scene: Scene

    def with_instruments(self, instruments: tuple[Instrument, Instrument], *, dt: float = DT) -> Setting:
        """Return the same tissue under other instruments, or in ticks of another length [s]."""
        scene = make_scene(self.model, self.tissue, instruments, dt=dt)
        return replace(self, instruments=instruments, scene=scene)


def setting(
    tissue: Tissue, *, instruments: tuple[Instrument, Instrument] | None = None, undamped: bool = False
) -> Setting:
    """Return a setting on a block of 60 x 60 mm.

    Args:
        tissue: the layers.
        instruments: left, right; the trainer's usual pair by default.
        undamped: whether its layers lose nothing.
    """
    if undamped:
        tissue = Tissue(layers=tuple(replace(layer, loss_factor=0.0) for layer in tissue.layers))
    model = WaveMembrane.fitted(tissue, size=SIZE, modes=MODES, support=Support.BASE)
    pair = instruments or default_instruments(SIZE, tissue.thickness)
    return Setting(tissue=tissue, model=model, instruments=pair, scene=make_scene(model, tissue, pair))


def upright(
    tips: tuple[TipKind, TipKind] = (TipKind.GRASPER, TipKind.PROBE),
    places: tuple[tuple[float, float], tuple[float, float]] = ((0.012, 0.03), (0.03, 0.03)),
) -> tuple[Instrument, Instrument]:
    """Return two instruments whose ports are right above places on the block [m]."""
    left, right = (
        Instrument(
            name=name,
            port=(x, y, _ABOVE),
            length=_LENGTH,
            shaft_radius=_RADIUS,
            tip=tip,
            handle=(x, y, 3 * _ABOVE),
        )
        for name, tip, (x, y) in zip(("left", "right"), tips, places, strict=True)
    )
    return left, right
