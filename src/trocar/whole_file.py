"""One file that is whole or not there: written beside its place and renamed into it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import get_ident
from typing import TextIO


@contextmanager
def whole(place: Path) -> Iterator[Path]:
    """Yield where to write what shall be at a place once the block ends well; an older file is replaced.

    Args:
        place: where.

    Raises:
        OSError: the place cannot be written to.
    """
    partial = place.with_name(f".{place.name}.partial-{os.getpid()}-{get_ident()}")
    try:
        yield partial
        with partial.open("rb") as stream:
            os.fsync(stream.fileno())
        partial.replace(place)
    finally:
        partial.unlink(missing_ok=True)


def write_whole(place: Path, write: Callable[[TextIO], object]) -> None:
    """Write a text file; an older one is replaced.

    Args:
        place: where.
        write: puts the text into a stream, lines ending as it says.

    Raises:
        OSError: the place cannot be written to.
    """
    with whole(place) as partial, partial.open("w", encoding="utf-8", newline="") as stream:
        write(stream)
