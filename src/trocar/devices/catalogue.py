"""The devices by name, each with what makes one.

To add a device, write a class that has what `Device` asks for, and put a line here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from inspect import signature
from types import MappingProxyType
from typing import Any

from trocar.devices.device import Device
from trocar.devices.recorded import RecordedDevice
from trocar.devices.simulated import SimulatedDevice
from trocar.devices.web import WebDevice
from trocar.errors import InputError


@dataclass(frozen=True, kw_only=True, slots=True)
class Entry:
    """A device before it is made.

    Args:
        make: makes one from options by keyword.
        name: as `Device` says.
        description: as `Device` says.
        steered_by_page: as `Device` says.
        every_tick: as `Device` says.
        missing: what keeps it from being used on this machine, in a sentence; empty where nothing does.
    """

    make: Callable[..., Device]
    name: str
    description: str
    steered_by_page: bool
    every_tick: bool
    missing: str = ""

    def as_dict(self) -> dict[str, object]:
        """Return what can be said of it in JSON."""
        return {
            "name": self.name,
            "description": self.description,
            "steered_by": "the page" if self.steered_by_page else "the device",
            "every_tick": self.every_tick,
            "available": not self.missing,
            "missing": self.missing,
        }


_CLASSES: tuple[type[SimulatedDevice | RecordedDevice | WebDevice], ...] = (
    SimulatedDevice,
    RecordedDevice,
    WebDevice,
)

DEVICES: Mapping[str, Entry] = MappingProxyType(
    {
        kind.name: Entry(
            make=kind,
            name=kind.name,
            description=kind.description,
            steered_by_page=kind.steered_by_page,
            every_tick=kind.every_tick,
        )
        for kind in _CLASSES
    }
)
"""Every device by its name."""


def entry(name: str) -> Entry:
    """Return what is known of a device before it is made.

    Raises:
        InputError: there is none of that name; the message offers the closest one.
    """
    if name not in DEVICES:
        close = get_close_matches(name, DEVICES, n=1)
        advice = f"did you mean {close[0]}?" if close else ""
        raise InputError("device", f"one of {', '.join(DEVICES)}", name, advice)
    return DEVICES[name]


def device(name: str, **options: Any) -> Device:
    """Return a new device, not open yet.

    Args:
        name: one of `DEVICES`.
        options: what its class takes, by keyword.

    Raises:
        InputError: there is no such device, it does not take such options, or a value is not possible.
    """
    make = entry(name).make
    taken = signature(make).parameters
    for option, value in options.items():
        if option not in taken:
            raise InputError(f"{name} device: {option}", "no such option", value, "leave it out")
    for option, parameter in taken.items():
        if parameter.default is parameter.empty and option not in options:
            raise InputError(f"{name} device", f"the option --{option}", None)
    return make(**options)
