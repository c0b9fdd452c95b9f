"""What the servo's process asks of Linux before its loop begins, and what it got; nothing here is needed to run.

- a real-time scheduling class, so that no ordinary program delays a tick;
- its memory kept in memory, so that no page fault does;
- timers that are not put off by 50 us to save wake-ups.

A user's account has the first two only where the administrator grants them (`rtprio` and `memlock` in
/etc/security/limits.conf).
"""

from __future__ import annotations

import ctypes
import gc
import os
import signal
from contextlib import suppress

from trocar.realtime.loop import IN_MEMORY, SCHEDULED, SHARP_TIMER

PRIORITY = 60  # of 1 to 99; above the interrupt threads, which have 50
_PR_SET_PDEATHSIG, _PR_SET_TIMERSLACK = 1, 29  # linux/prctl.h
_MCL_CURRENT, _MCL_ONFAULT = 1, 4  # linux/mman.h: lock what is touched, do not fetch the rest


def die_with_parent() -> None:
    """Be killed when the thread that started this process ends."""
    _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def ignore_interrupts() -> None:
    """Leave Ctrl-C to the parent, which stops this process in good order."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])


def claim(*, scheduled: bool = True) -> int:
    """Ask for everything.

    Args:
        scheduled: whether to ask for a real-time class too.

    Returns:
        The bits of `loop` that say what was granted.
    """
    granted = 0
    gc.collect()
    gc.freeze()
    gc.disable()
    if scheduled:
        with suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
            granted |= SCHEDULED
    if _library().mlockall(_MCL_CURRENT | _MCL_ONFAULT) == 0:
        granted |= IN_MEMORY
    if _prctl(_PR_SET_TIMERSLACK, 1):
        granted |= SHARP_TIMER
    return granted


def _prctl(option: int, value: int) -> bool:
    number = ctypes.c_ulong
    zero = number(0)
    return bool(_library().prctl(option, number(value), zero, zero, zero) == 0)


def _library() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)
