from math import pi
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from trocar.errors import InputError
from trocar.tissues.law import LINEAR, Fibre, Law, NeoHookean, Ogden
from trocar.tissues.quantity import LAYER_QUANTITIES, Quantity
from trocar.tissues.reading import parse_tissue, read_tissue
from trocar.tissues.record import Status

HEAD = 'title = "Test"\nwhy = "For a test."\n'
METHOD = '{ setting = "choice", technique = "made up" }'
ORIGIN = f'status = "read"\nsource = "here"\nmethod = {METHOD}'
VALUES = {
    "thickness": (1.0, "mm"),
    "young_modulus": (10.0, "kPa"),
    "poisson_ratio": (0.4, "1"),
    "density": (1.1, "g/cm3"),
}


def entry(key: str, number: str, unit: str, /, **changes: str | None) -> str:
    fields = {
        "value": number,
        "spread": '"none"',
        "unit": f'"{unit}"',
        "status": '"chosen"',
        "reason": '"a test"',
        "source": '"here"',
        "method": METHOD,
    }
    lines = [f"{name} = {text}" for name, text in {**fields, **changes}.items() if text is not None]
    return "\n".join([f"[layer.{key}]", *lines])


def layer(name: str = "gel", extra: str = "", **replaced: str) -> str:
    entries = {key: entry(key, str(value), unit) for key, (value, unit) in VALUES.items()}
    return "\n".join([f'[[layer]]\nname = "{name}"', *{**entries, **replaced}.values(), extra, ""])


def law(name: str, numbers: str = "") -> str:
    return f"[layer.law]\nlaw = {name}\n{numbers}\n{ORIGIN}\n"


def memory(numbers: str) -> str:
    return f"[layer.memory]\n{numbers}\n{ORIGIN}\n"


def parse(text: str) -> Any:
    return parse_tissue(text, file="mine.toml", name="mine")


def test_a_minimal_file_is_read_and_converted() -> None:
    (gel,) = parse(HEAD + layer()).tissue().layers
    # tolerance: rounding of the conversion
    assert gel.thickness == pytest.approx(1e-3, rel=1e-14)
    assert gel.young_modulus == pytest.approx(1e4, rel=1e-14)
    assert gel.density == pytest.approx(1100.0, rel=1e-14)
    assert (gel.prestress_x, gel.loss_factor) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("name", "numbers", "found"),
    [
        ('"linear"', "", LINEAR),
        ('"neo-hookean"', "", NeoHookean()),
        ('"ogden"', "ogden = [[0.25, 2], [0.75, -4.5]]", Ogden(terms=((0.25, 2.0), (0.75, -4.5)))),
        (
            '"fibre"',
            "fibre = { k1_kpa = 3, k2 = 5, dispersion = 0.25, angle_deg = 90 }",
            Fibre(k1=3e3, k2=5.0, dispersion=0.25, angle=pi / 2),
        ),
    ],
)
def test_a_layer_states_a_law(name: str, numbers: str, found: Law) -> None:
    record = parse(HEAD + layer(extra=law(name, numbers)))
    assert record.tissue().layers[0].law == found
    assert [item.title for item in record.stated][-1] == "law"
    stated = record.as_dict()["layers"][0]["properties"]["law"]
    assert (stated["law"], stated["source"]) == (name.strip('"'), "here")
    again = numbers.partition(" = ")[0]
    assert set(stated) - {"source", "method", "status", "reason", "also"} == {"law", again} - {""}


def test_a_layer_states_what_it_remembers() -> None:
    record = parse(HEAD + layer("top", memory("prony = [[0.5, 0.01], [2, 3]]")) + layer("below"))
    top, below = record.tissue().layers
    assert (top.prony, below.prony) == (((0.5, 0.01), (2.0, 3.0)), ())
    assert record.layers[0].memory.value_text == "g 0.5 over 0.01 s, g 2 over 3 s"
    assert record.count(Status.READ) == 1


@pytest.mark.parametrize(
    ("value", "unit", "metres"), [("500", "um", 5e-4), ("0.5", "mm", 5e-4), ("0.0005", "m", 5e-4)]
)
def test_units_convert(value: str, unit: str, metres: float) -> None:
    record = parse(HEAD + layer(thickness=entry("thickness", value, unit)))
    assert record.layers[0]["thickness"].si == pytest.approx(metres, rel=1e-14)  # tolerance: rounding


@pytest.mark.parametrize(
    ("text", "spread", "words"),
    [('"none"', None, ""), ("0.2", 0.2, "± 0.2"), ("[0.5, 2]", (0.5, 2.0), "0.5 to 2")],
)
def test_a_spread_is_a_deviation_a_range_or_none(text: str, spread: object, words: str) -> None:
    record = parse(HEAD + layer(thickness=entry("thickness", "1", "mm", spread=text)))
    assert record.layers[0]["thickness"].spread == spread
    assert record.layers[0]["thickness"].spread_text == words


def thickness(**changes: str | None) -> str:
    return HEAD + layer(thickness=entry("thickness", "1", "mm", **changes))


BROKEN = {
    "not toml": ("title = ", "mine.toml: expected a TOML file"),
    "an integer too long": (f"title = {'9' * 5000}", "a TOML file"),
    "no title": (layer(), "title: expected a text, got nothing; add the key"),
    "blank title": ('title = " "\nwhy = "x"\n' + layer(), "title: expected a text"),
    "no why": ('title = "x"\n' + layer(), "why: expected a text"),
    "no layer": (HEAD, r"layer: expected 1 to 50 tables \[\[layer\]\], got nothing"),
    "layer is a number": (HEAD + "layer = 3", r"layer: expected 1 to 50 tables \[\[layer\]\]"),
    "unknown top key": (HEAD + 'colour = "red"\n' + layer(), "colour: expected only the keys title, why"),
    "unknown layer key": (
        HEAD + layer(extra="[layer.colour]\nvalue = 1"),
        r"layer 'gel'\.colour: expected only the keys name, thickness",
    ),
    "unknown property key": (thickness(colour="1"), r"layer 'gel'\.thickness\.colour"),
    "unknown method key": (
        thickness(method='{ setting = "choice", technique = "x", who = "me" }'),
        r"thickness\.method\.who",
    ),
    "layer without a name": (HEAD + layer().replace('name = "gel"', ""), r"layer\[0\]\.name"),
    "two layers of one name": (HEAD + layer() + layer(), r"layer: expected every name once"),
    "missing property": (HEAD + layer(density=""), r"layer 'gel'\.density: expected a table"),
    "property is a number": (
        HEAD + layer(density="").replace('"gel"', '"gel"\ndensity = 3'),
        r"density: expected a table \[density\], got 3",
    ),
    "no value": (thickness(value=None), r"thickness\.value"),
    "value is a text": (thickness(value='"1"'), r"thickness\.value: expected a finite number, got '1'"),
    "value is a truth": (thickness(value="true"), r"value: expected a finite number, got True"),
    "value is not a number": (thickness(value="nan"), r"value: expected a finite number, got nan"),
    "value is infinite": (thickness(value="inf"), r"value: expected a finite number, got inf"),
    "value is beyond floats": (thickness(value="1" + "0" * 400), r"value: expected a finite number"),
    "value is beyond printing": (thickness(value="0x" + "f" * 9000), "got a int too large to print"),
    "negative thickness": (
        thickness(value="-1"),
        r"value: expected a finite number from 1e-06 to 1 m, got -1",
    ),
    "zero thickness": (thickness(value="0"), r"thickness\.value"),
    "poisson's ratio of a half": (
        HEAD + layer(poisson_ratio=entry("poisson_ratio", "0.5", "1")),
        r"poisson_ratio\.value: expected a finite number from 0 to 0\.4999",
    ),
    "lighter than air": (
        HEAD + layer(density=entry("density", "0.018", "kg/m3")),
        r"density\.value: .* is the unit right\?",
    ),
    "unit of another quantity": (
        thickness(unit='"kPa"'),
        r"thickness\.unit: expected .um. or .mm. or .m., got 'kPa'",
    ),
    "no unit": (thickness(unit=None), r"thickness\.unit: .* got nothing"),
    "no spread": (thickness(spread=None), r"thickness\.spread: .* got nothing"),
    "spread of zero": (thickness(spread="0"), r"thickness\.spread"),
    "spread below zero": (thickness(spread="-1"), r"thickness\.spread"),
    "spread not a number": (thickness(spread="nan"), r"thickness\.spread"),
    "spread the wrong way round": (thickness(spread="[2, 0.5]"), r"thickness\.spread"),
    "value outside its spread": (thickness(spread="[2, 3]"), r"thickness\.spread: .* around the value"),
    "spread of three": (thickness(spread="[0, 1, 2]"), r"thickness\.spread"),
    "spread in words": (thickness(spread='"some"'), r"thickness\.spread: .* got 'some'"),
    "unknown status": (
        thickness(status='"guessed"'),
        r"thickness\.status: expected .read. or .derived.",
    ),
    "no status": (thickness(status=None), r"thickness\.status: .* got nothing"),
    "no source": (thickness(source=None), r"thickness\.source"),
    "no method": (thickness(method=None), r"thickness\.method: .* got nothing"),
    "unknown setting": (thickness(method='{ setting = "dream", technique = "x" }'), r"method\.setting"),
    "no technique": (thickness(method='{ setting = "choice" }'), r"method\.technique"),
    "choice without a reason": (thickness(reason=None), r"thickness\.reason: .* got nothing"),
    "rivals not in a list": (thickness(also='"x"'), r"thickness\.also: expected a list of texts"),
    "prestress along one axis": (
        HEAD + layer(extra=entry("prestress_x", "10", "kPa")),
        r"layer 'gel'\.prestress_y: expected a table \[prestress_y\], because prestress_x is stated",
    ),
    "a frequency of nothing": (
        HEAD + layer(extra=entry("loss_frequency", "50", "Hz")),
        r"loss_factor: expected a table \[loss_factor\], because loss_frequency is stated",
    ),
    "a law nobody knows": (HEAD + layer(extra=law('"jelly"')), r"layer 'gel'\.law\.law: expected"),
    "a law without its numbers": (HEAD + layer(extra=law('"ogden"')), r"law\.ogden: expected 1 to 6 pairs"),
    "another law's numbers": (
        HEAD + layer(extra=law('"ogden"', "ogden = [[1, 3]]\nfibre = {}")),
        r"law\.fibre: expected this key only beside",
    ),
    "shares that do not add up": (
        HEAD + layer(extra=law('"ogden"', "ogden = [[0.5, 3]]")),
        r"law\.ogden: expected shares that add up to 1",
    ),
    "a law without a source": (
        HEAD + layer(extra='[layer.law]\nlaw = "neo-hookean"'),
        r"law\.status: .* got nothing",
    ),
    "a linear layer below one that is not": (
        HEAD + layer("gel", law('"neo-hookean"')) + layer("bed"),
        r"layer: expected tissue 'mine': law: every layer linear or none",
    ),
    "memory without terms": (HEAD + layer(extra=memory("")), r"layer 'gel'\.memory\.prony: .* got nothing"),
    "one time twice": (
        HEAD + layer(extra=memory("prony = [[1, 2], [3, 2]]")),
        r"prony: expected every tau once",
    ),
    "a weight below zero": (
        HEAD + layer(extra=memory("prony = [[-1, 2]]")),
        r"prony\[0\]\[0\]: expected a number",
    ),
    "more times than a tissue may have": (
        HEAD
        + "".join(
            layer(f"gel {k}", memory(f"prony = {[[1, 0.1 * (5 * k + j + 1)] for j in range(5)]}"))
            for k in (0, 1)
        ),
        r"layer: expected tissue 'mine': prony: at most 8 different times",
    ),
    "memory of the paper's formula": (
        HEAD + 'usable = "paper formula only"\ninstead = "skin"\n' + layer(extra=memory("prony = [[1, 2]]")),
        r"layer 'gel'\.\w+: expected only the keys name, side",
    ),
    "unknown usability": (HEAD + 'usable = "never"\n' + layer(), "usable: expected .every model. or"),
    "restricted without advice": (
        HEAD + 'usable = "paper formula only"\n' + layer(),
        "instead: expected a text",
    ),
}


@pytest.mark.parametrize(("text", "message"), BROKEN.values(), ids=BROKEN.keys())
def test_a_broken_file_is_refused_with_file_key_and_value(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        parse(text)
    assert caught.value.where.startswith("mine.toml")


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.toml: expected a tissue file that can be read"):
        read_tissue(tmp_path / "none.toml")


def test_a_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="text in UTF-8"):
        read_tissue(tmp_path / "bytes.toml")


def test_a_file_gives_the_tissue_its_name(tmp_path: Path) -> None:
    (tmp_path / "my pad.toml").write_text(HEAD + layer(), encoding="utf-8")
    assert read_tissue(tmp_path / "my pad.toml").tissue().name == "my pad"


def _numbers(quantity: Quantity) -> st.SearchStrategy[float]:
    return st.floats(quantity.low, quantity.high)


@seed(2014)
@settings(max_examples=100, deadline=None, database=None)
@given(st.fixed_dictionaries({key: _numbers(quantity) for key, quantity in LAYER_QUANTITIES.items()}))
def test_whatever_the_reader_accepts_is_a_layer(values: dict[str, float]) -> None:
    entries = {key: entry(key, repr(value), LAYER_QUANTITIES[key].si_unit) for key, value in values.items()}
    (made,) = parse(HEAD + layer(**entries)).tissue().layers
    assert {key: getattr(made, key) for key in values} == values


JUNK = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**30), 10**30),
    st.floats(),
    st.text('aπ"\\\n# ', max_size=6),
    st.lists(st.integers(-3, 3), max_size=3),
)


@seed(2014)
@settings(max_examples=200, deadline=None, database=None)
@given(
    key=st.sampled_from(["value", "spread", "unit", "status", "source", "method", "reason", "new"]), junk=JUNK
)
def test_junk_in_any_key_is_refused_or_read_never_a_crash(key: str, junk: object) -> None:
    text = thickness(**{key: _toml(junk)})
    try:
        record = parse(text)
    except InputError as refused:
        assert refused.where.startswith("mine.toml: layer 'gel'.thickness")  # noqa: PT017 - either outcome
    else:
        assert record.layers[0]["thickness"].status is Status.CHOSEN
        assert 1e-6 <= record.layers[0]["thickness"].si <= 1.0


def _toml(junk: object) -> str | None:
    if isinstance(junk, bool):
        return str(junk).lower()
    if isinstance(junk, str):
        escaped = junk.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    return None if junk is None else str(junk)
