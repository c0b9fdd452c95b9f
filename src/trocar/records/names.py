"""How trainees are named."""

from __future__ import annotations

from unicodedata import normalize

from trocar.errors import InputError

LONGEST = 80  # characters
SCRIPTED = {"scripted expert", "scripted novice"}  # what programs are called, and no person


def trainee_name(text: str) -> str:
    """Return a person's name as it is kept: without space around it, an accented letter always as one character.

    Raises:
        InputError: nothing is left, it is too long, a character in it cannot be seen, or a program is called so.
    """
    name = as_kept(text)
    if not 1 <= len(name) <= LONGEST:
        raise InputError("trainee: name", f"1 to {LONGEST} characters", text)
    if not name.isprintable():
        raise InputError(
            "trainee: name", "characters that can be seen, on one line", text, "leave out the others"
        )
    if _is_scripted(name):
        raise InputError("trainee: name", "a person's", text, "programs that do tasks are called so")
    return name


def scripted_name(skill: str) -> str:
    """Return under which name the attempts of a scripted trainee are kept."""
    name = f"scripted {skill}"
    assert name in SCRIPTED
    return name


def as_kept(text: str) -> str:
    """Return how a name is spelt in the records, whether anyone has it or not."""
    return normalize("NFC", text).strip()


def _is_scripted(name: str) -> bool:
    """Return whether a reader would take a name for a scripted trainee's, however it is spaced or capitalized."""
    return " ".join(normalize("NFKC", name).casefold().split()) in SCRIPTED
