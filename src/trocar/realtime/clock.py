"""The clock of the servo, for compiled code: CLOCK_MONOTONIC, sleeping until a time of it, and memory fences.

The functions of the C library are called by their names, so a function that uses them can be cached. The clock is
one for all processes of a machine, never goes back, and stands still while the machine is suspended. Linux alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils as untyped_cgutils
from numba.extending import intrinsic

SECOND = 1_000_000_000  # [ns]
_CLOCK_MONOTONIC = 1
_TIMER_ABSTIME = 1
_INT = ir.IntType(32)
_LONG = ir.IntType(64)
_TIMESPEC = ir.LiteralStructType([_LONG, _LONG])  # seconds, nanoseconds: on every 64-bit Linux

cgutils: Any = untyped_cgutils
_Lowered = tuple[Any, Callable[..., Any]]
parent_process = types.ExternalFunction("getppid", types.int32())


def _lower_fence(_typing: Any) -> _Lowered:
    def lower(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        builder.fence("seq_cst")
        return context.get_dummy_value()

    return types.void(), lower


def _lower_monotonic(_typing: Any) -> _Lowered:
    def lower(_context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        time = cgutils.alloca_once(builder, _TIMESPEC)
        kind = ir.FunctionType(_INT, [_INT, _TIMESPEC.as_pointer()])
        read = cgutils.get_or_insert_function(builder.module, kind, "clock_gettime")
        builder.call(read, [_INT(_CLOCK_MONOTONIC), time])
        seconds, rest = (builder.load(cgutils.gep_inbounds(builder, time, 0, part)) for part in (0, 1))
        return builder.add(builder.mul(seconds, _LONG(SECOND)), rest)

    return types.int64(), lower


def _lower_sleep(_typing: Any, _due: Any) -> _Lowered:
    def lower(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        time = cgutils.alloca_once(builder, _TIMESPEC)
        (due,) = arguments
        parts = builder.sdiv(due, _LONG(SECOND)), builder.srem(due, _LONG(SECOND))
        for part, value in enumerate(parts):
            builder.store(value, cgutils.gep_inbounds(builder, time, 0, part))
        kind = ir.FunctionType(_INT, [_INT, _INT, _TIMESPEC.as_pointer(), _TIMESPEC.as_pointer()])
        sleep = cgutils.get_or_insert_function(builder.module, kind, "clock_nanosleep")
        nothing = ir.Constant(_TIMESPEC.as_pointer(), None)
        return builder.call(sleep, [_INT(_CLOCK_MONOTONIC), _INT(_TIMER_ABSTIME), time, nothing])

    return types.int32(types.int64), lower


# fence() lets no read or write pass it, in either direction (sequentially consistent).
fence: Any = intrinsic(_lower_fence)
_monotonic: Any = intrinsic(_lower_monotonic)
_sleep: Any = intrinsic(_lower_sleep)


@njit(cache=True, nogil=True)
def now() -> int:  # pragma: no cover - compiled
    """Return the time [ns]."""
    return int(_monotonic())


@njit(cache=True, nogil=True)
def sleep_until(due: int) -> None:  # pragma: no cover - compiled
    """Sleep until a time [ns]; return at once if it has passed. A signal does not end the sleep."""
    while now() < due:
        _sleep(due)
