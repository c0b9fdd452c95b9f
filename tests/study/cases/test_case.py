"""Case files: examples load with their numbers, every broken file is refused at the key that is wrong."""

import re
from math import pi
from pathlib import Path

import pytest

from study.cases.broken_cases import EXAMPLES
from trocar.errors import InputError
from trocar.model import Support
from trocar.study.cases.reading import Case, Sampling, Tool, load_case
from trocar.tissues import Fibre, Layer, NeoHookean, Ogden

PRESS = next(path for path in EXAMPLES if path.stem == "press")
VALID = PRESS.read_text("utf-8")
FULL = """
title = "5 N on three layers"
[block]
size_mm = [60, 50]
support = "edges+base"
[[layer]]
name = "epidermis"
thickness_mm = 0.1
young_modulus_kpa = 1000
poisson_ratio = 0.48
density_kg_m3 = 1100
prestress_kpa = [24, 9.3]
loss_factor = 0.14
loss_frequency_hz = 50
law = "linear"
[[layer]]
name = "fat"
thickness_mm = 10
young_modulus_kpa = 10
poisson_ratio = 0.48
density_kg_m3 = 900
[[tool]]
tip = "flat"
diameter_mm = 8
position_mm = [30, 20]
tilt_deg = 30
azimuth_deg = 90
peak_n = 0.5
rate_n_s = 0.05
hold_s = 2
contact = "dead"
[sampling]
period_s = 3.0
dynamic = true
"""


def write(folder: Path, text: str) -> Path:
    file = folder / "case.toml"
    file.write_text(text, "utf-8")
    return file


def refusal(file: Path) -> InputError:
    with pytest.raises(InputError) as caught:
        load_case(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: ")
    assert "\n" not in message
    return caught.value


def test_every_key_arrives_in_si(tmp_path):
    case = load_case(write(tmp_path, FULL))
    assert case.title == "5 N on three layers"
    assert case.size == (0.06, 0.05)
    assert case.support is Support.EDGES_AND_BASE
    assert case.tissue.layers[0] == Layer(
        name="epidermis",
        thickness=0.1 * 1e-3,
        young_modulus=1e6,
        poisson_ratio=0.48,
        density=1100.0,
        prestress_x=24000.0,
        prestress_y=9.3 * 1e3,
        loss_factor=0.14,
        loss_frequency=50.0,
    )
    assert case.tissue.layers[1].loss_factor == 0
    assert case.tools == (
        Tool(
            diameter=0.008,
            position=(0.03, 0.02),
            peak=0.5,
            rate=0.05,
            hold=2,
            tilt=30 * (pi / 180),
            azimuth=pi / 2,
        ),
    )
    assert case.sampling == Sampling(period=3.0, dynamic=True)


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_examples_load(file):
    case = load_case(file)
    others = {"phantom": ("skin", "body"), "phantom-hold": ("skin", "body"), "liver": ("parenchyma",)}
    assert case.tissue.layer_names == others.get(file.stem, ("epidermis", "dermis", "fat"))
    assert case.sample_times().size > 5


def test_laws_arrive_in_si():
    case = load_case(next(path for path in EXAMPLES if path.stem == "large-force"))
    laws = [layer.law for layer in case.tissue.layers]
    assert laws == [
        NeoHookean(),
        Fibre(k1=5e4, k2=5.0, dispersion=0.1, angle=40 * (pi / 180)),
        Ogden(terms=((1.0, 8.0),)),
    ]
    assert case.tissue.large_deformation


OGDEN, FIBRES = "ogden = [[1.0, 8.0]]", "fibre = { k1_kpa = 50, k2 = 5, dispersion = 0.1, angle_deg = 40 }"
LAW_CHANGES = [
    (OGDEN, "ogden = []", "layer[2].ogden", "1 to 6 pairs"),
    (OGDEN, "ogden = [1.0, 8.0]", "layer[2].ogden[0]", "a pair [share, alpha], got 1.0"),
    (OGDEN, "ogden = 8.0", "layer[2].ogden", "1 to 6 pairs"),
    (OGDEN, "ogden = [[1.0, 8.0, 2.0]]", "layer[2].ogden[0]", "a pair"),
    (OGDEN, "ogden = [[1.0, nan]]", "layer[2].ogden[0][1]", "-50 to 50, got nan"),
    (OGDEN, "ogden = [[1.0, true]]", "layer[2].ogden[0][1]", "got True"),
    (OGDEN, "ogden = [[1.0, 0.0]]", "layer[2].ogden", "either sign, got 0.0"),
    (OGDEN, "ogden = [[0.5, 8.0], [0.4, 2.0]]", "layer[2].ogden", "divide each by their sum"),
    (OGDEN, "ogden = [[1.5, 8.0], [-0.5, 2.0]]", "layer[2].ogden[0][0]", "got 1.5"),
    (OGDEN, f"ogden = [[1.0, {10**400}]]", "layer[2].ogden[0][1]", "got 1"),
    (OGDEN, 'ogden = "soft"', "layer[2].ogden", "got 'soft'"),
    (OGDEN, "", "layer[2].ogden", "got nothing"),
    (FIBRES, "", "layer[1].fibre", "got nothing"),
    (FIBRES, "fibre = 3", "layer[1].fibre", "got 3"),
    (FIBRES, "fibre = { k1_kpa = 50, k2 = 5, dispersion = 0.1 }", "layer[1].fibre.angle_deg", "got nothing"),
    (FIBRES, FIBRES.replace("k1_kpa", "k1_pa"), "layer[1].fibre.k1_pa", "did you mean k1_kpa?"),
    (FIBRES, FIBRES.replace("50", "-50"), "layer[1].fibre.k1_kpa", "got -50"),
    (FIBRES, FIBRES.replace("0.1", "0.4"), "layer[1].fibre.dispersion", "1/3 isotropic"),
    (FIBRES, FIBRES.replace("0.1", "0.33333333"), None, None),
    (FIBRES, FIBRES.replace("40", "91"), "layer[1].fibre.angle_deg", "0 to 90 deg"),
    (FIBRES, FIBRES.replace("5,", "nan,"), "layer[1].fibre.k2", "got nan"),
    ('law = "neo-hookean"', "", "layer[1].law", "expected \"linear\", as layer[0], got 'fibre'"),
    (f'law = "fibre"\n{FIBRES}', "", "layer[1].law", "got 'linear'; a block deforms little or much"),
]


@pytest.mark.parametrize(("old", "new", "where", "words"), LAW_CHANGES)
def test_a_law_is_read_as_strictly_as_the_rest(tmp_path, old, new, where, words):
    valid = next(path for path in EXAMPLES if path.stem == "large-force").read_text("utf-8")
    assert old in valid
    file = write(tmp_path, valid.replace(old, new, 1))
    if where is None:
        load_case(file)
        return
    error = refusal(file)
    assert error.where == f"{file}: {where}"
    assert words in str(error)


def test_examples_are_what_they_say():
    by_name = {file.stem: load_case(file) for file in EXAMPLES}
    assert by_name["paper-5n"].sample_times().size == 81
    assert by_name["paper-5n"].duration == 200
    assert by_name["paper-5n"].peak_force == 5
    assert by_name["dynamic"].sampling.dynamic
    assert len(by_name["pair"].tools) == 2
    assert by_name["tilted"].tools[0].tilt == pytest.approx(pi / 6, rel=1e-15)  # one rounding
    assert by_name["press"].peak_force == 0.1


CHANGES = [
    # change the valid text from, to, key that must be named, words that must be in the message
    ("thickness_mm = 10\n", "thickness_mm = -1\n", "layer[2].thickness_mm", "0.001 to 1000 mm, got -1"),
    ("thickness_mm = 10\n", "thickness_mm = 0\n", "layer[2].thickness_mm", "got 0"),
    ("thickness_mm = 10\n", "thickness_mm = 1e300\n", "layer[2].thickness_mm", "1e+300"),
    ("thickness_mm = 10\n", "thickness_mm = 1e-300\n", "layer[2].thickness_mm", "1e-300"),
    ("thickness_mm = 10\n", "thickness_mm = 999\n", "layer[2].thickness_mm", "times the shorter side"),
    ("thickness_mm = 0.1\n", "thickness_mm = 0.001\n", None, None),
    ("thickness_mm = 0.1\n", "thickness_mm = 0.0005\n", "layer[0].thickness_mm", "0.001"),
    ("thickness_mm = 10\n", "thickness_mm = true\n", "layer[2].thickness_mm", "got True"),
    ("thickness_mm = 10\n", 'thickness_mm = "10"\n', "layer[2].thickness_mm", "got '10'"),
    ("thickness_mm = 10\n", "thickness_mm = [10]\n", "layer[2].thickness_mm", "a number"),
    ("thickness_mm = 10\n", "thickness_mm = 2024-01-01\n", "layer[2].thickness_mm", "a number"),
    ("thickness_mm = 10\n", f"thickness_mm = {10**400}\n", "layer[2].thickness_mm", "a number"),
    ("thickness_mm = 10\n", f"thickness_mm = 0x{'f' * 6000}\n",
     "layer[2].thickness_mm", "too large"),
    ("thickness_mm = 10\n", "", "layer[2].thickness_mm", "got nothing"),
    ("thickness_mm = 10\n", "thicknes_mm = 10\n", "layer[2].thicknes_mm", "did you mean thickness_mm?"),
    ("young_modulus_kpa = 20\n", "young_modulus_kpa = nan\n", "layer[2].young_modulus_kpa", "got nan"),
    ("young_modulus_kpa = 20\n", "young_modulus_kpa = inf\n", "layer[2].young_modulus_kpa", "got inf"),
    ("young_modulus_kpa = 20\n", "young_modulus_kpa = 1e-3\nprestress_kpa = [1e6, 0]\n",
     "layer[2].young_modulus_kpa", "precision"),
    ("poisson_ratio = 0.48\n", "poisson_ratio = 0.5\n", "layer[0].poisson_ratio", "below 0.5"),
    ("poisson_ratio = 0.48\n", "poisson_ratio = -0.1\n", "layer[0].poisson_ratio", "got -0.1"),
    ("density_kg_m3 = 920\n", "density_kg_m3 = 0.018\n", "layer[2].density_kg_m3", "got 0.018"),
    ('name = "fat"', 'name = "dermis"', "layer[2].name", "every layer's name once"),
    ('name = "fat"', 'name = ""', "layer[2].name", "printable text"),
    ('name = "fat"', 'name = "a\\nb"', "layer[2].name", "one line"),
    ('name = "fat"', "name = 3", "layer[2].name", "got 3"),
    ('name = "fat"', 'name = "fat"\nloss_factor = 0.1', "layer[2].loss_frequency_hz", "both or neither"),
    ('name = "fat"', 'name = "fat"\nloss_frequency_hz = 50', "layer[2].loss_factor", "both or neither"),
    ('name = "fat"', 'name = "fat"\nprestress_kpa = [1]', "layer[2].prestress_kpa", "two numbers"),
    ('name = "fat"', 'name = "fat"\nprestress_kpa = 1', "layer[2].prestress_kpa", "two numbers"),
    ('name = "fat"', 'name = "fat"\nprestress_kpa = [1, -1]', "layer[2].prestress_kpa[1]", "got -1"),
    ('name = "fat"', 'name = "fat"\nprony = [[0.5, 1], [0, 2]]', None, None),
    ('name = "fat"', 'name = "fat"\nprony = []', None, None),
    ('name = "fat"', 'name = "fat"\nprony = 0.5', "layer[2].prony", "a list of at most 8 pairs"),
    ('name = "fat"', 'name = "fat"\nprony = [0.5, 1]', "layer[2].prony[0]", "a pair [a number from 0 to 1000"),
    ('name = "fat"', 'name = "fat"\nprony = [[0.5, 1, 2]]', "layer[2].prony[0]", "got [0.5, 1, 2]"),
    ('name = "fat"', 'name = "fat"\nprony = [[-0.5, 1]]', "layer[2].prony[0][0]", "long-term modulus"),
    ('name = "fat"', 'name = "fat"\nprony = [["a", 1]]', "layer[2].prony[0][0]", "got 'a'"),
    ('name = "fat"', 'name = "fat"\nprony = [[nan, 1]]', "layer[2].prony[0][0]", "got nan"),
    ('name = "fat"', 'name = "fat"\nprony = [[0.5, 1], [0.5, 0]]', "layer[2].prony[1][1]", "1e-05 to 100000 s"),
    ('name = "fat"', 'name = "fat"\nprony = [[0.5, 1], [0.5, inf]]', "layer[2].prony[1][1]", "got inf"),
    ('name = "fat"', 'name = "fat"\nprony = [[0.5, 1], [0.2, 1.0]]', "layer[2].prony", "every tau once"),
    ('name = "fat"', f'name = "fat"\nprony = {[[0.1, t] for t in range(1, 10)]}', "layer[2].prony", "at most 8"),
    ('name = "dermis"', f'name = "dermis"\nprony = {[[0.1, t] for t in range(1, 9)]}', None, None),
    ('name = "fat"', 'name = "fat"\nlaw = "neo-hookean"', "layer[2].law", 'expected "linear", as layer[0], got'),
    ('name = "fat"', 'name = "fat"\nlaw = "ogden"', "layer[2].ogden", "1 to 6 pairs [share, alpha], got nothing"),
    ('name = "fat"', 'name = "fat"\nlaw = "fibre"', "layer[2].fibre", "got nothing"),
    ('name = "fat"', 'name = "fat"\nogden = [[1.0, 2.0]]', "layer[2].ogden", 'only beside law = "ogden"'),
    ('name = "fat"', 'name = "fat"\nfibre = {}', "layer[2].fibre", 'only beside law = "fibre"'),
    ('name = "fat"', 'name = "fat"\nlaw = "liner"', "layer[2].law", 'did you mean "linear"?'),
    ('contact = "dead"', 'contact = "rigid"', None, None),
    ('contact = "dead"', 'contact = "ridgid"', "tool[0].contact", 'did you mean "rigid"?'),
    ('tip = "flat"', 'tip = "sphere"', "tool[0].contact", '"rigid" for a sphere'),
    ('tip = "flat"', 'tip = "cone"', "tool[0].tip", '"flat" or "sphere"'),
    ("[30, 30]", "[3, 30]", "tool[0].position_mm", "x from 4 to 56 mm, got 3"),
    ("[30, 30]", "[30, 56.1]", "tool[0].position_mm", "y from 4 to 56 mm, got 56.1"),
    ("[30, 30]", "[56, 4]", None, None),
    ("[30, 30]", "[-1e300, 30]", "tool[0].position_mm[0]", "-1e+300"),
    ("[30, 30]", "[30, nan]", "tool[0].position_mm[1]", "nan"),
    ("[30, 30]", "[30, 30, 30]", "tool[0].position_mm", "two numbers"),
    ("[30, 30]", '["a", 30]', "tool[0].position_mm[0]", "got 'a'"),
    ("diameter_mm = 8", "diameter_mm = 61", "tool[0].position_mm", "than the block (60 mm along x), got 61"),
    ("diameter_mm = 8", "diameter_mm = 0", "tool[0].diameter_mm", "got 0"),
    ("diameter_mm = 8", "diameter_mm = 0.02", "tool[0].diameter_mm", "longer side"),
    ("tilt_deg = 0", "tilt_deg = 90", "tool[0].tilt_deg", "below 90 deg"),
    ("tilt_deg = 0", "tilt_deg = 89.99999999999999", "tool[0].position_mm", "no longer than the block"),
    ("tilt_deg = 0", "tilt_deg = 83", "tool[0].position_mm", "got 65.644"),
    ("tilt_deg = 0", "tilt_deg = -1", "tool[0].tilt_deg", "azimuth_deg"),
    ("azimuth_deg = 0", "azimuth_deg = 400", "tool[0].azimuth_deg", "-360 to 360"),
    ("peak_n = 0.1", "peak_n = 0", "tool[0].peak_n", "got 0"),
    ("peak_n = 0.1", "peak_n = -5", "tool[0].peak_n", "got -5"),
    ("rate_n_s = 0.05", "rate_n_s = 0", "tool[0].rate_n_s", "got 0"),
    ("rate_n_s = 0.05", "rate_n_s = 1e9", "tool[0].rate_n_s", "reaches the peak"),
    ("rate_n_s = 0.05", "rate_n_s = 1e-9", "tool[0].rate_n_s", "reaches the peak"),
    ("hold_s = 0", "hold_s = -1", "tool[0].hold_s", "got -1"),
    ("period_s = 0.5", "period_s = 0", "sampling.period_s", "got 0"),
    ("period_s = 0.5", "period_s = -2", "sampling.period_s", "got -2"),
    ("period_s = 0.5", "period_s = 1e-5", "sampling.period_s", "period of at least 4e-05 s"),
    ("dynamic = false", "dynamic = 0", "sampling.dynamic", "true or false"),
    ("dynamic = false", 'dynamic = "no"', "sampling.dynamic", "true or false"),
    ("size_mm = [60, 60]", "size_mm = [60]", "block.size_mm", "two numbers"),
    ("size_mm = [60, 60]", "size_mm = [60, 0.9]", "block.size_mm[1]", "1 to 1000 mm"),
    ("size_mm = [60, 60]", "size_mm = [1001, 60]", "block.size_mm[0]", "1 to 1000 mm"),
    ("size_mm = [60, 60]", "size_mm = [true, 60]", "block.size_mm[0]", "got True"),
    ('support = "base"', 'support = "bass"', "block.support", 'did you mean "base"?'),
    ('support = "base"', "support = []", "block.support", "edges+base"),
    ('support = "base"\n', "", "block.support", "got nothing"),
    ("[block]", "[blok]", "blok", "did you mean block?"),
    ("[block]\n", "block = 3\n[x]\n", "x", "only the keys"),
    ("[sampling]", "[sampling.x]", "sampling.x", "only the keys period_s, dynamic"),
    ('title = "0.1 N on skin-like layers"', "", "title", "got nothing"),
    ('title = "0.1 N on skin-like layers"', 'title = "x"\n"\\u0000" = 1', "'\\x00'", "only the keys"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "key", "words"), CHANGES, ids=lambda value: str(value)[:30])
def test_one_change_is_refused_at_its_key(tmp_path, old, new, key, words):
    assert old in VALID
    file = write(tmp_path, VALID.replace(old, new, 1))
    if key is None:
        assert isinstance(load_case(file), Case)
        return
    error = refusal(file)
    assert error.where == f"{file}: {key}"
    assert words in str(error)


@pytest.mark.parametrize(
    ("pattern", "key"),
    [
        (r"\[block\]\n(?:.+\n)+", "block"),
        (r"\[sampling\]\n(?:.+\n)+", "sampling"),
        (r"\[\[tool\]\]\n(?:.+\n)+", "tool"),
    ],
)
def test_missing_table_is_named(tmp_path, pattern, key):
    file = write(tmp_path, re.sub(pattern, "", VALID))
    assert refusal(file).where == f"{file}: {key}"


def test_missing_layers_are_named(tmp_path):
    file = write(tmp_path, re.sub(r"\[\[layer\]\]\n(?:.+\n)+", "", VALID))
    assert refusal(file).where == f"{file}: layer"


@pytest.mark.parametrize("value", ["3", '"a"', "[]", "[1]", "{}"])
def test_layer_must_be_tables(tmp_path, value):
    text = re.sub(r"\[\[layer\]\]\n(?:.+\n)+", "", VALID).replace("[block]", f"layer = {value}\n[block]")
    assert refusal(write(tmp_path, text)).where.endswith(": layer")


def test_three_tools_are_refused(tmp_path):
    tool = re.search(r"\[\[tool\]\]\n(?:.+\n)+", VALID).group()
    file = write(tmp_path, VALID + "\n" + tool * 2)
    assert "1 to 2 tables [[tool]], got 3" in str(refusal(file))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "an empty file"),
        (b" \n\n", "an empty file"),
        (b"\xff\xfe\x00", "UTF-8"),
        (b"title = '\xe9'", "line 1"),
        (b"title = 'a'\nblock = [", "line 2"),
        (b"title = \n", "line 1"),
        (b"a = 1\na = 2", "line 2"),
        (b"a = " + b"[" * 5000, "nested too deep"),
        (b"a = " + b"9" * 5000, "4300"),
        (b"#" * 1_000_001, "1000000 bytes"),
        (bytes(range(256)), "UTF-8"),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_unreadable_content_is_refused(tmp_path, content, words):
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    assert words in str(refusal(file))


def test_missing_file_folder_and_impossible_path(tmp_path):
    assert "No such file" in str(refusal(tmp_path / "none.toml"))
    assert "a directory" in str(refusal(tmp_path))
    with pytest.raises(InputError, match="null byte"):
        load_case("a\0b")
    with pytest.raises(InputError, match="not a regular file"):
        load_case("/dev/null")


def test_byte_order_mark_and_windows_lines_are_read(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + VALID.replace("\n", "\r\n").encode())
    assert load_case(file) == load_case(PRESS)
