"""A compiled loop that wakes at a rate and does nothing: what this machine does to any loop."""

from __future__ import annotations

import os
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import NamedTuple

from numba import njit

from trocar.errors import ServoError
from trocar.realtime.clock import now, sleep_until
from trocar.realtime.loop import SCHEDULED
from trocar.realtime.percentiles import IntArray, Pace, count_tick, unpaced
from trocar.realtime.privileges import claim, die_with_parent, ignore_interrupts

_AWAIT = 30.0  # [s] for a process that only has to end
_START = 120.0  # [s] for one that has to be compiled


class Empty(NamedTuple):
    """How it kept time: histograms (`percentiles`), due times skipped, whether it had a real-time class."""

    totals: IntArray
    missed: int
    scheduled: bool


def run_empty(period: int, seconds: float) -> Empty:
    """Run it in a process set up as the servo's is; call this from the main thread.

    Args:
        period: of a tick [ns].
        seconds: for how long.

    Raises:
        ServoError: it ended early.
    """
    context = get_context("spawn")
    results, sender = context.Pipe(duplex=False)
    ticks = round(1e9 * seconds / period)
    process = context.Process(target=_run, args=(period, ticks, sender), daemon=True)
    process.start()
    sender.close()
    try:
        if not results.poll(seconds + _START):
            raise ServoError("the empty loop: expected it to end, got nothing")
        found = Empty(*results.recv())
        process.join(_AWAIT)
    except EOFError:
        raise ServoError("the empty loop ended early") from None
    finally:
        if process.is_alive():
            process.kill()
            process.join()
        results.close()
    return found


def _run(period: int, ticks: int, results: Connection) -> None:
    ignore_interrupts()
    die_with_parent()
    wake(period, 0, unpaced())
    granted = claim()
    pace = unpaced()
    missed = wake(period, ticks, pace)
    results.send((pace.totals, missed, bool(granted & SCHEDULED)))
    os._exit(0)


@njit(cache=True, nogil=True)
def wake(period: int, ticks: int, pace: Pace) -> int:  # pragma: no cover - compiled
    """Wake at a rate and do nothing but keep count.

    Args:
        period: of a tick [ns].
        ticks: due times to go through.
        pace: overwritten.

    Returns:
        How many due times were skipped.
    """
    missed = 0
    due = now() + period
    end = due + ticks * period
    while due < end:
        sleep_until(due)
        woke = now()
        ended = now()
        late = (ended - due) // period
        missed += late
        count_tick(pace, due, woke, ended, late)
        due += (1 + late) * period
    return missed
