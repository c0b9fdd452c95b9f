"""The figures that the live contact is held to, each with its bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import trocar
from trocar.contact.instrument import TipKind
from trocar.model import Support
from trocar.study.contact.motions import pressed, slid, stopped
from trocar.study.contact.passivity import ROUNDING, passivity
from trocar.study.contact.scenes import BLOCK, MODES, SIZE, Setting, setting, upright
from trocar.waves.solid import WaveSolid

WEAK = 0.2  # of the contact's compliance, left in the negative control
_CONTROLS = 8  # trajectories of it
_SKIN_DEPTHS = (0.7e-3, 1.0e-3, 1.25e-3)  # [m]; 0.05 to 0.1 N, the top of the linear range
_BLOCK_DEPTHS = (0.33e-3, 0.7e-3, 1.08e-3)  # [m]; 0.5 to 3 N
_STOP = 1e-3  # [m]
_FINE = 1e-5  # [s] a tick of the reference
_SPEED, _DEPTH = 0.1, 1e-3  # [m/s], [m] of the slide
# Stored energy less work may grow by rounding alone, but for the ticks in which a tip comes upon surface it did not
# hold before: when it meets a wave, when it jumps, when it is dragged in over a side of the block. How much such a tick
# may make, of what is stored, and the share of trajectories that may have any.
RISES = {"jerk": 1e-3, "zigzag": ROUNDING, "sine": 1e-3, "rim": 0.1}
RISING = {"jerk": 0.02, "zigzag": 0.0, "sine": 0.005, "rim": 0.5}


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One figure.

    Attributes:
        name: what it is, units included.
        value: what was found.
        bound: what it may be at most; at least, for a control.
        control: whether it must exceed the bound, to show that the check notices.
    """

    name: str
    value: float
    bound: float
    control: bool = False

    @property
    def kept(self) -> bool:
        """Whether the bound holds."""
        return self.value > self.bound if self.control else self.value <= self.bound


def contact_figures(
    trajectories: int, *, seed: int = 0, tell: Callable[[int], None] | None = None
) -> list[Figure]:
    """Measure all of them.

    Args:
        trajectories: random ones of two instruments on undamped skin.
        seed: of the first.
        tell: called with the number of trajectories done.
    """
    return [*energy_figures(undamped_settings(), trajectories, seed=seed, tell=tell), *motion_figures()]


def undamped_settings() -> list[Setting]:
    """Return skin that loses nothing, under the usual pair and under upright others."""
    usual = setting(trocar.tissue("skin"), undamped=True)
    others = upright((TipKind.HOOK, TipKind.NEEDLE_HOLDER), ((0.025, 0.03), (0.035, 0.03)))
    return [usual, usual.with_instruments(others)]


def energy_figures(
    settings: list[Setting],
    trajectories: int,
    *,
    seed: int = 0,
    tell: Callable[[int], None] | None = None,
) -> list[Figure]:
    """Return energy that was generated, over what was stored, by kind of trajectory; and the negative control's."""
    figures = []
    for found in passivity(settings, trajectories, seed=seed, tell=tell):
        name = f"{found.kind}, {found.trajectories} trajectories"
        figures += [
            Figure(name=f"{name}: stored beyond all work, share", value=found.above, bound=0.0),
            Figure(name=f"{name}: generated, share of stored", value=found.rise, bound=RISES[found.kind]),
            Figure(name=f"{name}: share of them with any", value=found.rising, bound=RISING[found.kind]),
            Figure(name=f"{name}: not finite", value=float(not found.finite), bound=0.0),
        ]
    weak = passivity([weakened(settings[0])], _CONTROLS, seed=seed)
    figures += [
        Figure(
            name=f"control, contact's compliance times {WEAK}, {found.kind}: generated",
            value=found.rise,
            bound=1e4 * ROUNDING,
            control=True,
        )
        for found in weak
        if found.kind == "sine"
    ]
    return figures


def weakened(one: Setting) -> Setting:
    """Return a setting whose contact law believes the surface to give way less than it does."""
    tick = one.scene.tick._replace(at_once=one.scene.tick.at_once * WEAK)
    scene = one.scene._replace(tick=tick, own=one.scene.own * WEAK, near=one.scene.near * WEAK)
    return replace(one, scene=scene)


def motion_figures() -> list[Figure]:
    """Return the figures of single motions, on skin and on a block of 1 MPa."""
    skin, block = (setting(tissue, instruments=upright()) for tissue in (trocar.tissue("skin"), BLOCK))
    figures = []
    for name, one, depths in (("skin", skin, _SKIN_DEPTHS), ("block", block, _BLOCK_DEPTHS)):
        solid = WaveSolid(one.tissue, size=SIZE, modes=MODES, support=Support.BASE)
        for depth in depths:
            found = pressed(one, depth)
            other = pressed(one, depth, judge=solid)
            at = f"{name}, {found.force:.2g} N"
            figures += [
                Figure(name=f"{at}: depth against rigid, share", value=abs(found.error), bound=0.01),
                Figure(name=f"{at}: against WaveSolid's rigid, share", value=abs(other.error), bound=0.05),
                Figure(name=f"{at}: penetration [mm]", value=1e3 * found.penetration, bound=0.05),
            ]
    damped = stopped(skin, _STOP)
    figures.append(Figure(name="stopped from 1 m/s: ripple, share", value=damped.ripple, bound=0.05))
    bare = setting(trocar.tissue("skin"), instruments=upright(), undamped=True)
    coarse, fine = stopped(bare, _STOP), stopped(bare.with_instruments(bare.instruments, dt=_FINE), _STOP)
    beyond = max(fine.least - coarse.least, coarse.most - fine.most) / (fine.most - fine.least)
    figures.append(
        Figure(name="the same undamped: beyond the range in 10 us ticks, share", value=beyond, bound=0.2)
    )
    slide = slid(skin, _DEPTH, _SPEED)
    figures += [
        Figure(name="slid at 100 mm/s: ratchet of the normal force, share", value=slide.ratchet, bound=0.01),
        Figure(name="slid at 100 mm/s: ratchet of the drag, share", value=slide.ratchet_aside, bound=0.01),
    ]
    return figures


def contact_table(figures: list[Figure]) -> str:
    """Return lines of name, value, bound."""
    width = max(len(figure.name) for figure in figures)
    return "\n".join(
        f"{figure.name:<{width}}  {figure.value:9.2e}  {'above' if figure.control else 'at most'} {figure.bound:g}"
        f"{'' if figure.kept else '  MISSED'}"
        for figure in figures
    )
