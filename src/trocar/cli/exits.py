"""How a command ends: every error is one line on stderr and an exit code, and a user's mistake no traceback.

- 0: done, whatever the models, the ledger or the score say.
- 1: it could not be done: a solver failed, a file cannot be written, memory ran out.
- 2: wrong usage or bad input.
- 130: interrupted, from the keyboard or by SIGTERM.

Anything else is a mistake of ours and keeps its traceback.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Protocol

from pydantic import ValidationError
from typer.exceptions import Abort, TyperException

from trocar.errors import InputError, TrocarError

DONE = 0
COULD_NOT = 1
WRONG_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as shells report it


class Command(Protocol):
    """What typer makes of an application."""

    def main(self, args: Sequence[str] | None, prog_name: str | None, *, standalone_mode: bool) -> object:
        """Parse the arguments and call the command they name."""
        ...


def run(command: Command, program: str, arguments: Sequence[str]) -> int:
    """Run a command and return the exit code, saying on stderr in one line what went wrong.

    Args:
        command: made by typer.
        program: the name its messages begin with.
        arguments: what stands after the program's name.
    """
    with suppress(ValueError):  # outside the main thread, as in a notebook's
        signal.signal(signal.SIGTERM, _interrupt)
    try:
        code = command.main(list(arguments), program, standalone_mode=False)
        sys.stdout.flush()
    except TyperException as error:
        return _leave(WRONG_INPUT, program, _usage_sentence(error, program))
    except InputError as error:
        return _leave(WRONG_INPUT, program, str(error))
    except TrocarError as error:
        return _leave(COULD_NOT, program, str(error))
    except BrokenPipeError:  # the reader of our output left, as `head` does
        _silence_stdout()
        return COULD_NOT
    except OSError as error:
        return _leave(COULD_NOT, program, _system_sentence(error))
    except MemoryError as error:
        return _leave(COULD_NOT, program, f"not enough memory {error}")
    except (KeyboardInterrupt, Abort):
        return _leave(INTERRUPTED, program, "interrupted")
    if code == INTERRUPTED:
        return _leave(INTERRUPTED, program, "interrupted")
    return code if isinstance(code, int) else DONE


def _interrupt(_number: int, _frame: object) -> None:
    """End on SIGTERM as on an interrupt from the keyboard, so that what was begun is cleared away."""
    raise KeyboardInterrupt


def _leave(code: int, program: str, sentence: str) -> int:
    line = " ".join(sentence.split())
    sys.stderr.write(f"{program}: {line}\n")
    return code


def _usage_sentence(error: TyperException, program: str) -> str:
    context = getattr(error, "ctx", None)  # knows which command was being parsed
    command = program if context is None else context.command_path
    sentence = error.format_message().rstrip(". ")
    if isinstance(error.__cause__, ValidationError):  # says what was expected, not what came
        sentence += f", got {error.__cause__.errors()[0]['input']!r}"
    if not sentence:  # no arguments at all; typer has printed the help
        sentence = "expected a command"
    return f"{sentence}; see {command} --help"


def _system_sentence(error: OSError) -> str:
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename else reason


def _silence_stdout() -> None:
    """Send what is still buffered nowhere, or the interpreter complains while it shuts down."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
