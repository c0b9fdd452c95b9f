"""Results as plain values for JSON: dictionaries, lists, numbers that are finite, text."""

from __future__ import annotations

from enum import Enum
from math import isfinite


def plain(value: object) -> object:
    """Return a value as JSON takes it: tuples as lists, enums as their values, what is not finite as None."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, float):
        return float(value) if isfinite(value) else None
    return value
