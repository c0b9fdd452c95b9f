"""What the validation study does: the paper's protocol, with what it left open filled in and stated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import radians

from trocar.errors import InputError
from trocar.model import Support
from trocar.study.cases.experiment import Case, case_from_tissue
from trocar.study.cases.quantity import LEAST_TOOL_RATIO
from trocar.study.cases.tool import Tool
from trocar.tissues.catalogue import tissue as preset
from trocar.tissues.tissue import Tissue
from trocar.units import MILLIMETRE

BLOCK = (60 * MILLIMETRE, 60 * MILLIMETRE)  # Table 1 of the paper
RATE = 0.05  # [N/s], section 5.2
PERIOD = 2.5  # [s] over 200 s this gives the 81 samples that the paper's t critical implies
PAIR = (0.35, 0.65)  # of the block's length: where two tools stand
TAP = 0.01  # [s] to the peak and again back, for the comparison in time


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The choices of one study.

    Args:
        tissue: name of a preset, or a tissue file.
        support: of the block everything but the table of supports is shown for.
        diameter: of the tool [m]; the paper says 5 to 8 mm.
        peak: the paper's load [N].
        small: a load inside the linear range [N].
        tilt: of the tilted tool [rad].
        quick: coarser meshes, fewer pictures.

    Raises:
        InputError: a value is impossible.
    """

    tissue: str = "skin"
    support: Support = Support.BASE
    diameter: float = 6 * MILLIMETRE
    peak: float = 5.0
    small: float = 0.05
    tilt: float = radians(30)
    quick: bool = False

    def __post_init__(self) -> None:
        if not 0 < self.small <= self.peak:
            raise InputError(
                "study: small load", f"above 0 and at most the peak, {self.peak:g} N", self.small
            )
        least, most = LEAST_TOOL_RATIO * max(BLOCK), 2 * min(PAIR) * BLOCK[0]
        if not least <= self.diameter <= most:
            raise InputError(
                "study: diameter of the tool",
                f"from {least / MILLIMETRE:g} to {most / MILLIMETRE:g} mm, so that two of them fit on the block",
                self.diameter / MILLIMETRE,
            )

    def central(self, peak: float, support: Support | None = None) -> Case:
        """Return the paper's load with another peak [N] in the middle of the block."""
        return self._case(f"{peak:g} N in the middle", (self._tool(peak),), support)

    def tilted(self) -> Case:
        """Return one tool leaning along x."""
        return self._case("one tool at an angle", (replace(self._tool(self.small), tilt=self.tilt),))

    def pair(self) -> Case:
        """Return two tools, left and right of the middle."""
        a, b = BLOCK
        tools = tuple(replace(self._tool(self.small), position=(share * a, b / 2)) for share in PAIR)
        return self._case("two tools", tools)

    @property
    def layers(self) -> Tissue:
        """The tissue, with its laws for large strain."""
        return preset(self.tissue)

    def tap(self) -> Case:
        """Return a tap of 20 ms and the rest after it."""
        tool = replace(self._tool(self.small), rate=self.small / TAP)
        case = self._case("a tap of 20 ms", (tool,))
        return replace(
            case, sampling=replace(case.sampling, period=TAP / (10 if self.quick else 20), dynamic=True)
        )

    def _tool(self, peak: float) -> Tool:
        a, b = BLOCK
        return Tool(diameter=self.diameter, position=(a / 2, b / 2), peak=peak, rate=RATE)

    def _case(self, title: str, tools: tuple[Tool, ...], support: Support | None = None) -> Case:
        """Return a case; laws for large strain are for pressing hard, and where sides are clamped nothing relaxes."""
        duration = max(tool.duration for tool in tools)
        support = support or self.support
        layers = self.layers.linearised
        return case_from_tissue(
            tissue=layers.long_term if support.sides_clamped else layers,
            size=BLOCK,
            tools=tools,
            support=support,
            period=min(PERIOD, duration / 80),
            title=title,
        )
