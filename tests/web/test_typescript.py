"""The client's types say what the server's classes say, in the same words every time."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from trocar.web import messages
from trocar.web.closing import Closing
from trocar.web.typescript import _type, typescript

TEXT = typescript()


def interface(name):
    body = re.search(rf"export interface {name} {{\n(.*?)\n}}", TEXT, flags=re.DOTALL).group(1)
    return dict(re.findall(r"readonly (\w+): (.*);", body))


@pytest.mark.parametrize(
    "model",
    [
        messages.Hello,
        messages.Notice,
        messages.Acknowledgement,
        messages.Reset,
        messages.TissueSize,
        messages.LayerSize,
        messages.InstrumentShape,
        messages.OrganShape,
        messages.Camera,
        messages.Guiding,
        messages.TaskMark,
    ],
)
def test_every_message_has_its_keys(model):
    assert set(interface(model.__name__)) == set(model.model_fields)


def test_types_are_the_tightest_there_are():
    assert interface("InstrumentShape")["name"] == '"left" | "right"'
    assert interface("InstrumentShape")["port_m"] == "readonly [number, number, number]"
    assert interface("Hello")["protocol"] == "1"
    assert interface("Hello")["steered_by"] == '"page" | "trainer"'
    assert interface("Hello")["instruments"] == "readonly InstrumentShape[]"
    assert interface("Acknowledgement") == {"type": '"ack"', "sequence": "number"}
    assert "export type ServerMessage = Hello | Guiding | Notice;" in TEXT


@pytest.mark.parametrize(
    ("schema", "written"),
    [
        ({"type": "array", "items": {"enum": ["a", "b"]}}, 'readonly ("a" | "b")[]'),
        ({"type": "array", "items": {"type": "boolean"}}, "readonly boolean[]"),
        ({"$ref": "#/$defs/Camera"}, "Camera"),
    ],
)
def test_a_schema_becomes_a_type(schema, written):
    assert _type(schema) == written


@pytest.mark.parametrize("schema", [{}, {"type": "object"}, {"anyOf": [{"type": "string"}, {"allOf": []}]}])
def test_a_schema_that_says_more_is_not_passed_over(schema):
    with pytest.raises(KeyError):
        _type(schema)


def test_offsets_and_codes_are_those_of_the_contract():
    for line in ("inPlane: 58,", "poseSequence: 24,", "handleForceN: 44,", "handleM: 16,", "rollRad: 40,"):
        assert f"  {line}\n" in TEXT
    assert f"tooManyMessages: {int(Closing.TOO_MANY_MESSAGES)}," in TEXT
    assert "export const FRAME_MAGIC = 0x314f5254;" in TEXT


def test_the_module_prints_it_the_same_in_another_process():
    source = Path(__file__).parent.parent.parent / "src"
    printed = subprocess.run(
        [sys.executable, "-m", "trocar.web.typescript"],
        check=True,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(source), "PYTHONHASHSEED": "7"},
    ).stdout
    assert printed == TEXT


def test_the_client_has_the_types_of_this_server():
    written = Path(__file__).parents[2] / "client" / "src" / "wire" / "contract.ts"
    assert written.read_text() == TEXT, "run: python -m trocar.web.typescript > client/src/wire/contract.ts"


def test_what_may_be_missing_may_be_null():
    assert _type({"anyOf": [{"type": "string"}, {"type": "null"}]}) == "string | null"
    assert _type({"type": "array", "items": {"anyOf": [{"type": "number"}, {"type": "null"}]}}) == (
        "readonly (number | null)[]"
    )
