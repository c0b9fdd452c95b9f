"""What can be fitted: a number of a layer, or of a sheet, by the name a command gives it.

A parameter is sought in a free coordinate without units: the logarithm, and for Poisson's ratio log(nu/(1/2 - nu)). So
it stays possible, and an error of 0.01 there is one per cent.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from math import exp, log
from typing import Any

from trocar.errors import InputError
from trocar.tissues.key_table import Words
from trocar.tissues.layer import LARGEST_WEIGHT, LONGEST_TIME, SHORTEST_TIME, Layer
from trocar.tissues.tissue import Tissue
from trocar.units import KILOPASCAL, MILLIMETRE
from trocar.waves.stack import Stack

FARTHEST = log(1e3)  # a fit looks for a parameter within a thousandth and a thousand times its start
_TERM = re.compile(r"prony\[(\d)\]\.(g|tau)")
FOUNDATION = "foundation"


@dataclass(frozen=True, kw_only=True)
class Specimen:
    """What is fitted: layers, or sheets that stand for them.

    Attributes:
        tissue: the layers.
        stack: the sheets; None where the layers themselves are meant.
    """

    tissue: Tissue
    stack: Stack | None = None


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One number that is sought.

    Attributes:
        name: such as "fat.young_modulus".
        unit: as people write it.
        factor: from that unit to SI.
        get: reads the value of a specimen [SI].
        put: returns a specimen with another value.
        low, high: what is possible [SI].
        ratio: whether it is a Poisson's ratio.
    """

    name: str
    unit: str
    factor: float
    get: Callable[[Specimen], float]
    put: Callable[[Specimen, float], Specimen]
    low: float
    high: float
    ratio: bool = False

    def free(self, value: float) -> float:
        """Return the free coordinate of a value [SI]."""
        return log(value / (0.5 - value)) if self.ratio else log(value)

    def value(self, free: float) -> float:
        """Return the value [SI] at a free coordinate."""
        return 0.5 / (1 + exp(-free)) if self.ratio else exp(free)

    def bounds(self, start: float) -> tuple[float, float]:
        """Return how far the free coordinate may go from that of a starting value [SI]."""
        at = self.free(start)
        return max(self.free(self.low), at - FARTHEST), min(self.free(self.high), at + FARTHEST)


def of_sheets(name: str) -> bool:
    """Return whether a parameter belongs to a membrane and not to a layer."""
    return name == FOUNDATION or name.endswith(".tension")


def split(name: str) -> tuple[str, str]:
    """Return layer and key of a parameter's name; a layer's own name may hold dots."""
    term = re.search(r"\.(prony\[\d\]\.(?:g|tau))$", name)
    if term is not None:
        return name[: term.start()], term.group(1)
    layer, _, key = name.rpartition(".")
    return layer, key


def parameters(names: Sequence[str], specimen: Specimen) -> tuple[Parameter, ...]:
    """Return parameters by name.

    Args:
        names: such as "fat.young_modulus", "fat.prony[0].tau", "foundation".
        specimen: what they are of.

    Raises:
        InputError: there is none, one is unknown or there twice, two mean the same number, or a starting value leaves
            no logarithm.
    """
    if not names:
        raise InputError("--fit", "at least one parameter, such as fat.young_modulus", Words("none"))
    for name in names:
        if names.count(name) > 1:
            raise InputError("--fit", "every parameter once", name)
        if name.endswith(".prestress") and any(f"{name}_{axis}" in names for axis in "xy"):
            raise InputError("--fit", f"{name} or its parts along x and y, not both", name)
    found = tuple(_parameter(name, specimen) for name in names)
    for item in found:
        value = item.get(specimen)
        if not item.low < value < item.high:
            raise InputError(
                f"--fit {item.name}",
                f"a starting value between {item.low / item.factor:g} and {item.high / item.factor:g} {item.unit}",
                value / item.factor,
                "write one into the case file",
            )
    return found


def _parameter(name: str, specimen: Specimen) -> Parameter:
    if name == FOUNDATION:
        return _foundation(specimen)
    layer, key = split(name)
    if layer not in specimen.tissue.layer_names:
        known = [f"{own}.{key or 'young_modulus'}" for own in specimen.tissue.layer_names]
        close = get_close_matches(name, known, n=1)
        raise InputError(
            "--fit",
            f"LAYER.KEY with a layer of {', '.join(specimen.tissue.layer_names)}",
            name,
            f"did you mean {close[0]}?" if close else "",
        )
    place = specimen.tissue.index(layer)
    term = _TERM.fullmatch(key)
    if term is not None:
        return _term(name, specimen, place, int(term[1]), term[2])
    if key == "tension":
        return _tension(name, specimen, place)
    if key not in _KEYS:
        known = [*_KEYS, "prony[0].g", "prony[0].tau", "tension"]
        close = get_close_matches(key, known, n=1)
        raise InputError(
            "--fit",
            f"a key of {', '.join(known)}",
            name,
            f"did you mean {layer}.{close[0]}?" if close else "",
        )
    fields, unit, factor, low, high = _KEYS[key]

    def put(old: Specimen, value: float) -> Specimen:
        changed: dict[str, Any] = dict.fromkeys(fields, value)
        return _with_layer(old, place, replace(old.tissue.layers[place], **changed))

    return Parameter(
        name=name,
        unit=unit,
        factor=factor,
        get=lambda own: float(getattr(own.tissue.layers[place], fields[0])),
        put=put,
        low=low,
        high=high,
        ratio=key == "poisson_ratio",
    )


_KEYS: dict[str, tuple[tuple[str, ...], str, float, float, float]] = {
    "young_modulus": (("young_modulus",), "kPa", KILOPASCAL, 1.0, 1e12),
    "poisson_ratio": (("poisson_ratio",), "1", 1.0, 0.005, 0.4999),
    "thickness": (("thickness",), "mm", MILLIMETRE, 1e-6, 1.0),
    "prestress": (("prestress_x", "prestress_y"), "kPa", KILOPASCAL, 1e-3, 1e9),
    "prestress_x": (("prestress_x",), "kPa", KILOPASCAL, 1e-3, 1e9),
    "prestress_y": (("prestress_y",), "kPa", KILOPASCAL, 1e-3, 1e9),
}
# Of a layer: fields, unit as people write it, its factor, and the open range of the possible [SI].


def _term(name: str, specimen: Specimen, place: int, term: int, part: str) -> Parameter:
    series = specimen.tissue.layers[place].prony
    if term >= len(series):
        raise InputError(
            f"--fit {name}",
            f"a term of the layer's Prony series, which has {len(series)}",
            Words(f"prony[{term}]"),
            "write prony = [[g, tau_s], ...] with starting values into the case file",
        )
    which = 0 if part == "g" else 1

    def put(old: Specimen, value: float) -> Specimen:
        layer = old.tissue.layers[place]
        pairs = [list(pair) for pair in layer.prony]
        pairs[term][which] = value
        return _with_layer(old, place, replace(layer, prony=tuple((g, tau) for g, tau in pairs)))

    low, high = (1e-6, LARGEST_WEIGHT) if part == "g" else (SHORTEST_TIME, LONGEST_TIME)
    return Parameter(
        name=name,
        unit="1" if part == "g" else "s",
        factor=1.0,
        get=lambda own: own.tissue.layers[place].prony[term][which],
        put=put,
        low=low,
        high=high,
    )


def _with_layer(old: Specimen, place: int, layer: Layer) -> Specimen:
    layers = old.tissue.layers
    return replace(old, tissue=replace(old.tissue, layers=(*layers[:place], layer, *layers[place + 1 :])))


def _sheets(name: str, specimen: Specimen) -> Stack:
    if specimen.stack is None:
        raise InputError(
            f"--fit {name}",
            "--model wave-membrane, whose sheets have a tension and a foundation",
            Words("another model"),
        )
    return specimen.stack


def _tension(name: str, specimen: Specimen, place: int) -> Parameter:
    _sheets(name, specimen)

    def put(old: Specimen, value: float) -> Specimen:
        stack = _sheets(name, old)
        sheet = stack.sheets[place]
        other = replace(sheet, tension_x=value, tension_y=sheet.tension_y * value / sheet.tension_x)
        return replace(
            old, stack=replace(stack, sheets=(*stack.sheets[:place], other, *stack.sheets[place + 1 :]))
        )

    return Parameter(
        name=name,
        unit="N/m",
        factor=1.0,
        get=lambda own: _sheets(name, own).sheets[place].tension_x,
        put=put,
        low=1e-9,
        high=1e9,
    )


def _foundation(specimen: Specimen) -> Parameter:
    _sheets(FOUNDATION, specimen)

    def put(old: Specimen, value: float) -> Specimen:
        stack = _sheets(FOUNDATION, old)
        bed = replace(stack.couplings[-1], stiffness=value)
        return replace(old, stack=replace(stack, couplings=(*stack.couplings[:-1], bed)))

    return Parameter(
        name=FOUNDATION,
        unit="MN/m3",
        factor=1e6,
        get=lambda own: _sheets(FOUNDATION, own).couplings[-1].stiffness,
        put=put,
        low=1e-3,
        high=1e15,
    )
