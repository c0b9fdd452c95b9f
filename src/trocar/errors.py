"""The errors a caller can meet: one root, few children.

Each message says what was expected, what came and what to do.
"""

from __future__ import annotations

from collections.abc import Mapping


class TrocarError(Exception):
    """Something Trocar could not do; the command line exits with 1."""


class InputError(TrocarError):
    """A value from outside is missing, unknown, of the wrong type or impossible; exit 2.

    Args:
        where: the key, argument or file the value came from.
        expected: what would have been accepted.
        got: the value that came.
        advice: what to do about it, if it does not follow from `expected`.
        give: arguments that would mend it, with their values; said after the advice.
    """

    def __init__(
        self,
        where: str,
        expected: str,
        got: object,
        advice: str = "",
        *,
        give: Mapping[str, object] | None = None,
    ) -> None:
        self.where = where
        self.expected = expected
        self.got = got
        self.advice = advice
        self.give = dict(give or {})
        passed = ", ".join(f"{name}={value!r}" for name, value in self.give.items())
        parts = (
            f"{where}: expected {expected}, got {_shown(got)}",
            advice,
            f"pass {passed}" if passed else "",
        )
        super().__init__("; ".join(part for part in parts if part))

    def named(self, options: Mapping[str, str]) -> InputError:
        """Return the same error with a command's options in place of the arguments they are passed on as.

        Args:
            options: names of arguments, and the options that stand for them.
        """
        given = " ".join(
            options[name] if value is True else f"{options[name]} {value}"
            for name, value in self.give.items()
            if name in options
        )
        advice = "; ".join(part for part in (self.advice, f"give {given}" if given else "") if part)
        return InputError(options.get(self.where, self.where), self.expected, self.got, advice)


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
