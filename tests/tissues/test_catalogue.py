from dataclasses import replace
from importlib.resources import files
from math import hypot, inf, isfinite, log10, pi, sin, sqrt, tan
from pathlib import Path

import pytest

import trocar
from trocar.errors import InputError
from trocar.tissues import catalogue
from trocar.tissues.catalogue import tissue
from trocar.tissues.reading import parse_tissue
from trocar.tissues.record import Setting, Status, TissueRecord, Usable

NAMES = ("liver", "silicone-pad", "skin", "skin-paper-2014", "stomach-wall", "uterus")
USABLE = tuple(name for name in NAMES if name != catalogue.PAPER_PRESET)


@pytest.fixture(params=NAMES)
def record(request: pytest.FixtureRequest) -> TissueRecord:
    return catalogue.record(request.param)


def test_the_presets_are_these() -> None:
    assert catalogue.names() == NAMES


@pytest.mark.parametrize("name", USABLE)
def test_every_usable_preset_is_a_tissue(name: str) -> None:
    tissue = trocar.tissue(name)
    assert tissue.name == name
    assert tissue.layer_names == tuple(layer.name for layer in catalogue.record(name).layers)
    assert 1e-3 < tissue.thickness < 0.1


def test_every_value_says_where_it_comes_from(record: TissueRecord) -> None:
    assert len(record.why) > 200  # an argument, not a remark
    for item in record.stated:
        assert item.source
        assert item.method.technique
        assert item.status in Status
        assert item.reason or item.status in (Status.READ, Status.REMEMBERED)


def test_only_choices_are_marked_as_chosen(record: TissueRecord) -> None:
    for item in record.stated:
        assert (item.method.setting is Setting.CHOICE) == (item.status is Status.CHOSEN), item


def test_only_the_paper_preset_is_printed(record: TissueRecord) -> None:
    printed = all(item.method.setting is Setting.PRINTED for item in record.stated)
    assert printed == (record.usable is Usable.PAPER) == (record.name == catalogue.PAPER_PRESET)


def test_skin_in_si() -> None:
    epidermis, dermis, fat = trocar.tissue("skin").layers
    # tolerance: rounding of the conversion from the written unit
    assert epidermis.thickness == pytest.approx(1e-4, rel=1e-14)
    assert epidermis.young_modulus == pytest.approx(1e6, rel=1e-14)
    assert dermis.thickness == pytest.approx(1.5e-3, rel=1e-14)
    assert dermis.young_modulus == pytest.approx(129e3, rel=1e-14)
    assert dermis.prestress_x == dermis.prestress_y == pytest.approx(13.5e3, rel=1e-14)
    assert dermis.tensile_strength == pytest.approx(21.6e6, rel=1e-14)
    assert fat.thickness == pytest.approx(12e-3, rel=1e-14)
    assert fat.young_modulus == pytest.approx(2226.0, rel=1e-14)
    assert (epidermis.density, dermis.density, fat.density) == (1100.0, 1100.0, 923.0)
    assert {layer.poisson_ratio for layer in (epidermis, dermis, fat)} == {0.48}
    assert (epidermis.loss_factor, dermis.loss_factor, fat.loss_factor) == (0.14, 0.14, 0.3)
    assert epidermis.tensile_strength == inf  # unknown


def test_derived_values_follow_from_what_was_read() -> None:
    # Each tolerance is half a unit of the last digit the preset writes.
    def written(tissue: str, layer: str, key: str) -> float:
        return catalogue.record(tissue).layer(layer)[key].value

    assert written("skin", "fat", "young_modulus") == pytest.approx(2.96 * 0.752, abs=5e-4)
    for layer, shear in (("muscularis", 5.69), ("submucosa", 3.04), ("mucosa", 0.56)):
        assert written("stomach-wall", layer, "young_modulus") == pytest.approx(2.96 * shear, abs=0.05)
    assert written("silicone-pad", "skin", "young_modulus") == pytest.approx(
        2.98 * (32.2 + 31.4) / 2, abs=0.5
    )
    assert written("silicone-pad", "body", "young_modulus") == pytest.approx(
        2.98 * (2.11 + 1.99) / 2, abs=0.05
    )
    assert written("liver", "capsule", "tensile_strength") == pytest.approx(0.3 / 0.05, abs=0.5)
    assert written("uterus", "myometrium", "tensile_strength") == pytest.approx(80 * 6.894757, abs=0.5)
    assert written("uterus", "myometrium", "loss_factor") == pytest.approx(
        tan(log10(3) / 3 * pi / 2), abs=0.005
    )
    dashpot = 2j * pi * 50 * 7.3e-3  # [kPa]
    modulus = 1.16 + 1.97 * dashpot / (1.97 + dashpot)
    assert written("liver", "parenchyma", "loss_factor") == pytest.approx(
        modulus.imag / modulus.real, abs=0.005
    )
    power = 0.484 * complex(sqrt(1 - sin(0.503) ** 2), sin(0.503))
    ratio = power.imag / (1 + power.real)
    assert written("silicone-pad", "skin", "loss_factor") == pytest.approx(ratio, abs=0.005)


def test_the_reason_for_matching_damping_at_50_hz() -> None:
    epidermis, dermis, fat = trocar.tissue("skin").layers
    spring = fat.young_modulus / fat.thickness
    mass = epidermis.thickness * epidermis.density + dermis.thickness * dermis.density
    assert sqrt(spring / mass) / (2 * pi) == pytest.approx(52, abs=0.5)  # as quoted, in Hz
    matched_at_1_hz = dermis.loss_factor / (2 * pi)
    assert 1 / (pi * matched_at_1_hz) == pytest.approx(14, abs=0.5)  # as quoted, in Hz


def test_the_paper_preset_is_refused_with_advice() -> None:
    with pytest.raises(InputError, match=r"skin-paper-2014.*own formula.*paper-2014.*take 'skin' instead"):
        trocar.tissue("skin-paper-2014")


def test_the_paper_table_is_as_printed() -> None:
    table = catalogue.paper_table()
    assert {key: (item.value, item.unit) for key, item in table.items()} == {
        "side": (60.0, "mm"),
        "area": (3600.0, "mm2"),
        "thickness": (1.0, "mm"),
        "volume": (3600.0, "mm3"),
        "weight_per_area": (1.8e-8, "g/mm2"),
        "weight": (6.48e-5, "g"),
        "density": (18.0, "g/m3"),
        "density_per_mm3": (1.8e-8, "g/mm3"),
        "prestress_along": (0.024, "MPa"),
        "prestress_across": (0.0093, "MPa"),
        "prestress": (2.57e-2, "MPa"),
        "tension": (1.54e-3, "N/m"),
    }


def test_what_the_docs_say_is_wrong_with_the_paper_table() -> None:
    table = catalogue.paper_table()
    density = trocar.tissue("skin").layers[1].density
    along, across = table["prestress_along"].si, table["prestress_across"].si
    assert table["density"].si == pytest.approx(0.018, rel=1e-14)  # tolerance: rounding
    assert density / table["density"].si == pytest.approx(61e3, rel=0.005)  # two digits are quoted
    assert hypot(along, across) == pytest.approx(table["prestress"].si, abs=0.5e2)  # three digits are printed
    assert table["prestress"].si * table["side"].si == pytest.approx(1542, abs=0.5)  # as quoted
    assert table["prestress"].si * table["thickness"].si == pytest.approx(25.7, abs=0.05)  # as quoted
    assert sqrt(along / density) == pytest.approx(4.67, abs=0.005)  # as quoted
    assert sqrt(across / density) == pytest.approx(2.91, abs=0.005)  # as quoted


@pytest.mark.parametrize(
    ("asked", "close"), [("skn", "skin"), ("Liver", "liver"), ("stomach", "stomach-wall")]
)
def test_an_unknown_name_is_refused_with_the_closest(asked: str, close: str) -> None:
    with pytest.raises(InputError, match=f"did you mean .*{close}"):
        trocar.tissue(asked)


def test_a_name_like_none_is_refused_with_the_list() -> None:
    with pytest.raises(
        InputError, match=r"one of liver, .*uterus, got 'zzzz'; a tissue file ends with .toml$"
    ):
        catalogue.record("zzzz")


def test_a_record_becomes_plain_values(record: TissueRecord) -> None:
    plain = record.as_dict()
    assert [layer["name"] for layer in plain["layers"]] == [layer.name for layer in record.layers]
    values = [item for layer in plain["layers"] for item in layer["properties"].values()]
    assert len(values) == sum(record.count(status) for status in Status)
    assert all(isfinite(item["si_value"]) and item["si_unit"] for item in values)


def test_a_file_is_taken_wherever_a_preset_is(tmp_path: Path) -> None:
    text = (files("trocar.tissues") / "presets" / "liver.toml").read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    assert tissue(str(path)) == replace(tissue("liver"), name="mine")
    path.write_text(text.replace("kg/m3", "kg/m2"), encoding="utf-8")
    with pytest.raises(InputError, match=r"mine\.toml: layer .*density\.unit"):  # read anew, not remembered
        tissue(str(path))
    with pytest.raises(InputError, match=r"there\.toml: expected a tissue file that can be read"):
        tissue(str(tmp_path / "not" / "there.toml"))


def test_the_tissue_of_the_how_to_is_one() -> None:
    page = (Path(__file__).parents[2] / "docs/how-to/bring-your-own-tissue.md").read_text(encoding="utf-8")
    first, more = (part.split("```", 1)[0] for part in page.split("```toml\n")[1:])
    found = parse_tissue(first, file="my-liver.toml", name="my-liver").tissue()
    assert found.layer_names == ("capsule", "parenchyma")
    assert found.thickness == pytest.approx(0.0301)
    creeps = parse_tissue(first + more, file="my-liver.toml", name="my-liver").tissue()
    assert creeps.layers[1].prony == ((0.6, 0.05), (0.4, 2.0))
    assert replace(creeps.layers[1], prony=()) == found.layers[1]
