"""Rigid tips pressed on a wave model, quasi-statically: how deep they go, and the dent they leave in every face.

A tip is covered with rings of pads (`waves.pads`). Under the depth d of a tip of shape s(r) the pads press and sink so
that none lies above the tip's face and none pulls (`contact.normal`), and d is what makes their forces add up to the
tool's. Pads end half their spacing inside the rim of a flat tip; on a sphere they follow the circle it touches, so
that a light touch is resolved as well as a deep one. Two tips are solved together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.contact.normal import press
from trocar.errors import SolverError
from trocar.model import FloatArray, Load, Press, Profile
from trocar.study.cases.tool import Tip, Tool
from trocar.waves.pads import Pads, Pressable

_RINGS = {Tip.FLAT: 6, Tip.SPHERE: 6}
_WIDTH = {Tip.FLAT: 0.55, Tip.SPHERE: 0.45}  # of a pad's Gaussian, in spacings: a 1 MPa block is met to 0.3 %
_AROUND = 1.15  # how far pads go beyond the circle a sphere is expected to touch
_WIDER = 1.5  # the next try where it touched further out
_FULL = 0.92  # a patch is too small where the tip touches more than this share of it, its last ring
_TIGHT = 0.6  # and where it touched less than this share, a closer one
_LEAST = 0.02  # of its own radius: a lighter touch of a sphere is not resolved further
_MOST_PATCHES = 12
_SUMS, _ROUNDING = 1e-9, 1e-13  # error of a tool's force, relative to itself and to the largest
_MOST_TRIES = 200


@dataclass(frozen=True, kw_only=True)
class Indentation:
    """Rigid tips in equilibrium.

    Attributes:
        depths: of each tip below the surface at rest [m], shape (tools,).
        touching: radius of the circle each tip touches [m], shape (tools,).
        pads: where they press.
        forces: of each pad [N], shape (n,).
    """

    depths: FloatArray
    touching: FloatArray
    pads: Pads
    forces: FloatArray

    def deflections(self, points: FloatArray) -> FloatArray:
        """Return the largest deflection of every face [m], shape (faces,): the top's at the pads, the rest at points.

        Under a flat tip a stiff skin may sink away from the middle, so the top's may exceed the tip's depth.
        """
        deepest: FloatArray = self.pads.deflection(self.forces, points).max(axis=1)
        deepest[0] = (self.pads.compliance @ self.forces).max()
        return deepest


class RigidTips:
    """The rigid tools of a case on one model.

    Args:
        model: a wave model.
        tools: rigid and upright, all of them.
    """

    def __init__(self, model: Pressable, tools: tuple[Tool, ...]) -> None:
        self._model, self._tools = model, tools
        self._expected = np.array([0.5 * tool.diameter for tool in tools])
        self._met = np.zeros(len(tools))  # the forces `_expected` was found at
        self._flat = Pads(model, *self._cover(self._expected, tools)) if self._all_flat else None

    @property
    def linear(self) -> bool:
        """Whether a depth grows with the force: one flat tip."""
        return self._all_flat and len(self._tools) == 1

    @property
    def _all_flat(self) -> bool:
        return all(tool.tip is Tip.FLAT for tool in self._tools)

    def press(self, forces: FloatArray) -> Indentation:
        """Find the equilibrium.

        Args:
            forces: of each tool [N], 0 or above, at least one above, shape (tools,).

        Raises:
            SolverError: no equilibrium was found.
        """
        radii = np.array([0.5 * tool.diameter for tool in self._tools])
        reach = radii.copy()
        for i, tool in enumerate(self._tools):
            if tool.tip is Tip.SPHERE and self._met[i] > 0 and forces[i] > 0:
                guess = _AROUND * self._expected[i] * (forces[i] / self._met[i]) ** (1 / 3)
                reach[i] = min(max(guess, _LEAST * radii[i]), radii[i])
        found = self._within(forces, reach)
        for _ in range(_MOST_PATCHES):
            sphere = np.array([tool.tip is Tip.SPHERE for tool in self._tools]) & (forces > 0)
            short = sphere & (found.touching >= reach * _FULL) & (reach < radii)
            loose = sphere & (found.touching < _TIGHT * reach) & (reach > _LEAST * radii)
            if not (short | loose).any():
                break
            reach = np.where(short, np.minimum(_WIDER * reach, radii), reach)
            reach = np.where(loose, np.maximum(_AROUND * found.touching, _LEAST * radii), reach)
            found = self._within(forces, reach)
        self._expected = np.where(forces > 0, found.touching, self._expected)
        self._met = np.where(forces > 0, forces, self._met)
        return found

    def load(self, forces: FloatArray) -> Load:
        """Return presses as wide as the circles that are touched: what to judge the linear range by."""
        found = self.press(forces)
        profiles = {Tip.FLAT: Profile.FLAT, Tip.SPHERE: Profile.SPHERE}
        return tuple(
            Press(
                x=tool.position[0], y=tool.position[1], radius=radius, force=force, profile=profiles[tool.tip]
            )
            for tool, radius, force in zip(self._tools, found.touching.tolist(), forces.tolist(), strict=True)
            if force > 0
        )

    def _cover(self, reach: FloatArray, tools: tuple[Tool, ...]) -> tuple[FloatArray, float]:
        """Return the pads' places, shape (n, 2), and width [m]; the finest tip sets the width of all."""
        widths = [
            _WIDTH[tool.tip] * r / (_RINGS[tool.tip] + 0.5) for tool, r in zip(tools, reach, strict=True)
        ]
        return np.concatenate([_ring_places(tool, r) for tool, r in zip(tools, reach, strict=True)]), min(
            widths
        )

    def _within(self, forces: FloatArray, reach: FloatArray) -> Indentation:
        pads = self._flat if self._flat is not None else Pads(self._model, *self._cover(reach, self._tools))
        counts = [_count(tool) for tool in self._tools]
        owner = np.repeat(np.arange(len(self._tools)), counts)
        away = [
            np.linalg.norm(_ring_places(t, r) - t.position, axis=1)
            for t, r in zip(self._tools, reach, strict=True)
        ]
        shape = np.concatenate([_rise(tool, r) for tool, r in zip(self._tools, away, strict=True)])
        here = forces[owner] > 0
        pressed = np.zeros(len(owner))
        depths = np.zeros(len(forces))
        active = forces > 0
        sums = (owner[here] == np.flatnonzero(active)[:, None]).astype(np.float64)
        pressed[here], depths[active] = _balanced(
            pads.compliance[np.ix_(here, here)], shape[here], sums, forces[active]
        )
        distances, spacings = (
            np.concatenate(away),
            reach / (np.array([_RINGS[t.tip] for t in self._tools]) + 0.5),
        )
        touching = np.array(
            [
                (distances[(owner == i) & (pressed > 0)].max() + 0.5 * spacings[i]) if active[i] else reach[i]
                for i in range(len(forces))
            ]
        )
        return Indentation(depths=depths, touching=touching, pads=pads, forces=pressed)


def _balanced(
    compliance: FloatArray, shape: FloatArray, sums: FloatArray, totals: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the pads' forces and the tips' depths whose pads' forces add up.

    The depths are where totals . depths - p W p/2 is largest, a concave function with the slope totals - sums p:
    Newton's method, its step halved until the function grows.
    """
    pads = len(shape)
    stiff = np.linalg.solve(compliance, np.column_stack([sums.T, shape]))
    depths = np.linalg.solve(sums @ stiff[:, :-1], totals + sums @ stiff[:, -1])  # as if all pads were held
    touching, forces = np.ones(pads, dtype=bool), np.empty(pads)
    holding, wrong = np.zeros(pads, dtype=bool), np.empty(pads, dtype=bool)
    factor, order = np.empty((pads, pads)), np.zeros(pads + 1, dtype=np.int64)
    exact = _SUMS * totals + _ROUNDING * totals.max()
    best, step = -np.inf, np.zeros_like(depths)
    for _ in range(_MOST_TRIES):
        if not press(compliance, sums.T @ depths - shape, holding, touching, forces, factor, order, wrong):
            break
        lacking = totals - sums @ forces
        if (np.abs(lacking) <= exact).all():
            return forces, np.asarray(depths, dtype=np.float64)
        value = float(totals @ depths - 0.5 * forces @ compliance @ forces)
        if value < best - 1e-12 * abs(best):
            step = 0.5 * step
            depths = depths - step
            continue
        best, own = value, sums[:, touching]
        slope = own @ np.linalg.solve(compliance[np.ix_(touching, touching)], own.T)
        # A tip that touches nowhere, over the dent of a heavier one, has no slope of its own: go down by a pad's worth.
        idle = ~own.any(axis=1)
        slope[idle, idle] = 1 / compliance.diagonal().max()
        step = np.linalg.solve(slope, lacking)
        gaps = compliance @ forces - sums.T @ depths + shape
        for tip in np.flatnonzero(idle):
            step[tip] += gaps[sums[tip] > 0].min()
        depths = depths + step
    raise SolverError("rigid contact: expected pads in equilibrium; take a larger tool or a smaller block")


def _count(tool: Tool) -> int:
    rings = _RINGS[tool.tip]
    return 1 + 3 * rings * (rings + 1)


def _ring_places(tool: Tool, reach: float) -> FloatArray:
    """Return one pad in the middle and 6 i on ring i, half a spacing short of the reach, shape (n, 2)."""
    rings = _RINGS[tool.tip]
    spacing = reach / (rings + 0.5)
    places = [(0.0, 0.0)]
    for ring in range(1, rings + 1):
        angles = 2 * np.pi * np.arange(6 * ring) / (6 * ring)
        places += [
            (ring * spacing * c, ring * spacing * s)
            for c, s in zip(np.cos(angles), np.sin(angles), strict=True)
        ]
    return np.asarray(np.array(tool.position) + np.array(places), dtype=np.float64)


def _rise(tool: Tool, away: FloatArray) -> FloatArray:
    """Return the tip's height above its lowest point [m] at distances from its axis."""
    if tool.tip is Tip.FLAT:
        return np.zeros_like(away)
    radius = 0.5 * tool.diameter
    return radius - np.sqrt(np.maximum(radius**2 - away**2, 0.0))
