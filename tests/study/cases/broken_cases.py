"""Break a valid case file in every way a user or a disk might, and say what the loader made of it.

`bench/fuzz_cases.py` runs the same by the thousand.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import fields, is_dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import strategies as st

from trocar.errors import InputError
from trocar.study.cases.reading import Case, load_case

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.toml"))
VALID: tuple[dict[str, Any], ...] = tuple(tomllib.loads(path.read_text("utf-8")) for path in EXAMPLES)


class Verbatim(str):
    """Text to be written as a TOML value without quoting."""


def written(value: object) -> str:
    """Return a value as TOML, tables inline."""
    match value:
        case Verbatim():
            return str(value)
        case bool():
            return "true" if value else "false"
        case int() | float():
            return repr(value)
        case str():
            escaped = "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08x}" for c in value)
            return f'"{escaped}"'
        case list():
            return f"[{', '.join(map(written, value))}]"
        case dict():
            return f"{{{', '.join(f'{written(str(k))} = {written(v)}' for k, v in value.items())}}}"
    raise AssertionError(type(value))


def document(content: dict[str, Any]) -> str:
    """Return a whole TOML document."""
    return "\n".join(f"{written(str(key))} = {written(value)}" for key, value in content.items())


NUMBERS = st.one_of(
    st.sampled_from(
        [0, -0.0, -1, 0.5, 90, 89.999999999999, 1e300, 1e-300, -1e300, 5e-324, 10**400, -(10**400)]
    ),
    st.sampled_from([float("nan"), float("inf"), float("-inf"), 1e-9, 1e-3, 1e3, 1e6, 1e9]),
    st.floats(),
    st.floats(min_value=1e-4, max_value=1e4),
    st.integers(),
)
ODD = st.sampled_from(
    [
        Verbatim(text)
        for text in ("1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "0x" + "f" * 6000, "[[[[]]]]")
    ]
)
SCALARS = st.one_of(NUMBERS, st.booleans(), st.text(st.characters(codec="utf-8"), max_size=12), ODD)
GARBAGE = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.text(st.characters(codec="utf-8"), max_size=6), inner, max_size=3)
    ),
    max_leaves=6,
)


def _places(node: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the path of everything inside a document."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from _places(value, (*path, key))


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """Draw a valid document with one to three things changed; some stay valid."""
    content = deepcopy(draw(st.sampled_from(VALID)))
    for _ in range(draw(st.integers(1, 3))):
        places = list(_places(content))
        if not places:
            break
        *parents, last = draw(st.sampled_from(places))
        node: Any = content
        for step in parents:
            node = node[step]
        match draw(st.sampled_from(["drop", "rename", "number", "garbage", "scale", "add", "repeat"])):
            case "drop":
                del node[last]
            case "rename" if isinstance(node, dict):
                node[
                    draw(st.sampled_from([f"{last}s", str(last)[1:], str(last).upper(), "prony", "\u0000"]))
                ] = node.pop(last)
            case "number":
                node[last] = draw(NUMBERS)
            case "garbage":
                node[last] = draw(GARBAGE)
            case "scale" if isinstance(node[last], int | float) and abs(node[last]) < 1e300:
                node[last] = node[last] * 10.0 ** draw(st.integers(-8, 8))
            case "add" if isinstance(node, dict):
                node[draw(st.text(st.characters(codec="utf-8"), max_size=8))] = draw(GARBAGE)
            case "repeat" if isinstance(node, list):
                node.extend(deepcopy(node[last]) for _ in range(draw(st.integers(1, 60))))
    return document(content).encode()


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    """Draw a valid file with bytes cut out or overwritten, as a disk or an editor might leave it."""
    content = draw(st.sampled_from(EXAMPLES)).read_bytes()
    start = draw(st.integers(0, len(content)))
    end = draw(st.integers(start, len(content)))
    return content[:start] + draw(st.binary(max_size=20)) + content[end:]


SYNTAX = st.sampled_from(
    ["[", "]", "[[", "]]", "=", '"', "\n", ",", "{", "}", "layer", "tool", "block", ".", "1e9", "#"]
)
RANDOM_TOML = st.lists(SYNTAX, max_size=40).map(lambda parts: " ".join(parts).encode())
NESTED = st.integers(1, 5000).map(lambda depth: b"a = " + b"[" * depth + b"]" * depth)
BROKEN = st.one_of(mutated(), mutated(), mutated(), damaged(), st.binary(max_size=200), RANDOM_TOML, NESTED)


def outcome(content: bytes, folder: Path) -> str:
    """Load `content` as a file and return "accepted" or "refused"; fail on anything that is neither.

    Accepted means every number is finite and the load history can be followed. Refused means an InputError of
    one line that names the file and, where the document parses, a key.
    """
    file = folder / "case.toml"
    file.write_bytes(content)
    try:
        case = load_case(file)
    except InputError as error:
        message = str(error)
        assert str(file) in message, message
        assert "\n" not in message, message
        if _parses(content):
            place = error.where.removeprefix(str(file)).removeprefix(": ")
            assert place, message
        return "refused"
    check_possible(case)
    return "accepted"


def _parses(content: bytes) -> bool:
    try:
        return bool(tomllib.loads(content.decode("utf-8-sig")))
    except (ValueError, RecursionError):
        return False


def numbers_in(part: object) -> Iterator[float]:
    """Yield every number of a tree of frozen dataclasses and tuples."""
    if is_dataclass(part):
        for field in fields(part):
            yield from numbers_in(getattr(part, field.name))
    elif isinstance(part, tuple):
        for item in part:
            yield from numbers_in(item)
    elif isinstance(part, float):
        yield part


def check_possible(case: Case) -> None:
    """Fail unless a case is one a model could run."""
    strengths = {layer.tensile_strength for layer in case.tissue.layers}  # infinite where not known
    assert all(isfinite(value) for value in numbers_in(case) if value not in strengths)
    assert all(0.001 <= side <= 1 for side in case.size)
    assert case.tissue.thickness > 0
    times = case.sample_times()
    assert times[0] == 0
    assert times[-1] == case.duration
    assert np.all(np.diff(times) > 0)
    assert np.all(np.isin(case.corners(), times))
    for time in case.corners():
        for press, tool in zip(case.load_at(float(time)), case.tools, strict=True):
            assert 0 <= press.force <= tool.peak
            for centre, half, side in zip((press.x, press.y), tool.half_extent, case.size, strict=True):
                assert half * (1 - 1e-6) <= centre <= side - half * (1 - 1e-6)
