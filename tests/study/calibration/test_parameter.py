"""Parameters by name."""

from dataclasses import replace

import pytest

from pressed_pads import pad
from trocar.errors import InputError
from trocar.study.calibration.parameter import Specimen, of_sheets, parameters, split
from trocar.study.calibration.response import first_specimen

CASE = pad(prony=((0.5, 0.3), (0.2, 3.0)), prestress_x=100.0, prestress_y=200.0)
ALL = (
    "skin.young_modulus",
    "skin.poisson_ratio",
    "skin.thickness",
    "skin.prestress_x",
    "skin.prestress_y",
    "body.prony[0].g",
    "body.prony[1].tau",
)


def test_each_reads_and_writes_its_own_number_alone():
    specimen = Specimen(tissue=CASE.tissue)
    for one in parameters(ALL, specimen):
        value = one.get(specimen)
        low, high = one.bounds(value)
        assert low < one.free(value) < high
        assert one.value(one.free(value)) == pytest.approx(value, rel=1e-12)
        changed = one.put(specimen, 1.01 * value)
        assert one.get(changed) == 1.01 * value
        others = [other for other in parameters(ALL, specimen) if other.name != one.name]
        assert [other.get(changed) for other in others] == [other.get(specimen) for other in others]


def test_a_poisson_ratio_stays_below_a_half_and_a_prestress_writes_both():
    even = Specimen(tissue=pad(prestress_x=100.0, prestress_y=100.0).tissue)
    nu, stress = parameters(("skin.poisson_ratio", "skin.prestress"), even)
    assert nu.value(50.0) <= 0.5
    layer = stress.put(even, 70.0).tissue.layers[0]
    assert (layer.prestress_x, layer.prestress_y) == (70.0, 70.0)


def test_a_layers_name_may_hold_dots():
    assert split("no. 1.young_modulus") == ("no. 1", "young_modulus")
    assert split("no. 1.prony[0].tau") == ("no. 1", "prony[0].tau")


def test_sheets_have_a_tension_and_a_foundation():
    names = ("skin.tension", "foundation")
    specimen = first_specimen(pad(), "wave-membrane", names)
    for one in parameters(names, specimen):
        assert of_sheets(one.name)
        assert one.get(one.put(specimen, 3.0)) == 3.0
    with pytest.raises(InputError, match="parameters of sheets alone"):
        first_specimen(pad(), "wave-membrane", (*names, "skin.young_modulus"))


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ((), "at least one parameter"),
        (("skin.young_modulus",) * 2, "every parameter once"),
        (("skni.young_modulus",), "did you mean skin.young_modulus"),
        (("skin.young_modul",), "did you mean skin.young_modulus"),
        (("skin.prony[0].g",), "which has 0, got prony"),
        (("body.prony[2].g",), "which has 2"),
        (("skin.tension",), "--model wave-membrane"),
        (("skin.prestress", "skin.prestress_x"), "not both"),
    ],
)
def test_what_is_no_parameter_is_refused(names, words):
    with pytest.raises(InputError, match=words):
        parameters(names, Specimen(tissue=CASE.tissue))


def test_a_start_without_a_logarithm_is_refused():
    skin, body = CASE.tissue.layers
    tissue = replace(CASE.tissue, layers=(replace(skin, prestress_x=0.0), body))
    with pytest.raises(InputError, match="a starting value between"):
        parameters(("skin.prestress_x",), Specimen(tissue=tissue))
