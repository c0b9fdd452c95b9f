"""The browser client's types, written from the classes that the server uses: `python -m trocar.web.typescript`.

Text messages come from the JSON schemas of `trocar.web.messages`, offsets of the binary records from the dtypes
of `trocar.web.wire`, codes from `trocar.web.closing` and bits from `trocar.web.source`. The text is the same on
every machine, so the client's build can check that the file it holds is current.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from enum import IntEnum, IntFlag
from typing import Any

import numpy as np
from pydantic.json_schema import models_json_schema

from trocar.web.closing import Closing
from trocar.web.conversation import StreamLimits
from trocar.web.messages import PROTOCOL, Acknowledgement, Guiding, Hello, Notice, Reset
from trocar.web.source import Held, Status, Touch
from trocar.web.wire import FRAME_MAGIC, HEADER, INSTRUMENT, LINKS, POSE, POSE_MAGIC, REACH

_FROM_SERVER = (Hello, Guiding, Notice)
_FROM_CLIENT = (Acknowledgement, Reset)
_PLAIN = {"string": "string", "number": "number", "integer": "number", "boolean": "boolean", "null": "null"}
_HEAD = "// Written by `python -m trocar.web.typescript`; do not edit."


def typescript() -> str:
    """Return the TypeScript module."""
    models = [(model, "serialization") for model in (*_FROM_SERVER, *_FROM_CLIENT)]
    definitions: Mapping[str, Mapping[str, Any]] = models_json_schema(models)[1]["$defs"]  # type: ignore[arg-type]
    limits = StreamLimits()
    constants = {
        "PROTOCOL": str(PROTOCOL),
        "UNACKNOWLEDGED": str(limits.unacknowledged),
        "MESSAGE_RATE_HZ": f"{limits.message_rate:g}",
        "IDLE_S": f"{limits.idle:g}",
        "REACH_M": f"{REACH:g}",
        "FRAME_MAGIC": f"0x{FRAME_MAGIC:08x}",
        "POSE_MAGIC": f"0x{POSE_MAGIC:08x}",
        "LINKS": f"{LINKS}",
    }
    parts = [
        _HEAD,
        *(_interface(name, schema) for name, schema in sorted(definitions.items())),
        _union("ServerMessage", _FROM_SERVER),
        _union("ClientMessage", _FROM_CLIENT),
        "\n".join(f"export const {name} = {value};" for name, value in constants.items()),
        _table("Closing", _members(Closing), "Codes with which the server closes the stream."),
        _table("Status", _members(Status), "Bits of a frame's status."),
        _table("Touch", _members(Touch), "Bits of an instrument's flags."),
        _table("Held", _members(Held), "Bits of a pose's flags."),
        _layout("HEADER", HEADER, "a frame's header"),
        _layout("INSTRUMENT", INSTRUMENT, "an instrument's record in a frame"),
        _layout("POSE", POSE, "a pose"),
    ]
    return "\n\n".join(parts) + "\n"


def _interface(name: str, schema: Mapping[str, Any]) -> str:
    lines = [*_comment(schema.get("description", "")), f"export interface {name} {{"]
    for key, value in schema["properties"].items():
        lines += [f"  {line}" for line in _comment(value.get("description", ""))]
        lines.append(f"  readonly {key}: {_type(value)};")
    return "\n".join([*lines, "}"])


def _type(schema: Mapping[str, Any]) -> str:
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "anyOf" in schema:
        return " | ".join(map(_type, schema["anyOf"]))
    if "const" in schema:
        return _literal(schema["const"])
    if "enum" in schema:
        return " | ".join(map(_literal, schema["enum"]))
    if "prefixItems" in schema:
        return f"readonly [{', '.join(map(_type, schema['prefixItems']))}]"
    if schema.get("type") == "array":
        item = _type(schema["items"])
        return f"readonly {item}[]" if item.isidentifier() else f"readonly ({item})[]"
    return _PLAIN[schema["type"]]  # a schema that says more than we write must fail here, not pass as unknown


def _literal(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value)


def _union(name: str, models: Iterable[type]) -> str:
    return f"export type {name} = {' | '.join(model.__name__ for model in models)};"


def _members(kind: type[IntEnum] | type[IntFlag]) -> dict[str, int]:
    return {_camel(name): int(member) for name, member in kind.__members__.items()}


def _table(name: str, members: Mapping[str, object], description: str) -> str:
    body = [f"  {key}: {value}," for key, value in members.items()]
    return "\n".join([*_comment(description), f"export const {name} = {{", *body, "} as const;"])


def _layout(name: str, dtype: np.dtype[np.void], what: str) -> str:
    assert dtype.names is not None
    assert dtype.fields is not None
    offsets = {_camel(key): dtype.fields[key][1] for key in dtype.names}
    description = f"Byte offsets in {what}, little-endian; `bytes` is its length."
    return _table(name, offsets | {"bytes": dtype.itemsize}, description)


def _camel(name: str) -> str:
    first, *rest = name.lower().split("_")
    return first + "".join(word.capitalize() for word in rest)


def _comment(text: str) -> list[str]:
    words = " ".join(text.split())
    return [f"/** {words} */"] if words else []


if __name__ == "__main__":
    sys.stdout.write(typescript())
