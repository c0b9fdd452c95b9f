"""What the servo moves: three compiled functions, handed to the compiled loop as pointers.

A compiled function that calls another by name carries a copy of it in its cache file, and would go on using that copy
after the other has changed. By pointer, the loop is compiled once for each kind of scene and found again in the cache
whatever becomes of the physics, and a test can give it physics of its own. Each physics has a cache file of its own:
numba cannot read a file that names types it cannot import.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from types import FunctionType
from typing import Any

from numba import njit, types

from trocar.simulation.kind import TISSUE, Kind


@dataclass(frozen=True, kw_only=True)
class Physics:
    """The functions of a simulation, compiled by numba at the top level of a module; pickled by their names.

    Attributes:
        advance: (scene, state, poses, records) -> bool: one tick; False when something was not finite.
        amplitudes: (scene, state, out) -> None: writes what is shown.
        come_to_rest: (scene, state) -> None.
    """

    advance: Any
    amplitudes: Any
    come_to_rest: Any

    def __reduce__(self) -> tuple[Callable[..., Physics], tuple[str, ...]]:
        functions = (self.advance, self.amplitudes, self.come_to_rest)
        return _found, tuple(f"{one.py_func.__module__}:{one.py_func.__name__}" for one in functions)


def live() -> Physics:
    """Return the physics of `trocar.simulation`."""
    return physics_of(TISSUE)


def physics_of(kind: Kind) -> Physics:
    """Return what moves a kind of scene."""
    return Physics(advance=kind.advance, amplitudes=kind.amplitudes, come_to_rest=kind.come_to_rest)


class Pointer(types.WrapperAddressProtocol):
    """A compiled function as a first-class value of compiled code.

    Args:
        function: compiled by numba.
        arguments: numba's types of its arguments; it is compiled for them, or found in its cache.
    """

    def __init__(self, function: Any, arguments: tuple[Any, ...]) -> None:
        self._result = compiled(function, arguments)

    def __wrapper_address__(self) -> int:
        name = self._result.fndesc.llvm_cfunc_wrapper_name
        return int(self._result.library.get_pointer_to_function(name))

    def signature(self) -> Any:
        """Return numba's signature."""
        return self._result.signature


def compiled(function: Any, arguments: tuple[Any, ...]) -> Any:
    """Compile a function, or find it in its cache; a cache that cannot be read any more is written anew.

    Args:
        function: decorated by numba.
        arguments: numba's types.

    Returns:
        Numba's result.
    """
    try:
        function.compile(arguments)
    except (ImportError, AttributeError):  # it names a type that has moved since
        function._cache.flush()
        function.compile(arguments)
    return function.overloads[arguments]


def with_own_cache(function: Any, physics: Physics) -> Any:
    """Return a compiled function whose cache file is this physics' own.

    Args:
        function: not decorated yet.
        physics: by whose `advance` the file is named.
    """
    owner = f"{physics.advance.py_func.__module__}_{physics.advance.py_func.__name__}".replace(".", "_")
    own = FunctionType(function.__code__, function.__globals__, function.__name__)
    own.__qualname__ = f"{function.__name__}_{owner}"
    own.__module__ = function.__module__
    return njit(cache=True, nogil=True)(own)


def _found(*names: str) -> Physics:
    advance, amplitudes, come_to_rest = (
        getattr(import_module(module), name) for module, name in (one.split(":") for one in names)
    )
    return Physics(advance=advance, amplitudes=amplitudes, come_to_rest=come_to_rest)
