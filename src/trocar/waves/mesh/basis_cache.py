"""Arrays that took long to compute, kept in files: modes of a mesh and the vectors of presses.

A file is the SHA-256 of what follows, and an uncompressed .npz without pickles. It is written under another name and
renamed, so that another process sees all of it or nothing; one whose checksum is wrong is taken for missing and written
again. A file's name is that of all that its content follows from. When all files together grow too large, those
that were not read for longest go.
"""

from __future__ import annotations

import hashlib
import io
import os
import time
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from platformdirs import user_cache_dir

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.whole_file import whole

VARIABLE = "TROCAR_DATA"
LARGEST = 2_000_000_000  # [bytes] of all files together
_ENDING = ".basis"
_LEFT_OVER = 3600.0  # [s] after which a half-written file belongs to a process that is gone


class BasisCache:
    """Keep arrays in a folder.

    Args:
        folder: None takes `waves` in the folder that `TROCAR_DATA` names, or in the platform's for caches.
        largest: all files together stay below it [bytes].

    Raises:
        InputError: `largest` is below 1.
    """

    def __init__(self, folder: Path | str | None = None, *, largest: int = LARGEST) -> None:
        if largest < 1:
            raise InputError("cache: largest", "a number of bytes above 0", largest)
        self.folder = cache_folder() if folder is None else Path(folder)
        self.largest = largest

    def remembered(self, key: str, make: Callable[[], tuple[FloatArray, ...]]) -> tuple[FloatArray, ...]:
        """Return what is kept under a key, or else make it and keep it.

        A folder that cannot be written to is no error: it only costs the time again.

        Args:
            key: all that the arrays follow from, as a name of letters and digits.
            make: computes them.
        """
        path = self.folder / (key + _ENDING)
        found = self._read(path)
        if found is None:
            found = make()
            with suppress(OSError):
                self._write(path, found)
        return found

    def _read(self, path: Path) -> tuple[FloatArray, ...] | None:
        try:
            content = path.read_bytes()
            os.utime(path)
        except OSError:
            return None
        digest, rest = content[:32], memoryview(content)[32:]
        if hashlib.sha256(rest).digest() != digest:
            return None
        try:
            with np.load(io.BytesIO(rest), allow_pickle=False) as arrays:
                return tuple(arrays[f"arr_{i}"] for i in range(len(arrays.files)))
        except (ValueError, KeyError, BadZipFile):  # another program's
            return None

    def _write(self, path: Path, arrays: tuple[FloatArray, ...]) -> None:
        stream = io.BytesIO()
        np.savez(stream, *arrays, allow_pickle=False)
        content = stream.getbuffer()
        if len(content) + 32 > self.largest:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        with whole(path) as partial, partial.open("wb") as file:
            file.write(hashlib.sha256(content).digest())
            file.write(content)
        self._make_room(path)

    def _make_room(self, newest: Path) -> None:
        for left in self.folder.glob(f".*{_ENDING}.partial-*"):
            with suppress(FileNotFoundError):
                if time.time() - left.stat().st_mtime > _LEFT_OVER:
                    left.unlink()
        known = []
        for path in self.folder.glob(f"*{_ENDING}"):
            with suppress(FileNotFoundError):  # another process makes room too
                known.append((path.stat().st_mtime, path.stat().st_size, path))
        total = sum(size for _, size, _ in known)
        for _, size, path in sorted(known):
            if total <= self.largest:
                return
            if path != newest:
                path.unlink(missing_ok=True)
                total -= size


def cache_folder() -> Path:
    """Return the folder that arrays are kept in; it need not exist yet."""
    named = os.environ.get(VARIABLE, "")
    base = Path(named).expanduser() if named else Path(user_cache_dir("trocar", appauthor=False))
    return base / "waves"


def fingerprint(mesh: SolidMesh, *others: object) -> str:
    """Return a name of a mesh, its materials and support, of other values that print in full, and of this code."""
    seen = hashlib.sha256(_code().encode())

    def add(name: str, array: np.ndarray) -> None:
        seen.update(f"{name} {array.dtype.str} {array.shape}".encode())
        seen.update(np.ascontiguousarray(array).tobytes())

    for name in ("corners", "cells", "region"):
        add(name, getattr(mesh, name))
    for one in mesh.held:
        add(f"held {one.along}", one.faces)
    for name, faces in mesh.surfaces.items():
        add(f"surface {name}", faces)
    seen.update(repr((mesh.materials, others)).encode())
    return seen.hexdigest()


@lru_cache(maxsize=1)
def _code() -> str:
    """Return a name of the code that makes the arrays: after an edit none of them is taken."""
    seen = hashlib.sha256()
    for package, names in (
        ("trocar.waves.mesh", None),
        ("trocar.waves", ("memory.py",)),
        ("trocar.tissues", ("layer.py",)),
        ("trocar", ("model.py",)),
    ):
        for file in sorted(files(package).iterdir(), key=lambda one: one.name):
            if file.name.endswith(".py") and (names is None or file.name in names):
                seen.update(file.name.encode() + file.read_bytes())
    return seen.hexdigest() + "".join(version(name) for name in ("numpy", "scipy", "scikit-fem"))
