"""Tissues by name: the presets that ship with Trocar, and files that users write, with every source."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType

from trocar.errors import InputError
from trocar.tissues.reading import read_tissue
from trocar.tissues.record import Property, TissueRecord
from trocar.tissues.tissue import Tissue

PAPER_PRESET = "skin-paper-2014"
"""Table 1 of the 2014 paper, as printed."""

_PRESETS = files("trocar.tissues") / "presets"


@cache
def names() -> tuple[str, ...]:
    """Return the presets' names, in alphabetical order."""
    found = (entry.name for entry in _PRESETS.iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml")))


def record(name: str) -> TissueRecord:
    """Return a tissue with its provenance.

    Args:
        name: of a preset, or the path of a tissue file, which ends with .toml.

    Raises:
        InputError: no preset has this name; the message offers the closest ones. Or the file is not one.
    """
    return read_tissue(Path(name)) if name.endswith(".toml") else _preset(name)


@cache
def _preset(name: str) -> TissueRecord:
    if name not in names():
        close = get_close_matches(name, names(), n=2, cutoff=0.5)
        advice = f"did you mean {' or '.join(close)}?" if close else "a tissue file ends with .toml"
        raise InputError("tissue", f"one of {', '.join(names())}", name, advice)
    return read_tissue(_PRESETS / f"{name}.toml")


def tissue(name: str) -> Tissue:
    """Return a tissue in SI, for any model.

    Args:
        name: of a preset, or the path of a tissue file, which ends with .toml.

    Raises:
        InputError: as `record`, or its values are for the paper's own formula only.
    """
    return record(name).tissue()


@cache
def paper_table() -> Mapping[str, Property]:
    """Return Table 1 of the 2014 paper by key; each `value` is the number as printed, in the unit printed.

    The keys are those of `quantity.PAPER_QUANTITIES`. Source: Patel and Suthakorn, Table 1.
    """
    return MappingProxyType({item.key: item for item in record(PAPER_PRESET).layers[0].properties})
