"""From names to a trainer: tissue, model, ports and device, put together."""

from __future__ import annotations

from collections.abc import Callable

from trocar.contact.port_sets import instruments_through
from trocar.devices.device import Device
from trocar.errors import InputError
from trocar.model import Press, Support
from trocar.simulation import at_rest, make_scene
from trocar.simulation.live import LIVE_MODELS, LIVE_SIZE, live_model
from trocar.study.linear_range import linear_range
from trocar.tissues.catalogue import tissue as preset
from trocar.waves.solid import WaveSolid
from trocar.web.trainer import Trainer


def prepare(
    tissue: str,
    *,
    ports: str = "usual",
    model: str = LIVE_MODELS[0],
    device: Device | None = None,
    size: tuple[float, float] = LIVE_SIZE,
    watch: Callable[[str], None] = lambda text: None,
) -> Trainer:
    """Put a trainer together; nothing runs yet.

    Args:
        tissue: name of a preset.
        ports: name of a port set, or a file (`contact.port_sets`).
        model: one of `LIVE_MODELS`.
        device: what moves the instruments; the page's hands if not given.
        size: sides of the block [m].
        watch: told what is being done.

    Raises:
        InputError: something named is not there or does not go together.
    """
    if model not in LIVE_MODELS:
        raise InputError("model", " or ".join(LIVE_MODELS), model)
    layers = preset(tissue)
    instruments = instruments_through(ports, size)
    watch(
        "fitting the tissue's membranes to its layers"
        if model == LIVE_MODELS[0]
        else "laying the tissue's waves out"
    )
    waves = live_model(layers, model, size=size)
    watch("laying the scene out")
    scene = make_scene(waves, layers, instruments)
    watch("finding the end of the linear range")
    # Its thresholds were found under flat tools, so it is that of a flat tool as wide as the shaft.
    press = Press(x=size[0] / 2, y=size[1] / 2, radius=instruments[0].shaft_radius, force=1e-2)
    limit = linear_range(WaveSolid(layers, size=size, support=Support.BASE), layers, (press,)).force_limit
    return Trainer(
        tissue=layers,
        size=size,
        scene=scene,
        at_rest=at_rest(scene),
        instruments=instruments,
        linear_force=limit,
        device=device,
    )
