"""A tip pressed and held, pushed at speed and stopped, and slid along: what the live contact makes of each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.simulation import FORCE, SceneState, amplitudes, at_rest, line, played, poses_along
from trocar.study.cases.tool import Contact, Tip, Tool
from trocar.study.contact.scenes import Setting
from trocar.study.rigid import RigidTips
from trocar.waves.near_field import SMOOTH, layered_compliance, near_field
from trocar.waves.pads import Pressable

OVER = 3e-3  # [m] above the surface, where a tip comes from
_LOWERING, _RESTING = 800, 1200  # ticks down, and until it is still
_SIDE = 57  # places along a side, of a grid under a tip
_SHARE = 0.97  # of a tip's radius that is looked at: at the rim the underside is upright
_SPEED = 1.0  # [m/s] into the surface
_FROM, _UNTIL = 22e-3, 42e-3  # [s] after the stop, where the force is looked at


@dataclass(frozen=True, kw_only=True)
class Static:
    """A probe pressed straight down and held.

    Attributes:
        force: along z [N].
        depth: of its lowest point [m].
        rigid: depth of a rigid sphere of its radius under the same force, as `compare` has it [m].
        penetration: the most the surface reaches into the tip [m].
    """

    force: float
    depth: float
    rigid: float
    penetration: float

    @property
    def error(self) -> float:
        """How much deeper it goes than the rigid sphere, relative [1]."""
        return self.depth / self.rigid - 1


def pressed(one: Setting, depth: float, *, judge: Pressable | None = None) -> Static:
    """Press the right instrument, an upright probe in the middle of the block, and hold it.

    Args:
        one: whose right instrument is an upright probe over the middle.
        depth: [m].
        judge: a model whose `RigidTips` is compared with; the setting's own by default.
    """
    x, y = one.model.size[0] / 2, one.model.size[1] / 2
    down = line((x, y, OVER), (x, y, -depth), _LOWERING)
    way = np.concatenate([down, np.repeat(down[-1:], _RESTING, axis=0)])
    state = at_rest(one.scene)
    records = played(one.scene, poses_along(one.instruments, (None, way)), state)
    force = float(records[-1, 1, FORCE + 2])
    radius = float(one.scene.axes[1, 0])
    tool = Tool(
        diameter=2 * radius,
        position=(x, y),
        peak=force,
        rate=1.0,
        tip=Tip.SPHERE,
        contact=Contact.RIGID,
    )
    rigid = RigidTips(judge or one.model, (tool,)).press(np.array([force]))
    return Static(
        force=force,
        depth=depth,
        rigid=float(rigid.depths[0]),
        penetration=penetration(one, state, 1, (x, y), depth),
    )


def penetration(one: Setting, state: SceneState, t: int, place: tuple[float, float], depth: float) -> float:
    """Return the most the surface reaches into an upright probe [m], looked at between its points too.

    Args:
        one: the setting.
        state: at the end of a tick.
        t: number of the instrument.
        place: of its lowest point, at rest x, y [m].
        depth: of its lowest point [m].
    """
    radius = float(one.scene.axes[t, 0])
    grid = np.linspace(-radius, radius, _SIDE)
    away = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    away = away[np.linalg.norm(away, axis=1) < _SHARE * radius]
    sunk = surface(one, state, t, place, away)
    rise = radius - np.sqrt(radius**2 - (away**2).sum(axis=1))
    return float(max((depth - rise - sunk).max(), 0.0))


def surface(
    one: Setting, state: SceneState, t: int, place: tuple[float, float], away: FloatArray
) -> FloatArray:
    """Return how deep the top face lies at distances from a place [m], near field of one patch and the waves.

    Args:
        one: the setting.
        state: at the end of a tick.
        t: number of the instrument whose near field is added.
        place: rest place under it, x, y [m].
        away: from there, shape (n, 2) [m].
    """
    scene = one.scene
    waves = np.zeros((scene.layers, *scene.modes))
    amplitudes(scene, state, waves)
    offsets = scene.tick.offsets[t]
    width = 0.4 * float(offsets[1] - offsets[0])
    field = near_field(
        lambda k: layered_compliance(one.tissue, k, base_held=True, finest=width),
        pad=width,
        window=SMOOTH,
        reach=7 * SMOOTH,
    )
    shapes = []
    for axis, count in enumerate(scene.modes):
        k = np.pi / one.model.size[axis] * np.arange(1, count + 1)
        shapes.append(np.sin(np.outer(place[axis] + away[:, axis], k)) * np.exp(-0.25 * (SMOOTH * k) ** 2))
    sunk: FloatArray = -np.einsum("pm,mn,pn->p", shapes[0], waves[0], shapes[1])
    points = len(offsets) ** 2
    for i, force in enumerate(state.forces[t * points : (t + 1) * points].tolist()):
        if force:
            centre = np.array([offsets[i // len(offsets)], offsets[i % len(offsets)]])
            sunk += force * field.at(np.linalg.norm(away - centre, axis=1))[:, 0]
    return sunk


@dataclass(frozen=True, kw_only=True)
class Stop:
    """A probe pushed into the surface at 1 m/s and stopped; its force from 22 to 42 ms later.

    Attributes:
        mean: [N].
        ripple: root mean square of its change from tick to tick, over the mean [1].
        least, most: [N].
    """

    mean: float
    ripple: float
    least: float
    most: float


def stopped(one: Setting, depth: float) -> Stop:
    """Push the right instrument, an upright probe over the middle, in at 1 m/s, and stop it at a depth [m]."""
    dt = one.scene.dt
    x, y = one.model.size[0] / 2, one.model.size[1] / 2
    arrival = (OVER + depth) / _SPEED
    times = dt * np.arange(1, round((arrival + _UNTIL) / dt) + 1)
    z = np.maximum(OVER - _SPEED * times, -depth)
    way = np.stack([np.full_like(z, x), np.full_like(z, y), z], axis=1)
    records = played(one.scene, poses_along(one.instruments, (None, way)))
    late = records[times >= arrival + _FROM - 0.5 * dt, 1, FORCE + 2]
    mean = float(late.mean())
    return Stop(
        mean=mean,
        ripple=float(np.sqrt(np.mean(np.diff(late) ** 2))) / mean,
        least=float(late.min()),
        most=float(late.max()),
    )


@dataclass(frozen=True, kw_only=True)
class Slide:
    """A probe slid over the surface.

    Attributes:
        normal: mean force along z [N].
        friction: mean force against the way, over the normal one [1].
        ratchet: amplitude of the normal force at the frequency at which points pass, over its mean [1].
        ratchet_aside: the same of the force against the way, over its mean [1].
    """

    normal: float
    friction: float
    ratchet: float
    ratchet_aside: float


def slid(one: Setting, depth: float, speed: float) -> Slide:
    """Slide the right instrument, an upright probe, along x through the middle of the block.

    Args:
        one: the setting.
        depth: of the tip [m].
        speed: [m/s].
    """
    a, y = one.model.size[0], one.model.size[1] / 2
    low, high = 0.3 * a, 0.7 * a
    ticks = round((high - low) / speed / one.scene.dt)
    way = np.concatenate(
        [line((low, y, OVER), (low, y, -depth), 300), line((low, y, -depth), (high, y, -depth), ticks)]
    )
    records = played(one.scene, poses_along(one.instruments, (None, way)))[300 + ticks // 4 :, 1]
    spacing = float(one.scene.tick.offsets[1, 1] - one.scene.tick.offsets[1, 0])
    passing = speed / spacing
    normal, against = records[:, FORCE + 2], -records[:, FORCE]
    return Slide(
        normal=float(normal.mean()),
        friction=float(against.mean() / normal.mean()),
        ratchet=_amplitude(normal, passing, one.scene.dt) / float(normal.mean()),
        ratchet_aside=_amplitude(against, passing, one.scene.dt) / float(abs(against.mean())),
    )


def _amplitude(history: FloatArray, frequency: float, dt: float) -> float:
    """Return the amplitude at a frequency [Hz], slow changes taken out."""
    times = dt * np.arange(len(history))
    smooth = history - np.polynomial.Polynomial.fit(times, history, 5)(times)
    window = np.hanning(len(history))
    wave = np.exp(-2j * np.pi * frequency * times)
    return float(2 * abs((window * smooth) @ wave) / window.sum())
