"""The errors a caller can meet: one root, few children.

Each message says what was expected, what came and what to do.
"""

from __future__ import annotations


class TrocarError(Exception):
    """Something Trocar could not do; the command line exits with 1."""


class InputError(TrocarError):
    """A value from outside is missing, unknown, of the wrong type or impossible; exit 2.

    Args:
        where: the key, argument or file the value came from.
        expected: what would have been accepted.
        got: the value that came.
        advice: what to do about it, if it does not follow from `expected`.
    """

    def __init__(self, where: str, expected: str, got: object, advice: str = "") -> None:
        self.where = where
        self.expected = expected
        self.got = got
        self.advice = advice
        sentence = f"{where}: expected {expected}, got {_shown(got)}"
        super().__init__(f"{sentence}; {advice}" if advice else sentence)


class SolverError(TrocarError):
    """A linear system or an eigenproblem could not be solved to the stated accuracy."""


class ServoError(TrocarError):
    """The servo's process could not be started, or is not there."""


def _shown(value: object, limit: int = 80) -> str:
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # an integer of 5000 digits, a deep nest
        return f"a {type(value).__name__} too large to print"
    return text if len(text) <= limit else f"{text[: limit - 3]}..."
