"""Output folders that are whole or not there: written beside their place and renamed into it at the end.

A run that is interrupted leaves at most a hidden folder whose name says that it is partial. A folder of an earlier
study is replaced whole; anything else that is in the way is refused before any work is done.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

from trocar.errors import InputError

MARKERS = ("report.html", "results.nc", "ledger.json")
"""What makes a folder one of ours."""

OURS = frozenset({*MARKERS, "curves.csv", "statistics.json", "measured.json", "figures"})
"""Every name a study writes into its folder."""

_FIGURES = frozenset({".svg", ".gif", ".png"})
_EXPECTED = "a folder that is new, empty, or an earlier study's"


def check_folder(out: Path) -> Path:
    """Return where the folder will stand, every link followed.

    Raises:
        InputError: something that no study wrote is in the way.
        OSError: the place cannot be written to.
    """
    place = Path(os.path.realpath(out))
    if place.exists() and not place.is_dir():
        raise InputError(f"out: {out}", _EXPECTED, "a file")
    if place.exists() and any(place.iterdir()) and not is_study(place):
        raise InputError(
            f"out: {out}", _EXPECTED, "a folder with other files", "name another, or empty it yourself"
        )
    if place == Path.cwd():
        raise InputError(
            f"out: {out}", _EXPECTED, "the folder you stand in", "name one below it, such as study"
        )
    nearest = next(parent for parent in place.parents if parent.exists())
    if not nearest.is_dir():
        raise InputError(f"out: {out}", _EXPECTED, f"a place below the file {nearest.name}")
    if place == nearest or not os.access(nearest, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(nearest))
    return place


def is_study(folder: Path) -> bool:
    """Return whether a study wrote the folder, and all that is in it."""
    names = {entry.name for entry in folder.iterdir()}
    if not (set(MARKERS) <= names <= OURS):
        return False
    figures = folder / "figures"
    return not figures.exists() or (
        figures.is_dir() and all(entry.is_file() and entry.suffix in _FIGURES for entry in figures.iterdir())
    )


@contextmanager
def fresh_folder(out: Path) -> Iterator[Path]:
    """Give an empty folder to write into; on leaving it becomes `out`, on an error it vanishes.

    Raises:
        InputError, OSError: as `check_folder`.
    """
    place = check_folder(out)
    place.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(mkdtemp(prefix=f".{place.name}.partial-", dir=place.parent))
    try:
        yield partial
        partial.chmod(0o777 & ~_umask())
        _put(partial, place)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _put(new: Path, place: Path) -> None:
    """Rename `new` to `place`; what stood there is kept aside until that is done, and put back if it fails."""
    check_folder(place)  # it may have changed while the study ran
    if not place.exists():
        new.rename(place)
        return
    aside = Path(mkdtemp(prefix=f".{place.name}.old-", dir=place.parent))
    old = place.rename(aside / place.name)
    try:
        new.rename(place)
    except OSError:
        old.rename(place)
        aside.rmdir()
        raise
    shutil.rmtree(aside)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
