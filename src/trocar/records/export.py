"""What is written for others: a file that is whole or not there."""

from __future__ import annotations

from pathlib import Path

from trocar.errors import InputError
from trocar.whole_file import write_whole


def write_export(out: Path, text: str, beginning: str) -> None:
    """Write an export beside its place and rename it into it; an older one of its kind is replaced.

    Args:
        out: where.
        text: all of it.
        beginning: how every export of its kind begins.

    Raises:
        InputError: another file, or a folder, has that name.
        OSError: the place cannot be written to.
    """
    if out.exists() and not _begins(out, beginning):
        got = "a folder" if out.is_dir() else "another file"
        raise InputError(f"out: {out}", "a new file, or an older export", got, "choose another name")
    out.parent.mkdir(parents=True, exist_ok=True)
    write_whole(out, lambda stream: stream.write(text))


def _begins(out: Path, beginning: str) -> bool:
    if not out.is_file():
        return False
    with out.open("rb") as stream:
        return stream.read(len(beginning.encode())) == beginning.encode()
