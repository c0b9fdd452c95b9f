"""Where tests find measured sets, and tiny ones they write themselves."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

BESIDE = Path(__file__).parents[2] / "shared" / "data" / "tissue"
NOT_HERE = "measured sets are not part of the repository: name their folder in TROCAR_MEASURED to run this"


def measured_folder() -> Path:
    """Return the folder of the real sets, or skip the test."""
    folder = Path(os.environ.get("TROCAR_MEASURED", BESIDE))
    if not folder.is_dir():
        pytest.skip(NOT_HERE)
    return folder


def write_disc(folder: Path, name: str, *, strain: np.ndarray, load: np.ndarray) -> Path:
    """Write a disc of 50 by 30 mm as its authors would."""
    place = folder / "ecoflex_phantom_compression_ccby" / "data"
    place.mkdir(parents=True, exist_ok=True)
    head = [
        name,
        "Cylinder Diameter: 50mm;",
        "Cylinder Height: 30mm;",
        "Time (s),Compression (mm),Load (N),Engineering Strain [-]",
    ]
    rows = [
        f"{0.1 * row:.3f},{30 * e:.6f},{force:.6f},{-e:.6f}"
        for row, (e, force) in enumerate(zip(strain, load, strict=True))
    ]
    path = place / f"{name}.csv"
    path.write_text("\n".join([*head, *rows]) + "\n")
    return path


def write_limbs(folder: Path, rows: list[dict[str, object]]) -> Path:
    """Write a table of limbs with one more column than is read."""
    place = folder / "multis_limb_indentation_mit"
    place.mkdir(parents=True, exist_ok=True)
    names = (
        "probe_area_mm2", "SubID", "Location", "BMI", "MaxForce", "TotalStrain", "Thickness", "Skin", "Fat",
        "Muscle",
    )  # fmt: skip
    lines = [",".join(str(row.get(name, "")) for name in names) for row in rows]
    path = place / "multis_layers_indentation.csv"
    path.write_text("\n".join([",".join(names), *lines]) + "\n")
    return path


def write_strip(folder: Path, name: str, stretch: np.ndarray, stress_kpa: np.ndarray) -> Path:
    """Write a strip."""
    place = folder / "sow_perineum_tension_gpl3" / "data"
    place.mkdir(parents=True, exist_ok=True)
    rows = [
        f"{0.5 * row},{l:.6f},{p:.6f}"
        for row, (l, p) in enumerate(zip(stretch, stress_kpa, strict=True))  # noqa: E741
    ]
    path = place / f"{name}.csv"
    path.write_text("\n".join(["time_s,stretch,nominal_stress_kPa", *rows]) + "\n")
    return path


def write_holds(folder: Path, tests: dict[tuple[str, str], np.ndarray]) -> Path:
    """Write ramps and holds: time [s], force [N] and indentation [mm] in columns."""
    place = folder / "beef_indentation_relaxation_gpl3"
    place.mkdir(parents=True, exist_ok=True)
    lines = ["date,test_id,time_s,force_N,indentation_mm,tool_gap_mm"]
    for (date, name), table in tests.items():
        lines += [f"{date},{name},{t:.4f},{f:.6f},{u:.6f},10" for t, f, u in table]
    path = place / "zwick_indentation_relaxation.csv"
    path.write_text("\n".join(lines) + "\n")
    return path
