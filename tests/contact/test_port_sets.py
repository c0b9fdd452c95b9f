"""Port sets by name and by file: what works, and what each mistake is answered with."""

from pathlib import Path

import numpy as np
import pytest

from trocar.contact.instrument import TipKind, default_instruments
from trocar.contact.port_sets import PORT_SETS, instruments_over, instruments_through
from trocar.errors import InputError

SIZE = (0.06, 0.05)
GOOD = """
[left]
port_mm = [-50, -10, 100]
tip = "grasper"
[right]
port_mm = [110, -10, 90]
tip = "hook"
shaft_diameter_mm = 10
length_mm = 330
"""


def file(tmp_path, text):
    path = tmp_path / "ports.toml"
    path.write_text(text)
    return str(path)


def test_the_usual_set_is_the_default_pair():
    assert instruments_through("usual", SIZE) == default_instruments(SIZE)


@pytest.mark.parametrize("name", PORT_SETS)
def test_every_set_starts_with_its_tips_over_the_block_and_reaches_it(name):
    for instrument in instruments_through(name, SIZE):
        x, y, z = instrument.reach_of(instrument.handle).tip
        assert 0 < x < SIZE[0]
        assert 0 < y < SIZE[1]
        assert z == pytest.approx(0.008)
        for corner in ((0, 0, 0), (SIZE[0], SIZE[1], -0.01)):
            assert instrument.reach_of(instrument.handle_for(corner)).tip == pytest.approx(corner, abs=1e-12)


def test_oblique_shafts_lie_flat():
    for instrument in instruments_through("oblique", (0.06, 0.06)):
        direction = np.array(instrument.reach_of(instrument.handle).direction)
        assert np.degrees(np.arcsin(-direction[2])) < 30


def test_a_file(tmp_path):
    left, right = instruments_through(file(tmp_path, GOOD), SIZE)
    assert (left.tip, left.shaft_radius, left.length) == (TipKind.GRASPER, 2.5e-3, 0.31)
    assert right.port == pytest.approx((0.11, -0.01, 0.09))
    assert (right.tip, right.shaft_radius, right.length) == (TipKind.HOOK, 5e-3, pytest.approx(0.33))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("[left]", "[lefft]"), r"lefft: expected \[left\] and \[right\]"),
        (("[left]\nport_mm = [-50, -10, 100]\ntip", "[left]\ntip"), r"\[left\] port_mm: expected a value"),
        (
            ('tip = "hook"', 'tip = "saw"'),
            "expected one of probe, grasper, needle-holder, hook, scissors, got 'saw'",
        ),
        (('tip = "hook"', "tip = 3"), "tip: expected one of"),
        (("[110, -10, 90]", "[110, -10]"), "port_mm: expected three numbers"),
        (("[110, -10, 90]", '[110, -10, "high"]'), "port_mm: expected three numbers"),
        (("[110, -10, 90]", "[110, -10, nan]"), "expected"),
        (("[110, -10, 90]", "[110, -10, -90]"), "at least 16 mm above the tissue"),
        (("[110, -10, 90]", "[900, -10, 90]"), "within 330 mm of the tissue"),
        (("shaft_diameter_mm = 10", "shaft_diameter_mm = 12"), "from 5 to 10, got 12"),
        (("shaft_diameter_mm = 10", "shaft_diameter_mm = true"), "from 5 to 10, got True"),
        (("length_mm = 330", "lenght_mm = 330"), "did you mean length_mm?"),
        (("length_mm = 330", "length_mm = 3300"), "length"),
        (("[right]", "right = 3\n[other]"), "expected"),
        (("tip", "= tip"), "expected TOML"),
    ],
)
def test_a_mistake_in_a_file_is_refused_with_its_place(tmp_path, change, words):
    assert change[0] in GOOD
    path = file(tmp_path, GOOD.replace(*change))
    with pytest.raises(InputError, match=words):
        instruments_through(path, SIZE)


def test_no_such_set_or_file(tmp_path):
    with pytest.raises(InputError, match=r"did you mean oblique\?"):
        instruments_through("oblik", SIZE)
    with pytest.raises(InputError, match="expected a file that can be read"):
        instruments_through(str(tmp_path / "none.toml"), SIZE)
    with pytest.raises(InputError, match="expected a file that can be read"):
        instruments_through(f"{tmp_path}/", SIZE)


def test_the_example_file_is_one():
    example = Path(__file__).parents[2] / "examples" / "ports" / "needle-holder.toml"
    left, right = instruments_through(str(example), SIZE)
    assert (left.tip, right.tip) == (TipKind.GRASPER, TipKind.NEEDLE_HOLDER)


@pytest.mark.parametrize("ports", ["usual", "oblique", "one-sided"])
def test_a_set_stands_over_the_middle_of_another_block_as_over_its_own(ports):
    usual, other = (0.06, 0.06), (0.2, 0.1)
    for one, moved in zip(
        instruments_through(ports, usual), instruments_over(ports, other, usual), strict=True
    ):
        shift = np.array([0.07, 0.02, 0.0])
        assert moved.port == pytest.approx(np.array(one.port) + shift)
        assert moved.handle == pytest.approx(np.array(one.handle) + shift)
        assert moved.tip == one.tip


def test_a_file_says_places_of_the_block_it_is_used_on(tmp_path):
    path = tmp_path / "ports.toml"
    side = 'port_mm = [{}, -10, 100]\ntip = "probe"\n'
    path.write_text("[left]\n" + side.format(-50) + "[right]\n" + side.format(250))
    left, right = instruments_over(str(path), (0.2, 0.1), (0.06, 0.06))
    assert left.port == pytest.approx((-0.05, -0.01, 0.1))
    assert right.port == pytest.approx((0.25, -0.01, 0.1))
