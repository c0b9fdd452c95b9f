"""Records that cannot have been a press are refused with line and cause."""

import numpy as np
import pytest

from pressed_pads import pad, triangle
from trocar.errors import InputError
from trocar.study.calibration.reading import read_measurement

CASE = pad()


def write(path, head, *columns):
    rows = [",".join(f"{value:.6g}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


def press(change=lambda time, force, depth: (time, force, depth)):
    time, force = triangle()
    return change(time, force, 5.0 * force)


def test_a_record_leaves_in_si(tmp_path):
    time, force, depth = press()
    path = write(
        tmp_path / "a.csv", "time_s,force_n,displacement_mm,body_mm", time, force, depth, 0.5 * depth
    )
    marks = write(
        tmp_path / "m.csv", "time_s,x_mm,y_mm,uz_mm,ux_mm", time, 0 * time + 10, 0 * time + 20, -depth, depth
    )
    found = read_measurement(path, CASE, marks)
    assert [one.name for one in found.series] == ["displacement", "body", "markers' uz", "markers' ux"]
    assert found.series[0].range == pytest.approx(1e-3 * np.ptp(depth), rel=1e-5)  # six digits are written
    assert found.series[1].layer == "body"
    assert np.allclose(found.series[2].places, [0.01, 0.02])
    assert [one.axis for one in found.series] == [2, 2, 2, 0]
    assert [one.has_offset for one in found.series] == [True, True, False, False]


def spoiled(values, row, value):
    changed = values.copy()
    changed[row] = value
    return changed


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t, f, d: (t[:5], f[:5], d[:5]), "at least 10 rows, got 5"),
        (lambda t, f, d: (spoiled(t, 9, t[7]), f, d), "line 11: time_s: expected a time after"),
        (lambda t, f, d: (t + 3 * (np.arange(41) > 20), f, d), "line 23: time_s: expected no gap"),
        (lambda t, f, d: (t, 0 * f + 0.1, d), "a force that changes, got 0.1 N all along"),
        (lambda t, f, d: (t, -f, d), "force_n: expected a force that presses"),
        (lambda t, f, d: (t, f, 0 * d), "a displacement that changes"),
        (lambda t, f, d: (t, f, -d), "expected a displacement that grows with the force"),
        (lambda t, f, d: (t, f, 1000 * d), r"line 22: .*are these micrometres"),
        (lambda t, f, d: (t, f, d / 1000), "are these metres"),
        (
            lambda t, f, d: (t, np.where(t < 0.5, 0, f), np.where(t < 0.5, 4 * t, 2 + d)),
            "line 11: .*no travel before there is a force, got 1.8 mm; begin the record at touch",
        ),
    ],
)
def test_an_impossible_record_is_refused(tmp_path, change, words):
    path = write(tmp_path / "a.csv", "time_s,force_n,displacement_mm", *press(change))
    with pytest.raises(InputError, match=words):
        read_measurement(path, CASE)


def test_rows_that_grow_apart_are_no_gap(tmp_path):
    time = np.concatenate([np.linspace(0, 1, 21), 1 + np.geomspace(0.1, 60, 20)])
    force = 0.05 * np.minimum(time, 1.0)
    path = write(tmp_path / "a.csv", "time_s,force_n,displacement_mm", time, force, 5 * force)
    assert read_measurement(path, CASE).duration == pytest.approx(61.0)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ((0.0, 40.0, 20.0), "x_mm: expected a place on the block, 0 to 30 mm"),
        ((9.0, 10.0, 20.0), "time_s: expected a time within the record"),
    ],
)
def test_a_marker_off_the_block_or_the_record_is_refused(tmp_path, columns, words):
    time, force, depth = press()
    path = write(tmp_path / "a.csv", "time_s,force_n,displacement_mm", time, force, depth)
    later, x, y = columns
    marks = write(
        tmp_path / "m.csv", "time_s,x_mm,y_mm,uz_mm", time + later, 0 * time + x, 0 * time + y, -depth
    )
    with pytest.raises(InputError, match=words):
        read_measurement(path, CASE, marks)
