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
```

Whatever is unknown, missing, of the wrong type or impossible is refused with the file, the key, what was
expected and what came.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from enum import StrEnum
from importlib.resources.abc import Traversable
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

from trocar.errors import InputError
from trocar.tissues.quantity import BONDED_KEYS, LAYER_QUANTITIES, PAPER_QUANTITIES, Quantity
from trocar.tissues.record import LayerRecord, Method, Property, Setting, Spread, Status, TissueRecord, Usable

EnumType = TypeVar("EnumType", bound=StrEnum)

_EXPLAINED = (Status.CHOSEN, Status.DERIVED)  # these must say why, or how


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
    table = _Table(content, file, "")
    title, why = table.text("title"), table.text("why")
    usable = table.choice("usable", Usable, default=Usable.ANY)
    instead = table.text("instead", required=usable is not Usable.ANY)
    quantities = LAYER_QUANTITIES if usable is Usable.ANY else PAPER_QUANTITIES
    layers = tuple(_layer(entry, quantities) for entry in table.tables("layer"))
    table.finish()
    names = [layer.name for layer in layers]
    if len(set(names)) != len(names):
        raise InputError(f"{file}: layer", "every name once", names)
    return TissueRecord(name=name, title=title, why=why, usable=usable, instead=instead, layers=layers)


def _layer(table: _Table, quantities: Mapping[str, Quantity]) -> LayerRecord:
    name = table.text("name")
    table.call_it(name)
    properties = []
    for key, quantity in quantities.items():
        entry = table.table(key, required=quantity.required)
        if entry is not None:
            properties.append(_property(key, quantity, entry))
    table.finish()
    stated = {item.key for item in properties}
    for pair in BONDED_KEYS:
        for one, other in (pair, pair[::-1]):
            if one in stated and other not in stated:
                raise InputError(table.where(other), f"a table, because {one} is stated", None)
    return LayerRecord(name=name, properties=tuple(properties))


def _property(key: str, quantity: Quantity, table: _Table) -> Property:
    unit = table.text("unit")
    if unit not in quantity.units:
        raise InputError(table.where("unit"), f"one of {', '.join(quantity.units)}", unit)
    value = table.number("value")
    if not quantity.holds(value * quantity.units[unit]):
        advice = f"that is {value * quantity.units[unit]:g} {quantity.si_unit}; is the unit right?"
        raise InputError(table.where("value"), quantity.expected, value, advice)
    status = table.choice("status", Status)
    found = Property(
        key=key,
        value=value,
        spread=table.spread(value),
        unit=unit,
        source=table.text("source"),
        method=_method(table),
        status=status,
        reason=table.text("reason", required=status in _EXPLAINED),
        also=table.texts("also"),
    )
    table.finish()
    return found


def _method(parent: _Table) -> Method:
    table = parent.table("method", required=True)
    assert table is not None
    method = Method(
        setting=table.choice("setting", Setting),
        technique=table.text("technique"),
        rate=table.text("rate", required=False),
        site=table.text("site", required=False),
        species=table.text("species", required=False),
    )
    table.finish()
    return method


class _Table:
    """A TOML table being read: hands out checked values and remembers which keys were asked for."""

    def __init__(self, content: Mapping[str, Any], file: str, path: str) -> None:
        self._content, self._file, self._path = content, file, path
        self._asked: set[str] = set()

    def where(self, key: str) -> str:
        """Name a key as errors do: file, path, key."""
        return f"{self._file}: {self._path}{key}"

    def call_it(self, name: str) -> None:
        """Name the table in errors by what it describes, not by its number."""
        self._path = f"layer {name!r}: "

    def finish(self) -> None:
        """Refuse keys nobody asked for."""
        for key in self._content:
            if key not in self._asked:
                raise InputError(self.where(key), f"one of the keys {', '.join(sorted(self._asked))}", key)

    def _take(self, key: str, *, expected: str, required: bool) -> Any:
        self._asked.add(key)
        if required and key not in self._content:
            raise InputError(self.where(key), expected, None, "the key is missing")
        return self._content.get(key)

    def text(self, key: str, *, required: bool = True) -> str:
        value = self._take(key, expected="a text", required=required)
        if value is None:
            return ""
        if not isinstance(value, str) or not value.strip():
            raise InputError(self.where(key), "a text", value)
        return value.strip()

    def texts(self, key: str) -> tuple[str, ...]:
        value = self._take(key, expected="a list of texts", required=False)
        if value is None:
            return ()
        if not isinstance(value, list) or not all(isinstance(item, str) and item.strip() for item in value):
            raise InputError(self.where(key), "a list of texts", value)
        return tuple(item.strip() for item in value)

    def number(self, key: str) -> float:
        value = self._take(key, expected="a number", required=True)
        if not _is_number(value):
            raise InputError(self.where(key), "a finite number", value)
        return float(value)

    def choice(self, key: str, kind: type[EnumType], default: EnumType | None = None) -> EnumType:
        expected = f"one of {', '.join(repr(item.value) for item in kind)}"
        value = self._take(key, expected=expected, required=default is None)
        if value is None and default is not None:
            return default
        if not isinstance(value, str) or value not in {item.value for item in kind}:
            raise InputError(self.where(key), expected, value)
        return kind(value)

    def spread(self, value: float) -> Spread:
        expected = 'a standard deviation, [low, high] around the value, or "none"'
        spread = self._take("spread", expected=expected, required=True)
        if spread == "none":
            return None
        if _is_number(spread) and spread > 0:
            return float(spread)
        if isinstance(spread, list) and len(spread) == 2 and all(map(_is_number, spread)):
            low, high = map(float, spread)
            if low <= value <= high and low < high:
                return low, high
        raise InputError(self.where("spread"), expected, spread)

    def table(self, key: str, *, required: bool) -> _Table | None:
        value = self._take(key, expected="a table", required=required)
        if value is None:
            return None
        if not isinstance(value, dict):
            raise InputError(self.where(key), "a table", value)
        return _Table(value, self._file, f"{self._path}{key}.")

    def tables(self, key: str) -> list[_Table]:
        expected = "one [[layer]] table at least"
        value = self._take(key, expected=expected, required=True)
        if not isinstance(value, list) or not value or not all(isinstance(item, dict) for item in value):
            raise InputError(self.where(key), expected, value)
        return [_Table(item, self._file, f"{key} {place}: ") for place, item in enumerate(value, start=1)]


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return isfinite(value)
    except OverflowError:  # TOML integers have no largest value
        return False
