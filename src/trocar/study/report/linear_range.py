"""What the report needs to know of whether a case lies inside the linear range."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol


class RangeVerdict(Protocol):
    """Whether small-strain results hold for a case, and by how much.

    Attributes:
        strain: the largest strain that counts [1].
        deflection_share: largest deflection over the block's thickness [1].
        slope: largest slope of the top face [1].
        inside: whether the case lies inside.
        limiting: which criterion decides, in a word or two.
        force_limit: the force at which the case would leave the range [N].
    """

    @property
    def strain(self) -> float: ...  # noqa: D102 - described above
    @property
    def deflection_share(self) -> float: ...  # noqa: D102
    @property
    def slope(self) -> float: ...  # noqa: D102
    @property
    def inside(self) -> bool: ...  # noqa: D102
    @property
    def limiting(self) -> str: ...  # noqa: D102
    @property
    def force_limit(self) -> float: ...  # noqa: D102


Ranges = Mapping[str, RangeVerdict]
"""By case: "small", "paper", "tilted", "pair", "tap"."""
