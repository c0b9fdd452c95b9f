"""What every statistic asks of its samples: one dimension, finite, enough of them."""

from __future__ import annotations

from math import isfinite

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.model import FloatArray

FEWEST = 3  # a mean, a spread and one degree of freedom to test them with


def samples(name: str, values: npt.ArrayLike) -> FloatArray:
    """Return finite samples as an array of shape (n,), n at least 3.

    Raises:
        InputError: they are not numbers, not one-dimensional, fewer than 3 or not finite.
    """
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(name, "numbers", values) from None
    if array.ndim != 1 or array.size < FEWEST:
        raise InputError(name, f"at least {FEWEST} samples in one dimension", array.shape)
    if not np.all(np.isfinite(array)):
        raise InputError(name, "finite samples", float(array[~np.isfinite(array)][0]))
    return array


def pairs(
    first_name: str, first: npt.ArrayLike, second_name: str, second: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return two samples of equal length, as `samples` does each.

    Raises:
        InputError: one of them is refused, or their lengths differ.
    """
    one, two = samples(first_name, first), samples(second_name, second)
    if one.size != two.size:
        raise InputError(second_name, f"as many samples as {first_name} ({one.size})", two.size)
    return one, two


def require(name: str, value: float, holds: bool, expected: str) -> None:
    """Refuse a number that is not finite or not as expected.

    Raises:
        InputError: naming it.
    """
    if not (isfinite(value) and holds):
        raise InputError(name, expected, value)


def without_rounding(deviations: FloatArray, scale: float) -> FloatArray:
    """Return deviations with those that are only rounding of numbers of size `scale` set to 0.

    A constant curve such as 0.1, 0.1, 0.1 has a mean one rounding away from 0.1; its spread is 0.
    """
    return np.where(np.abs(deviations) <= 8 * np.finfo(np.float64).eps * abs(scale), 0.0, deviations)
