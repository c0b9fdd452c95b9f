"""Reads a record of force and displacement, and markers beside it; refuses what cannot have been a press.

```text
# any comment
time_s,force_n,displacement_mm
0.00,0.000,0.000
0.10,0.004,0.171
```

`displacement_mm` is how deep the tool stands, positive into the tissue; `LAYER_mm` may add the largest deflection of
another layer's upper face. Markers, in a file of their own, stand at `x_mm`, `y_mm` of the block and move by `uz_mm`
(out of the tissue; pushed in is negative), and by `ux_mm`, `uy_mm` where those were seen too.
"""

from __future__ import annotations

from os import PathLike

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.calibration.columns import Columns, read_columns
from trocar.study.calibration.measurement import DEPTH, Measurement, Readings
from trocar.study.cases.experiment import Case
from trocar.tissues.key_table import Words
from trocar.units import MILLIMETRE

TIME, FORCE, DISPLACEMENT = "time_s", "force_n", "displacement_mm"
MARKER_COLUMNS = (TIME, "x_mm", "y_mm", "uz_mm")
FEWEST_ROWS = 10
_GAP = 10.0  # times the usual interval, and times both its neighbours: a record that is broken, not one that slows down
_LEAST_CHANGE = 1e-3  # of the largest force: less is noise of a force that stands still
_FREE = 0.02  # of the largest force: a tool that feels less does not touch
_FREE_TRAVEL = 0.1  # of the whole displacement, before there is a force: an approach through the air
_MOST_DEPTH = 1.0  # of the block's thickness
_LEAST_DEPTH = 1e-6  # [m]: less than a micrometre is read by no tool


def read_measurement(
    path: str | PathLike[str], case: Case, markers: str | PathLike[str] | None = None
) -> Measurement:
    """Read a record, with its markers.

    Args:
        path: of the record.
        case: the block that was pressed.
        markers: of the markers' file.

    Raises:
        InputError: something in a file cannot be, alone or on this block; the message names line and cause.
    """
    below = [f"{name}_mm" for name in case.tissue.layer_names[1:]]
    table = read_columns(path, (TIME, FORCE, DISPLACEMENT), below)
    time, force = table.values[TIME], table.values[FORCE]
    _check_time(table, time)
    series = [Readings(name=DEPTH, time=time, value=MILLIMETRE * table.values[DISPLACEMENT])]
    series += [
        Readings(name=name, layer=name, time=time, value=MILLIMETRE * table.values[f"{name}_mm"])
        for name in case.tissue.layer_names[1:]
        if f"{name}_mm" in table.values
    ]
    _check_force(table, force)
    for one in series:
        _check_depth(table, force, one, case)
    if markers is not None:
        series += _markers(markers, case, time)
    return Measurement(source=table.file, time=time, force=force, series=tuple(series))


def _check_time(table: Columns, time: FloatArray) -> None:
    if len(time) < FEWEST_ROWS:
        raise InputError(table.file, f"at least {FEWEST_ROWS} rows", len(time), "measure more often")
    steps = np.diff(time)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        raise InputError(
            table.where(row, TIME),
            f"a time after {time[row - 1]:g} s, the line before",
            float(time[row]),
            "sort the rows, and keep each time once",
        )
    usual = _GAP * np.median(steps)
    beside = np.maximum(np.append(steps[1:], 0.0), np.append(0.0, steps[:-1]))
    gaps = (steps > usual) & (steps > _GAP * beside)
    if gaps.any():
        row = int(np.argmax(gaps)) + 1
        raise InputError(
            table.where(row, TIME),
            f"no gap: rows elsewhere are {np.median(steps):.3g} s apart",
            Words(f"{steps[row - 1]:.3g} s without a row"),
            "give the part before or after it",
        )


def _check_force(table: Columns, force: FloatArray) -> None:
    where = f"{table.file}: {FORCE}"
    if np.ptp(force) <= _LEAST_CHANGE * np.abs(force).max():
        raise InputError(
            where, "a force that changes", Words(f"{force[0]:g} N all along"), "record the ramp too"
        )
    if force.max() <= -force.min():
        row = int(force.argmin())
        raise InputError(
            table.where(row, FORCE),
            "a force that presses, which is positive",
            float(force[row]),
            "turn the sign of the column",
        )


def _check_depth(table: Columns, force: FloatArray, series: Readings, case: Case) -> None:
    column = DISPLACEMENT if series.name == DEPTH else f"{series.name}_mm"
    where, depth = f"{table.file}: {column}", series.value
    if series.range == 0:
        raise InputError(
            where, "a displacement that changes", Words(f"{depth[0] / MILLIMETRE:g} mm all along")
        )
    if np.corrcoef(force, depth)[0, 1] < 0:
        raise InputError(
            where,
            "a displacement that grows with the force: into the tissue is positive",
            Words("one that falls as the force grows"),
            "turn the sign of the column, or exchange the two columns if they are swapped",
        )
    thickness = case.tissue.thickness
    if series.range > _MOST_DEPTH * thickness:
        row = int(depth.argmax())
        raise InputError(
            table.where(row, column),
            f"less than the block's thickness, {thickness / MILLIMETRE:g} mm",
            Words(f"a travel of {series.range / MILLIMETRE:.4g} mm"),
            "are these micrometres, or are the force's and the displacement's columns exchanged?",
        )
    if series.range < _LEAST_DEPTH:
        raise InputError(
            where,
            "a travel of at least 0.001 mm",
            Words(f"{series.range / MILLIMETRE:.3g} mm"),
            "are these metres, or are the force's and the displacement's columns exchanged?",
        )
    touching = np.maximum.accumulate(force) > _FREE * force.max()
    first = int(np.argmax(touching))
    if first >= 2 and np.ptp(depth[:first]) > _FREE_TRAVEL * series.range:
        raise InputError(
            table.where(first - 1, column),
            "no travel before there is a force",
            Words(f"{np.ptp(depth[:first]) / MILLIMETRE:.3g} mm"),
            f"begin the record at touch, near line {table.lines[first]}",
        )


def _markers(path: str | PathLike[str], case: Case, time: FloatArray) -> list[Readings]:
    table = read_columns(path, MARKER_COLUMNS, ("ux_mm", "uy_mm"))
    seen = table.values[TIME]
    if len(seen) < FEWEST_ROWS:
        raise InputError(table.file, f"at least {FEWEST_ROWS} rows", len(seen))
    outside = (seen < time[0]) | (seen > time[-1])
    if outside.any():
        row = int(np.argmax(outside))
        raise InputError(
            table.where(row, TIME),
            f"a time within the record of the force, {time[0]:g} to {time[-1]:g} s",
            float(seen[row]),
        )
    places = MILLIMETRE * np.stack([table.values["x_mm"], table.values["y_mm"]], axis=1)
    for axis, name in enumerate(("x_mm", "y_mm")):
        off = (places[:, axis] < 0) | (places[:, axis] > case.size[axis])
        if off.any():
            row = int(np.argmax(off))
            raise InputError(
                table.where(row, name),
                f"a place on the block, 0 to {case.size[axis] / MILLIMETRE:g} mm",
                float(table.values[name][row]),
                "the block's corner is the origin",
            )
    return [
        Readings(
            name=f"markers' {name}",
            time=seen,
            value=MILLIMETRE * table.values[f"{name}_mm"],
            places=places,
            axis=axis,
        )
        for axis, name in ((2, "uz"), (0, "ux"), (1, "uy"))
        if f"{name}_mm" in table.values
    ]
