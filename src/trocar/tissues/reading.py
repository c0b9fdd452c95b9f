"""Reads a tissue file (TOML): the presets shipped here and the ones users write.

```toml
title = "My tissue"
why = "How its values were chosen."
[[layer]]                       # top first
name = "dermis"
[layer.young_modulus]           # likewise thickness, poisson_ratio, density; `LAYER_QUANTITIES` has the rest
value = 129
spread = 88                     # a standard deviation, [low, high], or "none"
unit = "kPa"
status = "read"                 # "read" | "derived" | "chosen" | "remembered"
source = "Diridollou et al. 2000"
method = { setting = "in vivo", technique = "suction", site = "forearm", species = "human" }
[layer.law]                     # may be left out: linear. The keys are a case file's; below, where it comes from
law = "ogden"
ogden = [[1.0, 9.0]]
[layer.memory]                  # may be left out: none. Pairs of g [1] and tau [s]
prony = [[0.4, 0.02], [0.3, 1.5]]
```

Whatever is unknown, missing, of the wrong type or impossible is refused with the file, the key, what was
expected and what came.
"""

from __future__ import annotations

import tomllib
from enum import StrEnum
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, TypeVar

from trocar.errors import InputError
from trocar.tissues.key_quantity import MOST_LAYERS
from trocar.tissues.key_table import Table, finite
from trocar.tissues.law_keys import LAW_KEYS, MEMORY_KEY, read_law, read_prony
from trocar.tissues.quantity import BONDED_KEYS, LAYER_QUANTITIES, PAPER_QUANTITIES, Quantity
from trocar.tissues.record import (
    LayerRecord,
    Method,
    Property,
    Setting,
    Spread,
    Stated,
    StatedLaw,
    StatedMemory,
    Status,
    TissueRecord,
    Usable,
)

EnumType = TypeVar("EnumType", bound=StrEnum)

_EXPLAINED = (Status.CHOSEN, Status.DERIVED)  # these must say why, or how
_ORIGIN = ("source", "method", "status", "reason", "also")
_METHOD = ("setting", "technique", "rate", "site", "species")


def read_tissue(path: Path | Traversable) -> TissueRecord:
    """Read a tissue file.

    Args:
        path: of a TOML file; its stem becomes the tissue's name.

    Raises:
        InputError: the file is not there, not TOML, or says something that is not possible.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(str(path), "a tissue file that can be read", error.strerror) from None
    except UnicodeDecodeError as error:
        raise InputError(str(path), "text in UTF-8", f"byte {error.start}: {error.reason}") from None
    return parse_tissue(text, file=path.name, name=path.name.removesuffix(".toml"))


def parse_tissue(text: str, *, file: str, name: str) -> TissueRecord:
    """Read a tissue from the text of a tissue file.

    Args:
        text: TOML.
        file: how errors call it.
        name: of the tissue.

    Raises:
        InputError: as `read_tissue`.
    """
    try:
        content = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also: an integer too long, brackets too deep
        raise InputError(file, "a TOML file", str(error)) from None
    table = Table(file, "", content)
    table.only(("title", "why", "usable", "instead", "layer"))
    usable = _choice(table, "usable", Usable, default=Usable.ANY)
    read = TissueRecord(
        name=name,
        title=table.prose("title"),
        why=table.prose("why"),
        usable=usable,
        instead=table.prose("instead", required=usable is not Usable.ANY),
        layers=tuple(_layer(entry, usable) for entry in table.tables("layer", MOST_LAYERS)),
    )
    names = [layer.name for layer in read.layers]
    if len(set(names)) != len(names):
        raise table.refuse("layer", "every name once", names)
    if usable is Usable.ANY:
        try:
            read.tissue()
        except InputError as error:  # layers that are each possible and do not go together
            raise table.refuse("layer", f"{error.where}: {error.expected}", error.got, error.advice) from None
    return read


def _layer(table: Table, usable: Usable) -> LayerRecord:
    name = table.prose("name")
    table = Table(table.file, f"layer {name!r}", table.content)
    quantities = LAYER_QUANTITIES if usable is Usable.ANY else PAPER_QUANTITIES
    table.only(("name", *quantities, *(("law", "memory") if usable is Usable.ANY else ())))
    stated = {key for key in quantities if key in table.content}
    for pair in BONDED_KEYS:
        for one, other in (pair, pair[::-1]):
            if one in stated and other not in stated:
                table.table(other, because=f"{one} is stated")
    return LayerRecord(
        name=name,
        properties=tuple(
            _property(key, quantity, table.table(key))
            for key, quantity in quantities.items()
            if quantity.required or key in stated
        ),
        law=_law(table.table("law")) if "law" in table.content else None,
        memory=_memory(table.table("memory")) if "memory" in table.content else None,
    )


def _property(key: str, quantity: Quantity, table: Table) -> Property:
    table.only(("value", "spread", "unit", *_ORIGIN))
    unit = table.choice("unit", tuple(quantity.units))
    value = finite(table.value("value", "a finite number"))
    if value is None:
        raise table.refuse("value", "a finite number", table.content["value"])
    if not quantity.holds(value * quantity.units[unit]):
        advice = f"that is {value * quantity.units[unit]:g} {quantity.si_unit}; is the unit right?"
        raise table.refuse("value", quantity.expected, value, advice)
    return Property(key=key, value=value, spread=_spread(table, value), unit=unit, **_origin(table))


def _law(table: Table) -> StatedLaw:
    table.only((*LAW_KEYS, *_ORIGIN))
    return StatedLaw(law=read_law(table), **_origin(table))


def _memory(table: Table) -> StatedMemory:
    table.only((MEMORY_KEY, *_ORIGIN))
    table.value(MEMORY_KEY, "pairs of g and tau")
    return StatedMemory(prony=read_prony(table), **_origin(table))


def _origin(table: Table) -> dict[str, Any]:
    """Return what every `Stated` has."""
    status = _choice(table, "status", Status)
    origin = Stated(
        source=table.prose("source"),
        method=_method(table.table("method")),
        status=status,
        reason=table.prose("reason", required=status in _EXPLAINED),
        also=_texts(table, "also"),
    )
    return vars(origin)


def _method(table: Table) -> Method:
    table.only(_METHOD)
    return Method(
        setting=_choice(table, "setting", Setting),
        technique=table.prose("technique"),
        rate=table.prose("rate", required=False),
        site=table.prose("site", required=False),
        species=table.prose("species", required=False),
    )


def _choice(table: Table, key: str, kind: type[EnumType], default: EnumType | None = None) -> EnumType:
    return kind(table.choice(key, tuple(item.value for item in kind), default=default))


def _texts(table: Table, key: str) -> tuple[str, ...]:
    value = table.content.get(key, [])
    if not isinstance(value, list) or not all(isinstance(item, str) and item.strip() for item in value):
        raise table.refuse(key, "a list of texts", value)
    return tuple(item.strip() for item in value)


def _spread(table: Table, value: float) -> Spread:
    expected = 'a standard deviation, [low, high] around the value, or "none"'
    spread = table.value("spread", expected)
    if spread == "none":
        return None
    deviation = finite(spread)
    if deviation is not None and deviation > 0:
        return deviation
    if isinstance(spread, list) and len(spread) == 2:
        low, high = map(finite, spread)
        if low is not None and high is not None and low <= value <= high and low < high:
            return low, high
    raise table.refuse("spread", expected, spread)
