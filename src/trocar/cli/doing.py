"""What a long work is at: on a terminal a line that changes, elsewhere lines, one for each part and tenth of it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.status import Status


class Doing:
    """Say what is being done.

    Args:
        log: where lines go, where no line can change.
        status: the line that changes.
    """

    def __init__(self, log: Console, status: Status) -> None:
        self._log = log
        self._status = status
        self._said = ("", -1)

    def at(self, what: str, share: float | None = None) -> None:
        """Say a part of the work.

        Args:
            what: in a few words.
            share: how much of it is done, 0 to 1 [1]; None where nobody knows.
        """
        words = f"{what} ..." if share is None else f"{what}, {int(100 * share)} % ..."
        if self._log.is_terminal and not self._log.is_dumb_terminal:
            self._status.update(words)
            return
        name, tenth = self._said
        now = 0 if share is None else int(10 * share)
        if what != name or now > tenth:
            self._said = what, now
            self._log.print(words, markup=False, soft_wrap=True)


@contextmanager
def doing(log: Console, what: str) -> Iterator[Doing]:
    """Say what a long work is at, from its first part on.

    Args:
        log: of the command, on stderr.
        what: the first part, in a few words.
    """
    with log.status("") as status:
        work = Doing(log, status)
        work.at(what)
        yield work
