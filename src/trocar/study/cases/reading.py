"""Case files: one experiment in TOML, read with nothing taken on trust.

Lengths come in millimetres, stresses in kilopascals, angles in degrees and leave in SI: this is the one
border. Left out, these keys take a neutral value: tilt_deg, azimuth_deg, hold_s, prestress_kpa and both loss
keys are 0, prony is empty, tip is "flat", contact is "dead", law is "linear", dynamic is false. All others must be
there.
"""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path

from trocar.errors import InputError
from trocar.model import Support
from trocar.study.cases import quantity as q
from trocar.study.cases.experiment import Case, Sampling, case_from_tissue
from trocar.study.cases.mesh_table import ANY_THICKNESS, read_mesh_table
from trocar.study.cases.tool import Contact, Tip, Tool
from trocar.tissues import Layer, Tissue
from trocar.tissues.key_quantity import MOST_LAYERS
from trocar.tissues.key_table import NOTHING, Table, Words, printable
from trocar.tissues.law_keys import LAW_KEYS, MEMORY_KEY, read_law, read_prony, refuse_mixture

__all__ = ["Case", "Sampling", "Tool", "case_from_tissue", "load_case"]

MOST_BYTES = 1_000_000  # a case is about a kilobyte

_BLOCK_KEYS = (q.SIDE.key, "support")
_LAYER_KEYS = ("name", *(item.key for item in q.LAYER), q.PRESTRESS.key, MEMORY_KEY, *LAW_KEYS)
_TOOL_KEYS = ("tip", "contact", q.POSITION.key, *(item.key for item in q.TOOL))
_SAMPLING_KEYS = (q.PERIOD.key, "dynamic")
_FILE_KEYS = {item.name: item.key for item in (q.SIDE, *q.LAYER, q.PRESTRESS, *q.TOOL, q.POSITION, q.PERIOD)}


def load_case(path: str | os.PathLike[str]) -> Case:
    """Read a case file.

    Args:
        path: of a TOML file in UTF-8, at most a megabyte.

    Returns:
        The case in SI, everything in it finite and possible.

    Raises:
        InputError: the file cannot be read, or something in it is unknown, missing, of the wrong type,
            or impossible; the message is one line naming file, key, expectation and value.
    """
    file = printable(os.fspath(path))
    root = Table(file, "", _parse(file, _read(file, path)))
    root.only(("title", "block", "mesh", "layer", "tool", "sampling"))
    title = root.text("title")
    meshed = "mesh" in root.content
    if meshed and "block" in root.content:
        raise root.refuse("mesh", "a table [block] or a table [mesh]", Words("both"), "leave one of them out")
    layers = _layers(root, slabs=not meshed)
    try:
        tissue = Tissue(layers=layers, name=title)
    except InputError as error:
        raise InputError(f"{file}: layer: prony", error.expected, error.got, error.advice) from None
    tools = tuple(_tool(table) for table in root.tables("tool", q.MOST_TOOLS))
    sampling = _sampling(root.table("sampling"))
    mesh = None
    if meshed:
        table = root.table("mesh")
        mesh, tissue = read_mesh_table(table, Path(path).parent, tissue, tools[0].position)
        size, support = mesh.size, mesh.support
    else:
        size, support = _block(root.table("block", because="there is no [mesh]"))
    try:
        return Case(
            title=title,
            tissue=tissue,
            size=size,
            support=support,
            tools=tools,
            sampling=sampling,
            mesh=mesh,
        )
    except InputError as error:
        raise _in_file(file, "", error) from None


def _read(file: str, path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a regular file."""
    expected = "a readable TOML file"
    try:
        place = Path(path)
        if place.is_dir():
            raise InputError(file, expected, Words("a directory"))
        if place.exists() and not place.is_file():
            raise InputError(file, expected, Words("something that is not a regular file"))
        with place.open("rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except (
        OSError,
        ValueError,
    ) as error:  # ValueError: a path no system accepts, such as one with a null byte
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(file, expected, Words(printable(reason))) from None
    if len(content) > MOST_BYTES:
        raise InputError(file, f"at most {MOST_BYTES} bytes", Words("a larger file"))
    return content


def _parse(file: str, content: bytes) -> dict[str, object]:
    """Return the document; a byte-order mark is allowed."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        got = f"byte 0x{content[error.start]:02x} in line {line}"
        raise InputError(file, "text in UTF-8", Words(got), "save the file as UTF-8") from None
    if not text.strip():
        raise InputError(file, "a case in TOML", Words("an empty file"))
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(file, "TOML", Words("tables or arrays nested too deep to read")) from None
    except ValueError as error:  # syntax, or a number of thousands of digits
        last = len(text.splitlines())
        reason = str(error).replace("at end of document", f"at end of document, line {last}")
        raise InputError(file, "TOML", Words(printable(reason)), "see https://toml.io") from None


def _block(table: Table) -> tuple[tuple[float, float], Support]:
    table.only(_BLOCK_KEYS)
    size = table.pair(q.SIDE)
    return size, Support(table.choice("support", tuple(kind.value for kind in Support)))


def _layers(root: Table, *, slabs: bool) -> tuple[Layer, ...]:
    layers: list[Layer] = []
    tables = root.tables("layer", MOST_LAYERS)
    for table in tables:
        layer = _layer(table, slab=slabs)
        if layer.name in (other.name for other in layers):
            raise table.refuse("name", "every layer's name once", layer.name)
        layers.append(layer)
    refuse_mixture(tables, layers)
    return tuple(layers)


def _layer(table: Table, *, slab: bool) -> Layer:
    if not slab and q.THICKNESS.key in table.content:
        key = q.THICKNESS.key
        raise table.refuse(key, "no such key beside [mesh]", table.content[key], "the mesh says where it is")
    table.only(_LAYER_KEYS)
    name = table.text("name")
    law = read_law(table)
    loss, frequency = q.LOSS_FACTOR.key, q.LOSS_FREQUENCY.key
    for present, absent in ((loss, frequency), (frequency, loss)):
        if present in table.content and absent not in table.content:
            raise table.refuse(absent, f"a number beside {present}", NOTHING, "give both or neither")
    numbers = {item.name: table.number(item) for item in q.LAYER if slab or item is not q.THICKNESS}
    if not slab:
        numbers[q.THICKNESS.name] = ANY_THICKNESS
    prestress_x, prestress_y = table.pair(q.PRESTRESS)
    return Layer(
        name=name,
        prestress_x=prestress_x,
        prestress_y=prestress_y,
        prony=read_prony(table),
        law=law,
        **numbers,
    )


def _tool(table: Table) -> Tool:
    table.only(_TOOL_KEYS)
    tip = Tip(table.choice("tip", tuple(kind.value for kind in Tip), default=Tip.FLAT.value))
    contact = Contact(
        table.choice("contact", tuple(kind.value for kind in Contact), default=Contact.DEAD.value)
    )
    position = table.pair(q.POSITION)
    numbers = {item.name: table.number(item) for item in q.TOOL}
    try:
        return Tool(position=position, tip=tip, contact=contact, **numbers)
    except InputError as error:
        raise _in_file(table.file, table.path, error) from None


def _sampling(table: Table) -> Sampling:
    table.only(_SAMPLING_KEYS)
    return Sampling(period=table.number(q.PERIOD), dynamic=table.flag("dynamic", False))


def _in_file(file: str, path: str, error: InputError) -> InputError:
    """Return a constructor's error with the file and the file's key: "tool: rate" as "tool[0].rate_n_s"."""
    head, name = re.fullmatch(r"(.*?)(\w+)", error.where).groups()  # type: ignore[union-attr]
    head = f"{path}." if path else head
    return InputError(f"{file}: {head}{_FILE_KEYS.get(name, name)}", error.expected, error.got, error.advice)
