"""Where tests find measured sets, and tiny ones they write themselves."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from trocar.study.measured.platens import EXPONENTS, STRAINS, Faces, Platens

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


def write_pull(folder: Path, material: str, stretch: np.ndarray, stress_mpa: np.ndarray) -> Path:
    """Write a silicone in tension, semicolons between its cells."""
    place = folder / "soft_robotics_elastomers_odbl" / "data"
    place.mkdir(parents=True, exist_ok=True)
    head = [
        "PARAMETER;INFO;URL;;",
        "Time (s);True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)",
    ]
    rows = [f"0;0;0;{x - 1:.6f};{p:.8f}" for x, p in zip(stretch, stress_mpa, strict=True)]
    path = place / f"{material.replace(' ', '_')}.csv"
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


def write_rubber(folder: Path) -> None:
    """Write neo-Hookean rubber of 0.4 MPa."""
    place = folder / "rubber_treloar_kawabata_mit"
    place.mkdir(parents=True, exist_ok=True)
    pulled = [f"{x:.4f},{0.4 * (x - x**-2):.5f}" for x in np.linspace(1.05, 3, 12)]
    (place / "treloar1944_uniaxial_fig3.csv").write_text(
        "\n".join(["stretch,nominal_stress_MPa", *pulled]) + "\n"
    )
    both = [
        f"{a},{b},{0.4 * (a - a**-3 * b**-2):.5f},{0.4 * (b - b**-3 * a**-2):.5f}"
        for a in (1.2, 1.6, 2.2)
        for b in (0.9, 1.0, 1.2)
    ]
    head = "lambda1,lambda2,nominal_stress1_MPa,nominal_stress2_MPa"
    (place / "kawabata1981_biaxial.csv").write_text("\n".join([head, *both]) + "\n")


def write_small_sets(folder: Path) -> Path:
    """Write a little of every set but the silicones in tension."""
    strain = np.linspace(0, 0.667, 60)
    for name, factor in (("EF10_0T_A1", 1.0), ("EF10_0T_B1", 1.1), ("EF30_0T_A1", 2.0), ("EF30_0T_B1", 2.0)):
        write_disc(folder, name, strain=strain, load=30 * factor * ((1 - strain) ** -2 - (1 - strain)))
    random = np.random.default_rng(3)
    write_limbs(
        folder,
        [
            {
                "probe_area_mm2": 360, "SubID": f"{row // 2:03}", "Location": ("LA_A", "UL_P")[row % 2],
                "MaxForce": random.uniform(4, 9), "TotalStrain": random.uniform(0.15, 0.3), "Thickness": 30,
                "Skin": random.uniform(1, 2), "Fat": random.uniform(4, 9), "Muscle": random.uniform(15, 25),
            }
            for row in range(40)
        ],
    )  # fmt: skip
    stretch = np.linspace(1, 1.5, 40)
    for animal in ("pig04", "pig05", "pig09"):
        write_strip(folder, f"{animal}_skin", stretch, 100 * (stretch - 1) + 500 * (stretch - 1) ** 2)
    time = np.arange(0.0, 12.0, 0.1)
    hold = np.column_stack(
        [time, np.minimum(time, 2) * np.exp(-np.maximum(time - 2, 0) / 20), np.minimum(time, 2)]
    )
    write_holds(folder, {("230407", "FF1"): hold, ("230411", "FF2"): hold})
    write_rubber(folder)
    return folder


def rough_platens(shape: float, _watch: object = None) -> Platens:
    """Return a table for held faces without finite elements: a third above faces that slide."""
    bare = Platens(shape=shape, table=np.zeros((0, 0)), stiffness=4.0)
    table = np.array([1.3 * bare.force(Faces.FREE, exponent, STRAINS) for exponent in EXPONENTS])
    return Platens(shape=shape, table=table, stiffness=4.0)
