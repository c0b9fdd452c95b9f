"""One table of a TOML file, nothing in it trusted: a refusal names file, key, expectation and value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from math import isfinite

from trocar.errors import InputError
from trocar.tissues.key_quantity import KeyQuantity

MOST_CHARACTERS = 200  # of a title or a name


class Words:
    """A value shown in a message without quotes, such as "nothing"."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


NOTHING = Words("nothing")


def printable(text: str) -> str:
    """Return text fit for one line of a message, control characters and surrogates escaped."""
    return text if text.isprintable() and text else ascii(text)


class Table:
    """One table of a file.

    Args:
        file: name of the file, for messages.
        path: key path of the table, such as "layer[1]"; empty for the whole document.
        content: its keys and values.
    """

    def __init__(self, file: str, path: str, content: Mapping[str, object]) -> None:
        self.file = file
        self.path = path
        self.content = content

    def where(self, key: str) -> str:
        """Return file and key path of a key."""
        shown_key = printable(key) if len(key) <= 40 else f"{printable(key[:37])}..."
        return f"{self.file}: {self.path}.{shown_key}" if self.path else f"{self.file}: {shown_key}"

    def refuse(self, key: str, expected: str, got: object, advice: str = "") -> InputError:
        """Return the error that says what is wrong with a key."""
        return InputError(self.where(key), expected, got, advice)

    def only(self, keys: Iterable[str]) -> None:
        """Refuse keys that are not known, suggesting the closest."""
        known = tuple(keys)
        for key in self.content:
            if key not in known:
                near = get_close_matches(key[:100], known, n=1, cutoff=0.5)
                advice = f"did you mean {near[0]}?" if near else ""
                raise self.refuse(key, f"only the keys {', '.join(known)}", self.content[key], advice)

    def value(self, key: str, expected: str) -> object:
        """Return a key's value, refusing its absence."""
        if key not in self.content:
            raise self.refuse(key, expected, NOTHING, "add the key")
        return self.content[key]

    def number(self, quantity: KeyQuantity) -> float:
        """Return one number [SI]."""
        key = quantity.key
        if key not in self.content and quantity.default is not None:
            return quantity.default * quantity.factor
        return self.convert(key, quantity, self.value(key, quantity.expected))

    def pair(self, quantity: KeyQuantity) -> tuple[float, float]:
        """Return two numbers [SI]."""
        key = quantity.key
        if key not in self.content and quantity.default is not None:
            both = quantity.default * quantity.factor
            return both, both
        expected = f"two numbers, each {quantity.expected.removeprefix('a number ')}"
        value = self.value(key, expected)
        if not isinstance(value, list) or len(value) != 2:
            raise self.refuse(key, expected, value)
        first, second = (self.convert(f"{key}[{i}]", quantity, item) for i, item in enumerate(value))
        return first, second

    def pairs(self, first: KeyQuantity, second: KeyQuantity, most: int) -> tuple[tuple[float, float], ...]:
        """Return a list of pairs [SI], of as many as `most`; none where the key is left out."""
        key = first.key
        expected = f"a list of at most {most} pairs [{first.expected}, {second.expected}]"
        value = self.content.get(key, [])
        if not isinstance(value, list) or len(value) > most:
            raise self.refuse(key, expected, value)
        found = []
        for i, pair in enumerate(value):
            if not isinstance(pair, list) or len(pair) != 2:
                raise self.refuse(f"{key}[{i}]", f"a pair [{first.expected}, {second.expected}]", pair)
            one, other = self.convert(f"{key}[{i}][0]", first, pair[0]), pair[1]
            found.append((one, self.convert(f"{key}[{i}][1]", second, other)))
        return tuple(found)

    def text(self, key: str, default: str | None = None) -> str:
        """Return a short printable string."""
        expected = f"printable text of 1 to {MOST_CHARACTERS} characters on one line"
        if default is not None and key not in self.content:
            return default
        value = self.value(key, expected)
        if isinstance(value, str) and value.strip() and value.isprintable() and len(value) <= MOST_CHARACTERS:
            return value
        raise self.refuse(key, expected, value)

    def prose(self, key: str, *, required: bool = True) -> str:
        """Return a text of any length, without the blanks round it; empty where it may be left out and is."""
        if not required and key not in self.content:
            return ""
        value = self.value(key, "a text")
        if not isinstance(value, str) or not value.strip():
            raise self.refuse(key, "a text", value)
        return value.strip()

    def flag(self, key: str, default: bool) -> bool:
        """Return true or false."""
        value = self.content.get(key, default)
        if not isinstance(value, bool):
            raise self.refuse(key, "true or false", value)
        return value

    def choice(self, key: str, words: tuple[str, ...], *, default: str | None = None) -> str:
        """Return one of some words.

        Args:
            key: the key.
            words: what may be chosen.
            default: taken where the key is left out; None where it may not be.
        """
        expected = " or ".join(f'"{word}"' for word in words)
        value = default if default is not None and key not in self.content else self.value(key, expected)
        if isinstance(value, str) and value in words:
            return value
        near = get_close_matches(value[:100], words, n=1) if isinstance(value, str) else []
        raise self.refuse(key, expected, value, f'did you mean "{near[0]}"?' if near else "")

    def table(self, key: str, *, because: str = "") -> Table:
        """Return the table [key]; a message says because of what it must be there."""
        expected = f"a table [{key}]{because and f', because {because}'}"
        value = self.value(key, expected)
        if not isinstance(value, dict):
            raise self.refuse(key, expected, value)
        return Table(self.file, f"{self.path}.{key}" if self.path else key, value)

    def tables(self, key: str, most: int) -> tuple[Table, ...]:
        """Return the array of tables [[key]], 1 to `most` of them."""
        expected = f"1 to {most} tables [[{key}]]"
        value = self.value(key, expected)
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.refuse(key, expected, value)
        if not 1 <= len(value) <= most:
            raise self.refuse(key, expected, len(value))
        return tuple(Table(self.file, f"{key}[{i}]", item) for i, item in enumerate(value))

    def convert(self, key: str, quantity: KeyQuantity, value: object) -> float:
        """Return `value` of the file's unit in SI, refusing what is not a possible number."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.refuse(key, quantity.expected, value)
        number = finite(value)
        if number is None or not quantity.allows(number):
            raise self.refuse(key, quantity.expected, value, quantity.advice)
        return number * quantity.factor


def finite(value: object) -> float | None:
    """Return a value as a float where it is a finite number; TOML's integers have no largest one."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if isfinite(number) else None
