"""Sentences of errors: in the library's words, and in those of a command."""

from trocar.errors import InputError


def test_what_to_pass_is_said_after_the_advice():
    error = InputError("organ.stl", "a solid", "0.2 mm", "it looks like m", give={"unit": "m", "up": "+y"})
    assert str(error) == (
        "organ.stl: expected a solid, got '0.2 mm'; it looks like m; pass unit='m', up='+y'"
    )
    assert str(InputError("a", "b", 1, give={"c": 2})) == "a: expected b, got 1; pass c=2"


def test_a_command_names_its_options_instead():
    options = {"unit": "--mesh-unit", "left": "--mesh-left"}
    error = InputError("unit", "one of m, mm", "inch", give={"unit": "m", "left": True, "spacing": 0.1})
    assert str(error.named(options)) == (
        "--mesh-unit: expected one of m, mm, got 'inch'; give --mesh-unit m --mesh-left"
    )
    other = InputError("tissue", "one of skin", "granite", "trocar tissues lists them")
    assert str(other.named(options)) == str(other)
