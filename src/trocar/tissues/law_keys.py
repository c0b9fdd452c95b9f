"""The law of a layer in a file, `law` and the key with its numbers, and what it remembers, pairs [g, tau]."""

from __future__ import annotations

from trocar.errors import InputError
from trocar.tissues.key_quantity import ALPHA, FIBRE, PRONY_TIME, PRONY_WEIGHT, SHARE
from trocar.tissues.key_table import Table
from trocar.tissues.law import LINEAR, MOST_TERMS, Fibre, Law, NeoHookean, Ogden
from trocar.tissues.layer import MOST_TERMS as MOST_TIMES
from trocar.tissues.layer import Layer, Prony

LAW_KEYS = ("law", "ogden", "fibre")
MEMORY_KEY = PRONY_TIME.key
_LAWS = ("linear", "neo-hookean", "ogden", "fibre")
_TERMS = f"1 to {MOST_TERMS} pairs [share, alpha]"


def read_law(table: Table) -> Law:
    """Read the law of a layer.

    Args:
        table: of the layer.

    Raises:
        InputError: it is unknown, or its numbers are missing, of the wrong type, impossible or another law's.
    """
    law = table.choice("law", _LAWS, default="linear")
    for key in ("ogden", "fibre"):
        if key in table.content and law != key:
            raise table.refuse(
                key, f'this key only beside law = "{key}"', table.content[key], f'law is "{law}"'
            )
    if law == "neo-hookean":
        return NeoHookean()
    if law == "ogden":
        return _ogden(table)
    if law == "fibre":
        return _fibre(table.table("fibre"))
    return LINEAR


def law_keys(law: Law) -> dict[str, object]:
    """Return what `read_law` reads a law from: `law`, and the key with its numbers in the file's units."""
    if isinstance(law, Ogden):
        return {"law": "ogden", "ogden": [list(term) for term in law.terms]}
    if isinstance(law, Fibre):
        return {"law": "fibre", "fibre": {item.key: getattr(law, item.name) / item.factor for item in FIBRE}}
    return {"law": "neo-hookean" if isinstance(law, NeoHookean) else "linear"}


def law_text(law: Law) -> str:
    """Return a law with its numbers, in words for a table."""
    if isinstance(law, Ogden):
        return "Ogden: " + ", ".join(f"share {share:g} at alpha {alpha:g}" for share, alpha in law.terms)
    if isinstance(law, Fibre):
        numbers = ((item, getattr(law, item.name) / item.factor) for item in FIBRE)
        return "fibre: " + ", ".join(f"{item.name} {value:g} {item.unit}".strip() for item, value in numbers)
    return "neo-Hookean" if isinstance(law, NeoHookean) else "linear"


def read_prony(table: Table) -> Prony:
    """Read the Prony series of a layer; empty where there is none.

    Args:
        table: with the key `prony`, or without it.

    Raises:
        InputError: its terms are too many, of the wrong type or impossible, or a time stands twice.
    """
    prony = table.pairs(PRONY_WEIGHT, PRONY_TIME, MOST_TIMES)
    times = [time for _, time in prony]
    if len(set(times)) < len(times):
        raise table.refuse(
            MEMORY_KEY, "every tau once", table.content[MEMORY_KEY], "add the weights of equal times"
        )
    return prony


def refuse_mixture(tables: tuple[Table, ...], layers: list[Layer]) -> None:
    """Refuse linear layers beside others.

    Raises:
        InputError: at the first layer that is not like the top one.
    """
    linear = [layer.law == LINEAR for layer in layers]
    for table, one in zip(tables, linear, strict=True):
        if one is not linear[0]:
            expected = '"linear", as layer[0]' if linear[0] else 'no "linear" law below one that is not'
            got = table.content.get("law", "linear")
            raise table.refuse("law", expected, got, "a block deforms little or much as a whole")


def _ogden(table: Table) -> Ogden:
    value = table.value("ogden", _TERMS)
    if not isinstance(value, list) or not 1 <= len(value) <= MOST_TERMS:
        raise table.refuse("ogden", _TERMS, value)
    terms = []
    for number, pair in enumerate(value):
        path = f"ogden[{number}]"
        if not isinstance(pair, list) or len(pair) != 2:
            raise table.refuse(path, "a pair [share, alpha]", pair)
        share, alpha = (
            table.convert(f"{path}[{place}]", quantity, item)
            for place, (quantity, item) in enumerate(zip((SHARE, ALPHA), pair, strict=True))
        )
        terms.append((share, alpha))
    try:
        return Ogden(terms=tuple(terms))
    except InputError as error:  # alpha too near 0, or the shares do not add up
        raise table.refuse("ogden", error.expected, error.got, error.advice) from None


def _fibre(table: Table) -> Fibre:
    table.only(tuple(item.key for item in FIBRE))
    return Fibre(**{item.name: table.number(item) for item in FIBRE})
