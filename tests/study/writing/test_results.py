"""The files of a study say the same numbers as the study, with their units."""

import csv
import json
from datetime import UTC, datetime
from math import isfinite

import numpy as np
import pytest
import xarray as xr

from small_study import LEDGER
from trocar.study.report.figures.animation import Moving
from trocar.study.writing import results
from trocar.study.writing.folder import is_study
from trocar.study.writing.results import CURVE_COLUMNS, statistics, write_study

CREATED = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)


@pytest.fixture(scope="module")
def out(study, tmp_path_factory):
    place = tmp_path_factory.mktemp("results") / "study"
    report = write_study(study, place, ledger=LEDGER, command="trocar study --out study", created=CREATED)
    assert report == place / "report.html"
    return place


def test_all_files_are_there(out):
    assert is_study(out)
    names = sorted(entry.name for entry in out.iterdir())
    assert names == ["curves.csv", "figures", "ledger.json", "report.html", "results.nc", "statistics.json"]
    endings = {entry.suffix for entry in (out / "figures").iterdir()}
    assert endings == {".svg", ".gif", ".png"}


def test_the_data_set_carries_units_and_origin(out, study):
    with xr.open_dataset(out / "results.nc", engine="h5netcdf") as data:
        assert data.attrs["Conventions"].startswith("CF-")
        assert data.attrs["history"] == "2026-01-02T03:04:05+00:00 trocar study --out study"
        assert {"title", "source", "references", "version", "created"} <= set(data.attrs)
        for name, variable in data.variables.items():
            assert variable.attrs["long_name"], name
            assert "units" in variable.attrs or variable.dtype.kind in "UO", name
        depth = data["deflection_small"].sel(model="fea", layer="dermis")
        assert depth.attrs["units"] == "m"
        assert depth.values == pytest.approx(study.small["fea"].deflection["dermis"])
        assert data["time_small"].attrs["units"] == "s"
        top = data["displacement_tilted"].sel(layer="epidermis", component="z")
        assert top.values == pytest.approx(study.surfaces["tilted"].displacement["epidermis"][2])
        assert np.isnan(data["deflection_pair"].sel(model="wave-membrane")).all()  # not run through that case
        assert np.isfinite(data["deflection_pair"].sel(model="wave-solid")).all()
        assert data["deflection_support"].dims == ("support", "model", "layer", "time_small")


def test_the_curves_are_tidy(out, study):
    with (out / "curves.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert tuple(rows[0]) == CURVE_COLUMNS
    assert all(
        isfinite(float(row[key])) for row in rows for key in ("time_s", "force_n", "max_deflection_mm")
    )
    block = [row for row in rows if (row["case"], row["model"], row["layer"]) == ("paper", "fea", "block")]
    assert [float(row["max_deflection_mm"]) for row in block] == pytest.approx(1e3 * study.paper["fea"].block)
    assert {row["support"] for row in rows} == {"edges", "edges+base", "base"}


def test_statistics_and_ledger_are_json_of_any_reader(out, study):
    def refuse(word):
        raise AssertionError(word)

    said = json.loads((out / "statistics.json").read_text(), parse_constant=refuse)
    curve = study.agreement["small"]["wave-solid"]["fat"]
    assert said["agreement"]["small"]["wave-solid"]["fat"]["nrmse"] == curve.nrmse
    assert set(said["numerics"]["fat"]) == {"reference", "model", "comparison", "resolved", "model_error"}
    assert said["strength"]["epidermis"]["tensile_strength"] is None  # unknown
    assert said["cost"]["tap"]["fea"]["dofs"] == study.tap["fea"].dofs
    assert said["linear_range"] is None
    ledger = json.loads((out / "ledger.json").read_text(), parse_constant=refuse)
    assert [entry["id"] for entry in ledger] == ["b11", "density", "damping"]
    assert ledger == [dict(entry) for entry in LEDGER]


def test_a_range_goes_into_the_statistics(study):
    class Verdict:
        strain, deflection_share, slope, inside, limiting, force_limit = (
            0.02,
            0.03,
            0.1,
            True,
            "strain",
            float("inf"),
        )

    said = statistics(study, {"small": Verdict()})["linear_range"]
    assert said["small"]["inside"] is True
    assert said["small"]["force_limit"] is None


def test_an_interrupted_writing_leaves_the_earlier_study(out, study, monkeypatch):
    before = (out / "report.html").read_bytes()

    def interrupt(*_arguments, **_keywords):
        raise KeyboardInterrupt

    monkeypatch.setattr(results, "pictures", lambda _study: {})
    monkeypatch.setattr(results, "animation", lambda _film: Moving(gif=b"", still=b"", frames=0))
    monkeypatch.setattr(results, "report_page", interrupt)  # the last thing made
    with pytest.raises(KeyboardInterrupt):
        write_study(study, out)
    assert (out / "report.html").read_bytes() == before
    assert [entry.name for entry in out.parent.iterdir()] == [out.name]
