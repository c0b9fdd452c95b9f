"""Writes fitted layers as a tissue file, which works wherever a preset does; every value says where it is from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from trocar.errors import InputError
from trocar.study.calibration.calibration import Calibration
from trocar.study.calibration.identifiability import Estimate
from trocar.study.calibration.parameter import of_sheets
from trocar.study.report.table import percent
from trocar.tissues.key_table import Words
from trocar.tissues.layer import Layer
from trocar.tissues.record import Setting
from trocar.units import KILOPASCAL, MILLIMETRE
from trocar.whole_file import write_whole

BEGINNING = "# Written by trocar calibrate"
SETTINGS = (Setting.IN_VIVO, Setting.EX_VIVO, Setting.MATERIAL)
_STATED = (  # key, unit, factor, whether it is left out where it is 0
    ("thickness", "mm", MILLIMETRE, False),
    ("young_modulus", "kPa", KILOPASCAL, False),
    ("poisson_ratio", "1", 1.0, False),
    ("density", "kg/m3", 1.0, False),
    ("prestress_x", "kPa", KILOPASCAL, True),
    ("prestress_y", "kPa", KILOPASCAL, True),
    ("loss_factor", "1", 1.0, True),
    ("loss_frequency", "Hz", 1.0, True),
)


def check_tissue_file(out: Path, names: tuple[str, ...]) -> None:
    """Refuse a place or parameters that no tissue file can be written for, before any work.

    Raises:
        InputError: the name does not end with .toml, something else is there, or sheets are fitted, not layers.
    """
    if out.suffix != ".toml":
        raise InputError("--out", "a file name that ends with .toml", str(out))
    if out.exists() and not (out.is_file() and _begins(out)):
        got = Words("a folder" if out.is_dir() else "another file")
        raise InputError(
            f"--out {out}", "a new file, or an earlier calibration's", got, "choose another name"
        )
    sheets = [name for name in names if of_sheets(name)]
    if sheets:
        raise InputError(
            "--out",
            "parameters of layers, which a tissue file holds",
            sheets[0],
            "leave --out away, or fit moduli",
        )


def write_tissue_file(out: Path, calibration: Calibration, setting: Setting) -> None:
    """Write the fitted tissue.

    Args:
        out: the file; an earlier calibration's is replaced.
        calibration: what was fitted.
        setting: where the data were measured.

    Raises:
        InputError: as `check_tissue_file`.
        OSError: it cannot be written.
    """
    check_tissue_file(out, tuple(item.parameter.name for item in calibration.known.estimates))
    text = "\n".join(tissue_lines(calibration, setting)) + "\n"
    out.parent.mkdir(parents=True, exist_ok=True)
    write_whole(out, lambda stream: stream.write(text))


def tissue_lines(calibration: Calibration, setting: Setting) -> Iterator[str]:
    """Yield the file's lines; arguments as those of `write_tissue_file`."""
    source = calibration.problem.measurement.source
    yield f"{BEGINNING} from {_plain(source)}"
    yield f"title = {_text(f'{calibration.case.title}, fitted to {source}')}"
    why = [*calibration.known.sentences]
    if calibration.held_out is not None:
        why.append(calibration.held_out.sentence)
    yield f"why = {_text(' '.join([*why, *calibration.warnings]) or 'Fitted.')}"
    fitted = {item.parameter.name: item for item in calibration.known.estimates}
    for layer in calibration.specimen.tissue.layers:
        yield from ("", "[[layer]]", f"name = {_text(layer.name)}")
        damped = layer.loss_factor > 0
        for key, unit, factor, only_some in _STATED:
            stated = damped if key.startswith("loss") else layer.prestress_x + layer.prestress_y > 0
            if not only_some or stated:
                item = fitted.get(f"{layer.name}.{key}") or (
                    fitted.get(f"{layer.name}.prestress") if key.startswith("prestress") else None
                )
                yield from _property(
                    key, getattr(layer, key) / factor, unit, factor, item, calibration, setting
                )
        if layer.prony:
            yield from _memory(layer, fitted, calibration, setting)


def _memory(
    layer: Layer, fitted: dict[str, Estimate], calibration: Calibration, setting: Setting
) -> Iterator[str]:
    terms = [
        f"prony[{term}].{part}: {_interval(item)}"
        for term, _ in enumerate(layer.prony)
        for part in ("g", "tau")
        if (item := fitted.get(f"{layer.name}.prony[{term}].{part}")) is not None
    ]
    yield from ("", "[layer.memory]")
    yield f"prony = [{', '.join(f'[{g:.5g}, {tau:.5g}]' for g, tau in layer.prony)}]"
    yield from _origin("; ".join(terms), calibration, setting)


def _property(
    key: str,
    value: float,
    unit: str,
    factor: float,
    item: Estimate | None,
    calibration: Calibration,
    setting: Setting,
) -> Iterator[str]:
    shown = float(f"{value:.6g}")
    yield from ("", f"[layer.{key}]", f"value = {shown!r}")
    if item is not None and item.low is not None and item.high is not None:
        low, high = (
            min(float(f"{item.low / factor:.6g}"), shown),
            max(float(f"{item.high / factor:.6g}"), shown),
        )
        yield f"spread = [{low!r}, {high!r}]"
    else:
        yield 'spread = "none"'
    yield f'unit = "{unit}"'
    yield from _origin("" if item is None else _interval(item), calibration, setting)


def _origin(interval: str, calibration: Calibration, setting: Setting) -> Iterator[str]:
    """Yield where something is from: the case, or the fit that gave the interval told."""
    if not interval:
        yield 'status = "chosen"'
        yield 'reason = "not fitted: as the case file has it"'
        yield f"source = {_text(calibration.case.title)}"
        yield 'method = { setting = "choice", technique = "none" }'
        return
    yield 'status = "derived"'
    yield f"reason = {_text(f'fitted with {calibration.model}; {interval}')}"
    yield f"source = {_text(calibration.problem.measurement.source)}"
    yield f'method = {{ setting = "{setting.value}", technique = "force and displacement of a tool, inverse fit" }}'


def _interval(item: Estimate) -> str:
    if item.told:
        return f"within {percent(1.96 * item.error)} at 95 %"
    if item.at_bound:
        return "ran into the end of what may be tried"
    return "the data leave it open"


def _begins(out: Path) -> bool:
    with out.open("rb") as stream:
        return stream.read(len(BEGINNING)) == BEGINNING.encode()


def _plain(text: str) -> str:
    return "".join(sign if sign.isprintable() else "?" for sign in text)


def _text(text: str) -> str:
    """Return a TOML basic string."""
    escaped = _plain(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
