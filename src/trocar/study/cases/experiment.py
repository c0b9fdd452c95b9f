"""One experiment: a block or a mesh of tissue, how it is held, one or two tools, and when to look.

A force goes up at the tool's rate, holds, comes down at the same rate and stays away. Between corners it is
linear in time, so a model whose step is exact for linear loads needs only the corners and the samples.

Read from TOML by `trocar.study.cases.reading.load_case`, or made in code by `case_from_tissue`. Everything is in SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, hypot, isfinite

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Support
from trocar.study.cases import quantity as q
from trocar.study.cases.tool import Contact, Tool
from trocar.tissues import Tissue
from trocar.tissues.key_quantity import MOST_LAYERS
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.footprint import laid
from trocar.waves.mesh.solid_mesh import SolidMesh

SAME_TIME = 1e-13  # relative: sums of three times carry a few rounding errors of 1e-16 each
SAME_PLACE = 1e-9  # relative to the side: rounding of unit conversion, far below any mesh or mode


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """Say when results are wanted.

    Args:
        period: between samples [s].
        dynamic: whether inertia and Kelvin-Voigt damping count; else the load is followed through equilibria, which a
            Prony series delays.

    Raises:
        InputError: the period is outside its range.
    """

    period: float = 1.0
    dynamic: bool = False

    def __post_init__(self) -> None:
        q.PERIOD.check("sampling: period", self.period)


@dataclass(frozen=True, kw_only=True)
class Case:
    """Describe one experiment.

    Args:
        title: what reports call it.
        tissue: the layers, top first.
        size: sides of the block along x and y [m].
        support: how the block is held.
        tools: one or two.
        sampling: when to look.
        mesh: of any shape, in the place of a block: size and support are its own, each of the layers is a material of
            it, and tools press its first surface where they are seen from above. None: a block.

    Raises:
        InputError: the parts are impossible together; `where` is a key path without unit, such as
            "tool[0].position", the numbers in the message are in the units of a case file.
    """

    title: str
    tissue: Tissue
    size: tuple[float, float]
    support: Support
    tools: tuple[Tool, ...]
    sampling: Sampling = Sampling()
    mesh: SolidMesh | None = None

    def __post_init__(self) -> None:
        if self.mesh is None:
            for side in self.size:
                q.SIDE.check("block.size", side)
        elif self.size != self.mesh.size or self.support is not self.mesh.support:
            raise InputError("block", "the mesh's own size and support", (self.size, self.support.value))
        self._check_layers()
        self._check_tools()
        self._check_sampling()

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the faces that are looked at: the layers' upper ones, or a mesh's surfaces."""
        return self.tissue.layer_names if self.mesh is None else tuple(self.mesh.surfaces)

    @property
    def duration(self) -> float:
        """Time of the last release [s]."""
        return max(tool.duration for tool in self.tools)

    @property
    def peak_force(self) -> float:
        """Largest force of one tool along its axis [N]."""
        return max(tool.peak for tool in self.tools)

    @property
    def rigid(self) -> bool:
        """Whether the tools keep their shape; else they are dead loads."""
        return self.tools[0].contact is Contact.RIGID

    def load_at(self, time: float) -> Load:
        """Return one press per tool at `time` [s], always all of them, without force where a tool is away.

        Raises:
            InputError: the time is not finite.
        """
        if not isfinite(time):
            raise InputError("time", "a finite number of seconds", time)
        return tuple(tool.press(tool.force(time)) for tool in self.tools)

    def corners(self) -> FloatArray:
        """Return the times [s] at which a force changes its slope, ascending, first 0, last the end."""
        times = np.unique([time for tool in self.tools for time in tool.corners()])
        times = times[times < self.duration * (1 - SAME_TIME)]
        apart = np.diff(times, prepend=-1.0) > SAME_TIME * times
        return np.append(times[apart], self.duration)

    def sample_times(self) -> FloatArray:
        """Return 0, every multiple of the period, every corner and the end, ascending, each once [s].

        A multiple that differs from a corner only by rounding is that corner.
        """
        corners = self.corners()
        count = floor(self.duration / self.sampling.period)
        multiples = np.arange(count + 1, dtype=np.float64) * self.sampling.period
        multiples = multiples[multiples < self.duration]
        after = np.searchsorted(corners, multiples)  # at most the last corner, the end
        gap = np.minimum(corners[after] - multiples, np.abs(multiples - corners[np.maximum(after - 1, 0)]))
        return np.sort(np.concatenate([corners, multiples[gap > SAME_TIME * multiples]]))

    def _check_layers(self) -> None:
        layers = self.tissue.layers
        if len(layers) > MOST_LAYERS:
            raise InputError("layer", f"at most {MOST_LAYERS} layers", len(layers))
        for i, layer in enumerate(layers):
            for item in q.LAYER:
                item.check(f"layer[{i}].{item.name}", getattr(layer, item.name))
            for prestress in (layer.prestress_x, layer.prestress_y):
                q.PRESTRESS.check(f"layer[{i}].prestress", prestress)

        soft = min(range(len(layers)), key=lambda i: layers[i].young_modulus)
        stiffest = max(
            max(
                layer.instantaneous_modulus,
                layer.prestress_x,
                layer.prestress_y,
                getattr(layer.law, "k1", 0.0),
            )
            for layer in layers
        )
        stiffness_ratio = stiffest / layers[soft].young_modulus
        if stiffness_ratio > q.MOST_STIFFNESS_RATIO:
            raise InputError(
                f"layer[{soft}].young_modulus",
                f"every modulus, k1 and prestress at most {q.MOST_STIFFNESS_RATIO:g} times this one",
                stiffness_ratio,
                "such a contrast cannot be solved in double precision",
            )
        thin = min(range(len(layers)), key=lambda i: layers[i].thickness)
        thickness_ratio = max(layer.thickness for layer in layers) / layers[thin].thickness
        if thickness_ratio > q.MOST_THICKNESS_RATIO * (1 + SAME_PLACE):
            raise InputError(
                f"layer[{thin}].thickness",
                f"the thickest layer at most {q.MOST_THICKNESS_RATIO:g} times this one",
                thickness_ratio,
                "leave the thin layer out or join it to its neighbour",
            )
        if self.mesh is not None:
            return
        thick = max(range(len(layers)), key=lambda i: layers[i].thickness)
        slenderness = self.tissue.thickness / min(self.size)
        least, most = q.LEAST_SLENDERNESS * (1 - SAME_PLACE), q.MOST_SLENDERNESS * (1 + SAME_PLACE)
        if not least <= slenderness <= most:
            raise InputError(
                f"layer[{thick}].thickness",
                f"all layers {q.LEAST_SLENDERNESS:g} to {q.MOST_SLENDERNESS:g} times the shorter side thick",
                slenderness,
                "change the thickness or block.size_mm",
            )

    def _check_tools(self) -> None:
        if not 1 <= len(self.tools) <= q.MOST_TOOLS:
            raise InputError("tool", f"1 to {q.MOST_TOOLS} tools", len(self.tools))
        for i, tool in enumerate(self.tools):
            if tool.diameter < q.LEAST_TOOL_RATIO * max(self.size) * (1 - SAME_PLACE):
                raise InputError(
                    f"tool[{i}].diameter",
                    f"at least {q.LEAST_TOOL_RATIO:g} of the longer side",
                    tool.diameter / q.DIAMETER.factor,
                    "take a smaller block",
                )
            if self.mesh is not None:
                continue
            for axis, centre, half, side in zip(
                "xy", tool.position, tool.half_extent, self.size, strict=True
            ):
                slack = SAME_PLACE * side
                if half - slack <= centre <= side - half + slack:
                    continue
                low, high, at = (f"{1e3 * value:.6g}" for value in (half, side - half, centre))
                raise InputError(
                    f"tool[{i}].position",
                    f"a footprint wholly on the block, {axis} from {low} to {high} mm"
                    if half <= side - half
                    else f"a footprint no longer than the block ({1e3 * side:.6g} mm along {axis})",
                    float(at) if half <= side - half else 2 * float(low),
                    "move the tool, or take a smaller or less tilted one",
                )

        if self.mesh is not None:
            self._check_on_mesh(self.mesh)
        if len({tool.contact for tool in self.tools}) > 1:
            raise InputError(
                "tool[1].contact",
                f'"{self.tools[0].contact}", as the first tool',
                self.tools[1].contact.value,
            )

        if self.rigid and len(self.tools) == 2:
            apart = hypot(
                *(a - b for a, b in zip(self.tools[0].position, self.tools[1].position, strict=True))
            )
            least = 0.5 * (self.tools[0].diameter + self.tools[1].diameter)
            if apart < least * (1 - SAME_PLACE):
                raise InputError(
                    "tool[1].position",
                    f"at least {1e3 * least:.6g} mm from the first tool: rigid tips do not overlap",
                    float(f"{1e3 * apart:.6g}"),
                )

    def _check_on_mesh(self, mesh: SolidMesh) -> None:
        elements = Elements(mesh)
        for i, tool in enumerate(self.tools):
            if tool.contact is Contact.RIGID:
                raise InputError(f"tool[{i}].contact", '"dead" on a mesh', tool.contact.value)
            try:
                laid(tool.press(tool.peak), elements, self.faces[0])
            except InputError as error:
                expected = f"a footprint wholly on the mesh: {error.expected}"
                raise InputError(f"tool[{i}].position", expected, error.got, error.advice) from None

    def _check_sampling(self) -> None:
        if self.rigid and self.tissue.relaxation_times:
            raise InputError(
                "tool[0].contact", '"dead" where a layer has a Prony series', "rigid", "leave prony out"
            )
        if self.sampling.dynamic and self.rigid:
            raise InputError("sampling.dynamic", "false with a rigid tip", True, 'or take contact = "dead"')
        wanted = self.duration / self.sampling.period
        if wanted > q.MOST_SAMPLES:
            raise InputError(
                "sampling.period",
                f"at most {q.MOST_SAMPLES} samples in {self.duration:g} s",
                self.sampling.period,
                f"use a period of at least {self.duration / q.MOST_SAMPLES:.3g} s",
            )


def case_from_tissue(
    *,
    tissue: Tissue,
    size: tuple[float, float],
    tools: tuple[Tool, ...],
    support: Support | str = Support.BASE,
    period: float = 1.0,
    dynamic: bool = False,
    title: str = "",
) -> Case:
    """Make a case from a tissue, such as a preset.

    Args:
        tissue: the layers, top first.
        size: sides of the block along x and y [m].
        tools: one or two.
        support: how the block is held.
        period: between samples [s].
        dynamic: whether inertia and damping count.
        title: what reports call it; the tissue's name where empty.

    Raises:
        InputError: a value is impossible, by itself or with the others.
    """
    if support not in tuple(Support):
        raise InputError("block.support", " or ".join(f'"{kind}"' for kind in Support), support)
    return Case(
        title=title or tissue.name,
        tissue=tissue,
        size=size,
        support=Support(support),
        tools=tools,
        sampling=Sampling(period=period, dynamic=dynamic),
    )
