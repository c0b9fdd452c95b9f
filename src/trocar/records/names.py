"""How trainees are named."""

from __future__ import annotations

from unicodedata import normalize

from trocar.errors import InputError

LONGEST = 80  # characters


def trainee_name(text: str) -> str:
    """Return a name as it is kept: without space around it, an accented letter always as one character.

    Raises:
        InputError: nothing is left, it is too long, or a character in it cannot be printed.
    """
    name = as_kept(text)
    if not 1 <= len(name) <= LONGEST:
        raise InputError("trainee: name", f"1 to {LONGEST} characters", text)
    if not name.isprintable():
        raise InputError("trainee: name", "characters that can be printed, on one line", text)
    return name


def as_kept(text: str) -> str:
    """Return how a name is spelt in the records, whether anyone has it or not."""
    return normalize("NFC", text).strip()
