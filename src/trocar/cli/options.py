"""A command's options, named where the library would name the arguments they are passed on as."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from trocar.errors import InputError


@contextmanager
def options_named(options: Mapping[str, str]) -> Iterator[None]:
    """Name options in the sentence of an `InputError` that leaves the block.

    Args:
        options: names of the library's arguments, and the options that stand for them.

    Raises:
        InputError: the block's, in the command's words.
    """
    try:
        yield
    except InputError as error:
        raise error.named(options) from error
