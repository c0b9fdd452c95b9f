"""Processor time of what is done once."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def timed(name: str, of: Callable[[], T]) -> T:
    """Print the processor time of a call; return what it returns."""
    began = time.process_time()
    found = of()
    print(f"  {name}: {time.process_time() - began:.1f} s", flush=True)
    return found
