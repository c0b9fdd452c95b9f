"""One file that is whole or not there: written beside its place and renamed into it."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TextIO


def write_whole(place: Path, write: Callable[[TextIO], object]) -> None:
    """Write a text file; an older one is replaced.

    Args:
        place: where.
        write: puts the text into a stream, lines ending as it says.

    Raises:
        OSError: the place cannot be written to.
    """
    partial = place.with_name(f".{place.name}.partial-{os.getpid()}")
    try:
        with partial.open("w", encoding="utf-8", newline="") as stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        partial.replace(place)
    finally:
        with suppress(FileNotFoundError):
            partial.unlink()
