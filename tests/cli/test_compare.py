"""trocar compare, as a user calls it."""

import json
from pathlib import Path

import pytest

from trocar.cli import main

PRESS, LIVER = (
    str(Path(__file__).parent.parent.parent / "examples" / f"{name}.toml") for name in ("press", "liver")
)


def test_a_table_names_layers_models_and_range(capsys):
    assert main(["compare", PRESS, "--models", "wave-solid,wave-membrane"]) == 0
    shown = capsys.readouterr().out
    for word in ("epidermis", "wave-membrane", "in the linear range", "yes"):
        assert word in shown


def test_json_is_alone_on_stdout(capsys):
    assert main(["compare", PRESS, "--models", "wave-solid", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["models"]["wave-solid"]["in_range"] is True


def test_a_mesh_is_run_through_its_waves_and_its_elements_counted(tmp_path, capsys):
    file = tmp_path / "liver.toml"
    file.write_text(Path(LIVER).read_text("utf-8").replace("spacing_mm = 24", "spacing_mm = 40"), "utf-8")
    assert main(["compare", str(file)]) == 0
    shown = capsys.readouterr().out
    for word in ("elements, peak 0.05 N", "wave-mesh", "surface", "in the linear range"):
        assert word in shown
    assert "support" not in shown


def test_the_mesh_free_model_comes_near_the_finite_elements(capsys):
    assert main(["compare", PRESS, "--models", "fea,mesh-free", "--json"]) == 0
    models = json.loads(capsys.readouterr().out)["models"]
    fea, free = models["fea"], models["mesh-free"]
    for layer, depths in fea["max_deflection_mm"].items():
        assert max(free["max_deflection_mm"][layer]) == pytest.approx(max(depths), rel=0.03)
    assert free["in_range"] is True


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["nothing.toml"], "nothing.toml"),
        ([PRESS, "--models", "fem"], "fem"),
        ([PRESS, "--models", ","], "at least one"),
        ([LIVER, "--models", "wave-mesh,fea"], "models: expected wave-mesh, which takes a mesh, got 'fea'"),
        ([], "'case'"),
    ],
)
def test_a_mistake_is_one_line_and_exit_2(capsys, arguments, word):
    assert main(["compare", *arguments]) == 2
    told = capsys.readouterr().err
    assert word in told
    assert "Traceback" not in told
    assert told.count("\n") == 1
