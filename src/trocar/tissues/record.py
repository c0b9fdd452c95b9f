"""A tissue with its provenance: every value with its spread, source, method, and whether it was read there.

A `TissueRecord` is what a tissue file says. `Tissue` is what a model computes with: the same values in SI,
without their history.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, ClassVar

from trocar.errors import InputError
from trocar.tissues.law import LINEAR, Law
from trocar.tissues.law_keys import law_keys, law_text
from trocar.tissues.layer import Layer, Prony
from trocar.tissues.quantity import LAYER_QUANTITIES, PAPER_QUANTITIES, Quantity
from trocar.tissues.tissue import Tissue
from trocar.units import MILLIMETRE

Spread = float | tuple[float, float] | None


class Status(StrEnum):
    """How far a value can be trusted to be what its source says."""

    READ = "read"  # in the source named, or in its abstract
    DERIVED = "derived"  # computed from values that were read
    CHOSEN = "chosen"  # an engineering choice, with its reason
    REMEMBERED = "remembered"  # from memory: verify before citing


class Setting(StrEnum):
    """Where a value was obtained."""

    IN_VIVO = "in vivo"
    EX_VIVO = "ex vivo"
    MATERIAL = "material test"  # on something that never lived
    HANDBOOK = "handbook"  # a table that does not say how
    PRINTED = "printed"  # as the 2014 paper prints it
    CHOICE = "choice"  # nowhere: decided here


class Usable(StrEnum):
    """Who may compute with a tissue."""

    ANY = "every model"
    PAPER = "paper formula only"  # its units are impossible; only the formula printed beside it takes them


@dataclass(frozen=True, kw_only=True)
class Method:
    """How a value was measured; an empty text means that the source, as far as it was read, does not say."""

    setting: Setting
    technique: str
    rate: str = ""
    site: str = ""
    species: str = ""

    def __str__(self) -> str:
        return ", ".join(part for part in (self.setting.value, *self._details) if part)

    @property
    def _details(self) -> tuple[str, ...]:
        return self.technique, self.rate, self.site, self.species


@dataclass(frozen=True, kw_only=True)
class Stated:
    """Where something that a layer states comes from.

    Args:
        source: author and year, or the table it stands in.
        method: how it was measured.
        status: read, derived, chosen or remembered.
        reason: how it was derived or why it was chosen.
        also: other published values, in words.
    """

    source: str
    method: Method
    status: Status
    reason: str = ""
    also: tuple[str, ...] = ()

    @property
    def origin(self) -> dict[str, Any]:
        """All of this as plain values for JSON."""
        return {
            "source": self.source,
            "method": {
                "setting": self.method.setting.value,
                "technique": self.method.technique,
                "rate": self.method.rate,
                "site": self.method.site,
                "species": self.method.species,
            },
            "status": self.status.value,
            "reason": self.reason,
            "also": list(self.also),
        }


@dataclass(frozen=True, kw_only=True)
class Property(Stated):
    """One value and where it comes from.

    Args:
        key: name of the quantity.
        value: in `unit`.
        spread: in `unit`: a standard deviation, a (low, high) range, or None where the source gives none.
        unit: as people write it.
    """

    key: str
    value: float
    spread: Spread
    unit: str

    @property
    def title(self) -> str:
        """How it is called in tables."""
        return self.quantity.title

    @property
    def value_text(self) -> str:
        """The value without its unit."""
        return f"{self.value:g}"

    @property
    def quantity(self) -> Quantity:
        """What kind of thing this is."""
        known = LAYER_QUANTITIES.get(self.key)
        return known if known is not None and self.unit in known.units else PAPER_QUANTITIES[self.key]

    @property
    def si(self) -> float:
        """The value in the quantity's SI unit."""
        return self.value * self.quantity.units[self.unit]

    @property
    def spread_text(self) -> str:
        """The spread in words: "± 88", "0.077 to 0.267" or ""."""
        if self.spread is None:
            return ""
        if isinstance(self.spread, tuple):
            return f"{self.spread[0]:g} to {self.spread[1]:g}"
        return f"± {self.spread:g}"

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values for JSON, the SI value and unit included."""
        return {
            "value": self.value,
            "spread": list(self.spread) if isinstance(self.spread, tuple) else self.spread,
            "unit": self.unit,
            "si_value": self.si,
            "si_unit": self.quantity.si_unit,
            **self.origin,
        }


class Unmeasured(Stated):
    """Something stated that is more than a number: it has neither unit nor spread."""

    unit: ClassVar = "1"
    spread: ClassVar = None
    spread_text: ClassVar = ""


@dataclass(frozen=True, kw_only=True)
class StatedLaw(Unmeasured):
    """A law and where it comes from."""

    law: Law
    key: ClassVar = "law"
    title: ClassVar = "law"

    @property
    def value_text(self) -> str:
        """The law in words, with its numbers."""
        return law_text(self.law)

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values for JSON."""
        return {**law_keys(self.law), **self.origin}


@dataclass(frozen=True, kw_only=True)
class StatedMemory(Unmeasured):
    """A Prony series and where it comes from."""

    prony: Prony
    key: ClassVar = "memory"
    title: ClassVar = "memory"

    @property
    def value_text(self) -> str:
        """The terms in words."""
        return ", ".join(f"g {weight:g} over {time:g} s" for weight, time in self.prony)

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values for JSON; `prony` holds pairs of g [1] and tau [s]."""
        return {"prony": [list(term) for term in self.prony], **self.origin}


Statement = Property | StatedLaw | StatedMemory
"""Anything that a layer states."""


@dataclass(frozen=True, kw_only=True)
class LayerRecord:
    """One layer as stated.

    Args:
        name: of the layer.
        properties: in the order of the quantities.
        law: how stress follows from stretch; None where the layer says nothing, which means linear.
        memory: its Prony series; None where the layer does not remember.
    """

    name: str
    properties: tuple[Property, ...]
    law: StatedLaw | None = None
    memory: StatedMemory | None = None

    @property
    def stated(self) -> tuple[Statement, ...]:
        """Everything it states: properties, law, memory."""
        return *self.properties, *(item for item in (self.law, self.memory) if item is not None)

    def get(self, key: str) -> Property | None:
        """Return the property with this key, or None where the layer does not state it."""
        return next((item for item in self.properties if item.key == key), None)

    def __getitem__(self, key: str) -> Property:
        found = self.get(key)
        if found is None:
            stated = ", ".join(item.key for item in self.properties)
            raise InputError(f"layer {self.name!r}", f"one of {stated}", key)
        return found

    def layer(self) -> Layer:
        """Return the layer in SI, for a model."""
        values: dict[str, Any] = {item.key: item.si for item in self.properties}
        return Layer(
            name=self.name,
            law=LINEAR if self.law is None else self.law.law,
            prony=() if self.memory is None else self.memory.prony,
            **values,
        )


@dataclass(frozen=True, kw_only=True)
class TissueRecord:
    """A tissue as stated.

    Args:
        name: the preset's name, or the file's.
        title: what it is, in one line.
        why: how the values were chosen.
        usable: who may compute with it.
        instead: what to take where `usable` says no.
        layers: top (the side the tool touches) first.
    """

    name: str
    title: str
    why: str
    usable: Usable = Usable.ANY
    instead: str = ""
    layers: tuple[LayerRecord, ...]

    @property
    def stated(self) -> Iterator[Statement]:
        """Everything that every layer states, top first."""
        return (item for layer in self.layers for item in layer.stated)

    @property
    def thickness(self) -> float:
        """Thickness of all layers together [m]."""
        return sum(layer["thickness"].si for layer in self.layers)

    def count(self, status: Status) -> int:
        """Return how many of the things stated have this status."""
        return sum(item.status is status for item in self.stated)

    def layer(self, name: str) -> LayerRecord:
        """Return the layer with this name.

        Raises:
            InputError: no layer has it.
        """
        for layer in self.layers:
            if layer.name == name:
                return layer
        known = ", ".join(layer.name for layer in self.layers)
        raise InputError(f"tissue {self.name!r}: layer", f"one of {known}", name)

    def tissue(self) -> Tissue:
        """Return the tissue in SI, for a model.

        Raises:
            InputError: its values are for the paper's own formula only.
        """
        if self.usable is not Usable.ANY:
            raise InputError("tissue", f"a tissue usable by {Usable.ANY.value}", self.name, self.instead)
        return Tissue(name=self.name, layers=tuple(layer.layer() for layer in self.layers))

    def summary(self) -> dict[str, Any]:
        """Return what a list says of it, as plain values for JSON; `values` counts them by status."""
        return {
            "name": self.name,
            "title": self.title,
            "usable": self.usable.value,
            "layers": [layer.name for layer in self.layers],
            "thickness_mm": round(self.thickness / MILLIMETRE, 6),
            "values": {status.value: self.count(status) for status in Status},
        }

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values for JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "usable": self.usable.value,
            "instead": self.instead,
            "why": self.why,
            "layers": [
                {"name": layer.name, "properties": {item.key: item.as_dict() for item in layer.stated}}
                for layer in self.layers
            ],
        }
