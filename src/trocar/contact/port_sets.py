"""Where the ports are: sets by name, and a file of one's own.

A file is TOML, lengths in millimetres, the block's corner at the origin, z out of the tissue:

    [left]
    port_mm = [-50, -10, 100]
    tip = "grasper"          # or "probe", "needle-holder", "hook", "scissors"
    shaft_diameter_mm = 5    # optional, 5 to 10
    length_mm = 310          # optional, from handle to tip

and the same under [right].
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from math import dist
from pathlib import Path

from trocar.contact.instrument import NAMES, Instrument, TipKind, Vector, default_instruments
from trocar.errors import InputError
from trocar.units import MILLIMETRE

_LENGTH, _DIAMETER = 0.31, 5e-3  # [m] of a usual shaft
_DIAMETERS_MM = (5.0, 10.0)
_CLEARANCE = 8e-3  # [m] of a tip above the block at the start
_SHARES = (0.3, 0.7)  # of the block's width, where the tips are at the start
_KEYS = ("port_mm", "tip", "shaft_diameter_mm", "length_mm")


@dataclass(frozen=True, kw_only=True)
class PortSet:
    """Two ports, from the middle of the block.

    Args:
        description: in a few words.
        left, right: places from the middle of the top face [m].
        tips: what the left and the right instrument end in.
    """

    description: str
    left: Vector
    right: Vector
    tips: tuple[TipKind, TipKind]


USUAL = "usual"
"""Both sides, towards the user, 100 mm above the tissue: `default_instruments`."""

# Oblique ports lie low: their shafts meet the tissue under 25 degrees.
PORT_SETS: Mapping[str, PortSet] = {
    "oblique": PortSet(
        description="low on both sides: shafts lie flat over the tissue",
        left=(-0.12, -0.04, 0.06),
        right=(0.12, -0.04, 0.06),
        tips=(TipKind.GRASPER, TipKind.HOOK),
    ),
    "one-sided": PortSet(
        description="both from the right, as beside a camera on the left",
        left=(0.05, -0.09, 0.1),
        right=(0.12, 0.0, 0.08),
        tips=(TipKind.GRASPER, TipKind.NEEDLE_HOLDER),
    ),
    "scissors": PortSet(
        description="as usual, with scissors in the right hand",
        left=(-0.08, -0.04, 0.1),
        right=(0.08, -0.04, 0.1),
        tips=(TipKind.GRASPER, TipKind.SCISSORS),
    ),
}


def instruments_through(ports: str, size: tuple[float, float]) -> tuple[Instrument, Instrument]:
    """Return the instruments of a set by name, or of a file.

    Args:
        ports: `USUAL`, one of `PORT_SETS`, or the path of a TOML file.
        size: sides of the block [m].

    Raises:
        InputError: there is no such set or file, or something in the file is not possible.
    """
    if ports == USUAL:
        return default_instruments(size)
    if ports in PORT_SETS:
        chosen = PORT_SETS[ports]
        left, right = (
            _through(name, (size[0] / 2 + x, size[1] / 2 + y, z), tip, size)
            for name, (x, y, z), tip in zip(NAMES, (chosen.left, chosen.right), chosen.tips, strict=True)
        )
        return left, right
    if ports.endswith(".toml") or os.sep in ports:
        return read_ports(Path(ports), size)
    names = (USUAL, *PORT_SETS)
    close = get_close_matches(ports, names, n=1)
    advice = f"did you mean {close[0]}?" if close else ""
    raise InputError("ports", f"one of {', '.join(names)}, or a file that ends with .toml", ports, advice)


def instruments_over(
    ports: str, size: tuple[float, float], usual: tuple[float, float]
) -> tuple[Instrument, Instrument]:
    """Return the instruments of a set by name, as over a block of usual size in the middle of another; or of a file.

    Args:
        ports: as in `instruments_through`; places in a file are those of the other block.
        size: sides of the other block [m].
        usual: sides of the usual one [m].

    Raises:
        InputError: there is no such set or file, or something in the file is not possible.
    """
    if ports != USUAL and ports not in PORT_SETS:
        return instruments_through(ports, size)
    dx, dy = (0.5 * (side - one) for side, one in zip(size, usual, strict=True))

    def moved(place: Vector) -> Vector:
        return place[0] + dx, place[1] + dy, place[2]

    left, right = (
        replace(one, port=moved(one.port), handle=moved(one.handle))
        for one in instruments_through(ports, usual)
    )
    return left, right


def read_ports(path: Path, size: tuple[float, float]) -> tuple[Instrument, Instrument]:
    """Read both instruments from a file.

    Args:
        path: of the file.
        size: sides of the block [m].

    Raises:
        InputError: the file cannot be read, a key is unknown or missing, or a value is not possible.
    """
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError("ports", "a file that can be read", str(path), error.strerror or "") from error
    except UnicodeDecodeError as error:
        raise InputError(str(path), "text in UTF-8", str(error)) from error
    except (tomllib.TOMLDecodeError, ValueError, RecursionError) as error:
        raise InputError(str(path), "TOML", str(error)) from error
    for key in tables:
        if key not in NAMES:
            raise InputError(f"{path}: {key}", "[left] and [right]", key)
    left, right = (_read(path, name, tables.get(name), size) for name in NAMES)
    return left, right


def _read(path: Path, name: str, table: object, size: tuple[float, float]) -> Instrument:
    where = f"{path}: [{name}]"
    if not isinstance(table, dict):
        raise InputError(where, "a table with port_mm and tip", table)
    for key in table:
        if key not in _KEYS:
            close = get_close_matches(key, _KEYS, n=1)
            raise InputError(f"{where} {key}", f"one of {', '.join(_KEYS)}", key, *_advice(close))
    for key in ("port_mm", "tip"):
        if key not in table:
            raise InputError(f"{where} {key}", "a value", "nothing")
    port = table["port_mm"]
    if not (isinstance(port, list) and len(port) == 3 and all(map(_is_number, port))):
        raise InputError(f"{where} port_mm", "three numbers", port)
    diameter = table.get("shaft_diameter_mm", _DIAMETER / MILLIMETRE)
    if not (_is_number(diameter) and _DIAMETERS_MM[0] <= diameter <= _DIAMETERS_MM[1]):
        raise InputError(f"{where} shaft_diameter_mm", "a number from 5 to 10", diameter)
    length = table.get("length_mm", _LENGTH / MILLIMETRE)
    if not _is_number(length):
        raise InputError(f"{where} length_mm", "a number", length)
    x, y, z = (float(value) * MILLIMETRE for value in port)
    return _through(
        name, (x, y, z), table["tip"], size, length=length * MILLIMETRE, radius=0.5 * diameter * MILLIMETRE
    )


def _advice(close: list[str]) -> tuple[str, ...]:
    return (f"did you mean {close[0]}?",) if close else ()


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _through(
    name: str,
    port: Vector,
    tip: object,
    size: tuple[float, float],
    *,
    length: float = _LENGTH,
    radius: float = 0.5 * _DIAMETER,
) -> Instrument:
    if not isinstance(tip, str) or tip not in list(TipKind):
        raise InputError(f"{name} instrument: tip", f"one of {', '.join(TipKind)}", tip)
    if port[2] < 2 * _CLEARANCE:
        raise InputError(f"{name} instrument: port", "a place at least 16 mm above the tissue", port)
    start = (_SHARES[NAMES.index(name)] * size[0], size[1] / 2, _CLEARANCE)
    inside = dist(start, port)
    if not inside < length:
        raise InputError(
            f"{name} instrument: port",
            f"a place within {length / MILLIMETRE:g} mm of the tissue, the shaft's length",
            f"{inside / MILLIMETRE:.4g} mm away",
        )
    x, y, z = (s - length * (s - p) / inside for s, p in zip(start, port, strict=True))
    return Instrument(
        name=name, port=port, length=length, shaft_radius=radius, tip=TipKind(tip), handle=(x, y, z)
    )
