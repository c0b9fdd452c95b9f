"""The reproduction ledger: every number of the 2014 paper beside our own, with a verdict.

Each `recomputed` comes out of code from the paper's own inputs, each verdict out of the printed digits.

Source: S. Patel and J. Suthakorn, Validation Study of a Wave Equation Model of Soft Tissue for a New Virtual
Reality Laparoscopy Training System, doi 10.1007/978-3-319-27707-3_16.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from pathlib import Path
from types import MappingProxyType

from trocar.errors import InputError
from trocar.study.ledger.dermis import dermis_entries
from trocar.study.ledger.entry import Entry, Verdict, agrees
from trocar.study.ledger.gaps import gap_entries
from trocar.study.ledger.membrane import membrane_entries
from trocar.study.ledger.protocol import protocol_entries
from trocar.study.ledger.t_tests import t_test_entries

__all__ = ["Entry", "Verdict", "agrees", "ledger", "write_ledger"]

SECONDS = ("wave_seconds", "fea_seconds")
_NOTHING: Mapping[str, float] = MappingProxyType({})


def ledger(measured: Mapping[str, float] = _NOTHING) -> tuple[Entry, ...]:
    """Return every number of the paper, recomputed where its text allows.

    Args:
        measured: what this machine found: "wave_seconds" and "fea_seconds", the time each model takes for the
            same case [s], and a number for any id whose verdict is "not specified", in that entry's unit.

    Raises:
        InputError: a key is neither, or a number is not finite, or a time is not above 0.
    """
    for key, value in measured.items():
        if not isfinite(value) or (key in SECONDS and value <= 0):
            raise InputError(f"measured: {key}", "a finite number, above 0 for a time", value)
    seconds = {key: measured[key] for key in SECONDS if key in measured}
    entries = (
        *dermis_entries(),
        *membrane_entries(),
        *protocol_entries(**seconds),
        *t_test_entries(),
        *gap_entries(),
    )
    open_ids = {entry.id for entry in entries if entry.verdict is Verdict.NOT_SPECIFIED}
    for key in measured.keys() - set(SECONDS) - open_ids:
        raise InputError("measured", f"keys out of {', '.join((*SECONDS, *sorted(open_ids)))}", key)
    return tuple(
        replace(entry, recomputed=float(measured[entry.id])) if entry.id in measured else entry
        for entry in entries
    )


def write_ledger(path: str | os.PathLike[str], measured: Mapping[str, float] = _NOTHING) -> None:
    """Write the ledger as a JSON list of objects, one per entry.

    Args:
        path: of the file; an existing one is replaced.
        measured: as `ledger` takes it.

    Raises:
        InputError: as `ledger` does.
        OSError: the file cannot be written.
    """
    rows = [entry.as_dict() for entry in ledger(measured)]
    Path(path).write_text(json.dumps(rows, indent=2, allow_nan=False) + "\n", encoding="utf-8")
