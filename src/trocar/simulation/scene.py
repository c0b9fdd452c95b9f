"""What a live scene is made of: a tissue laid out in ticks, two instruments, and what joins them.

A scene holds parameters only, as arrays and scalars that compiled code and another process can take whole.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import pi
from typing import Any, NamedTuple, Protocol

import numpy as np

from trocar.contact.instrument import Instrument
from trocar.contact.tips import TIPS
from trocar.errors import InputError
from trocar.model import FloatArray, Press, Profile, Support
from trocar.tissues.nodule import Nodule
from trocar.tissues.tissue import Tissue
from trocar.waves.cutoff import measured_cutoff
from trocar.waves.mesh.mesh_tick import MeshTick
from trocar.waves.mesh.mesh_tick import at_rest as mesh_at_rest
from trocar.waves.near_field import SMOOTH, Compliance, near_field
from trocar.waves.nodules import springs_under
from trocar.waves.solid import WaveSolid
from trocar.waves.springs import Springs, SpringState, springs_at_rest
from trocar.waves.tick import LiveWaves, make_tick
from trocar.waves.tick import at_rest as tissue_at_rest

DT = 1e-3  # [s] one tick
POINTS = 7  # of a patch, along x as along y
TOLERANCE = 1e-4  # of what a patch feels, that the modes are chosen for
FRICTION = 0.1  # coefficient of wet steel on wet tissue; chosen, between 0.03 and 0.3 of the literature
_STEPS = np.arange(POINTS) - (POINTS - 1) / 2
_SPACING = 0.2  # of a patch's points, in a tip's mean semi-axis
_WIDTH = 0.4  # of a point's Gaussian, in spacings
_NEAR = 7.0  # reach of the near field, in windows
_TOUCH = 0.5  # radius over which friction acts, in a tip's mean semi-axis
_TILT = 0.5  # [rad] of the press that in-plane give is read from; its size cancels


class LiveModel(LiveWaves, Protocol):
    """A wave model that a scene can be made of."""

    @property
    def support(self) -> Support:
        """How the block is held."""
        ...


class Scene(NamedTuple):
    """Parameters of a scene; nothing in it changes.

    Attributes:
        tick: the tissue's step: `Tick` of a flat block, `MeshTick` of a mesh.
        ports: of both instruments [m], shape (2, 3).
        lengths: of their shafts, from handle to tip [m], shape (2,).
        axes, middles: of their tips' ellipsoids (`contact.tips`) [m], shapes (2, 3).
        holds: whether a tip has jaws, shape (2,).
        near: near field between the points of a patch [m/N], shape (2, P P, P P).
        own: the same and what they push each other in by waves within a tick, far from the sides; on a mesh, where that
            changes from place to place, not used.
        give: in-plane displacement of the surface under a tip per newton of friction [m/N], shape (2,).
        friction: coefficient [1].
        dt: length of a tick [s].
        modes: M, N of `amplitudes`; on a mesh 1 and how many numbers its picture is made of.
        layers: of the tissue; on a mesh 1, for one face is seen.
        springs: what nodules in it are to the waves.
    """

    tick: Any
    ports: FloatArray
    lengths: FloatArray
    axes: FloatArray
    middles: FloatArray
    holds: FloatArray
    near: FloatArray
    own: FloatArray
    give: FloatArray
    friction: float
    dt: float
    modes: tuple[int, int]
    layers: int
    springs: Springs


class SceneState(NamedTuple):
    """What a scene changes, in place.

    Attributes:
        tick: the waves, `TickState` or `MeshTickState`.
        forces: of every point of both patches into the surface [N], shape (2 P P,).
        touching, holding: which of them press, and which hold the tissue, shape (2 P P,).
        drag: of both tips along the surface, x and y: friction and what the slopes under them push aside [N],
            shape (2, 2).
        aside: the latter alone [N], shape (2, 2); leaning: how much of it the surface has followed.
        slip: of both tips over the surface in this tick, x and y [m], shape (2, 2).
        sliding: the slip's share of their motion across in this tick, 0 (all sticks) to 1, shape (2,).
        lowest: lowest points of both tips [m], shape (2, 3); the next three are also of the last tick.
        flags: of both instruments: in the hand, free to touch, gripping, jaw, normal force [N]; shape (2, 5).
        depths: of the tips' undersides below the rest surface at every point [m], shape (2, P P).
        slopes: of the undersides there, along x and y [1], shape (2, P P, 2).
        factor, order: of each patch's W, remembered from tick to tick.
        inside: whether they are of `Scene.own`, shape (2,).
        sunk, below, own, across, rest, wrong: scratch of the normal contact.
        frames: of the surface under the tips: origin [m], both tangents and the normal, shape (2, 4, 3). Drag, slip,
            depths and slopes are in them; on a flat block their axes are the room's.
        motions: of the lowest points in this tick [m], shape (2, 3).
        rises: of the lowest points above the rest surface [m], shape (2,).
        middles, spreads: of the tips' ellipsoids, as seen from their lowest points [m], and S of `contact.tips` [m^2],
            in the frames; shapes (2, 3), (2, 3, 3).
        centre: scratch, shape (3,).
        vectors: scratch, shape (6, 3).
        springs: of nodules.
    """

    tick: Any
    forces: FloatArray
    touching: np.ndarray
    holding: np.ndarray
    drag: FloatArray
    aside: FloatArray
    leaning: FloatArray
    slip: FloatArray
    sliding: FloatArray
    lowest: FloatArray
    flags: FloatArray
    depths: FloatArray
    slopes: FloatArray
    sunk: FloatArray
    below: FloatArray
    own: FloatArray
    across: FloatArray
    rest: FloatArray
    factor: FloatArray
    order: np.ndarray
    inside: np.ndarray
    wrong: np.ndarray
    frames: FloatArray
    motions: FloatArray
    rises: FloatArray
    middles: FloatArray
    spreads: FloatArray
    centre: FloatArray
    vectors: FloatArray
    springs: SpringState


def make_scene(
    model: LiveModel,
    tissue: Tissue,
    instruments: tuple[Instrument, Instrument],
    *,
    dt: float = DT,
    window: float = SMOOTH,
    friction: float = FRICTION,
    tolerance: float = TOLERANCE,
    nodules: Sequence[Nodule] = (),
) -> Scene:
    """Lay out a scene.

    Args:
        model: a wave model of the tissue, `WaveMembrane` or `WaveSolid`, its base held and its sides simply supported.
        tissue: the layers, for the near field and for the give of the surface under friction.
        instruments: left, right.
        dt: length of a tick [s].
        window: of the waves that move [m].
        friction: coefficient [1].
        tolerance: of what a patch feels, that the modes are chosen for [1].
        nodules: in the tissue.

    Raises:
        InputError: the sides are clamped, the model's series is too short for the window, a nodule cannot lie there, or
            a number is impossible.
    """
    if model.support is not Support.BASE:
        raise InputError(
            "scene: support", Support.BASE.value, model.support.value, "clamped sides cannot move"
        )
    require_friction(friction)
    tools = Tools.of(instruments)
    tick = make_tick(
        model, dt, window=window, offsets=tools.offsets, cutoff=_cutoff(model, window, tolerance)
    )
    solid = WaveSolid(tissue, size=model.size, support=Support.BASE)
    near = tools.near(lambda finest: partial(solid.compliance, finest=finest), window)
    return Scene(
        tick=tick,
        ports=tools.ports,
        lengths=tools.lengths,
        axes=tools.axes,
        middles=tools.middles,
        holds=tools.holds,
        near=near,
        own=tick.inside + near,
        give=tools.give(solid),
        friction=friction,
        dt=dt,
        modes=tick.shape[2:],
        layers=tick.shape[1],
        springs=springs_under(nodules, model, tissue, tick, window=window),
    )


def require_friction(friction: float) -> None:
    """Raise an InputError unless this is a coefficient of friction."""
    if not 0 <= friction <= 2:
        raise InputError("scene: friction", "a coefficient from 0 to 2", friction)


@dataclass(frozen=True, eq=False)
class Tools:
    """What a scene takes of its instruments.

    Attributes:
        ports, lengths, axes, middles, holds: as in `Scene`.
        sizes: mean semi-axes of the tips [m], shape (2,).
    """

    ports: FloatArray
    lengths: FloatArray
    axes: FloatArray
    middles: FloatArray
    holds: FloatArray
    sizes: FloatArray

    @classmethod
    def of(cls, instruments: tuple[Instrument, Instrument]) -> Tools:
        """Return what a scene takes of these instruments."""
        radii = np.array([each.shaft_radius for each in instruments])
        axes = np.array([TIPS[each.tip].axes for each in instruments])
        return cls(
            ports=np.array([each.port for each in instruments]),
            lengths=np.array([each.length for each in instruments]),
            axes=axes * radii[:, None],
            middles=np.array([TIPS[each.tip].middle for each in instruments]) * radii[:, None],
            holds=np.array([1.0 if TIPS[each.tip].holds else 0.0 for each in instruments]),
            sizes=radii * np.prod(axes, axis=1) ** (1 / 3),
        )

    @property
    def offsets(self) -> FloatArray:
        """Of their patches' points from the centres, along both tangents [m], shape (2, P)."""
        return np.asarray((_SPACING * self.sizes)[:, None] * _STEPS)

    def near(self, compliance: Callable[[float], Compliance], window: float) -> FloatArray:
        """Return the near field between the points of a patch [m/N], shape (2, P P, P P).

        Args:
            compliance: of the tissue, by the width of the smallest pad that presses [m].
            window: of the waves that move [m].
        """
        places = np.stack(np.meshgrid(_STEPS, _STEPS, indexing="ij"), axis=-1).reshape(-1, 2)
        apart = np.linalg.norm(places[:, None] - places[None], axis=2)
        near = np.empty((2, len(places), len(places)))
        for side, spacing in enumerate((_SPACING * self.sizes).tolist()):
            width = _WIDTH * spacing
            field = near_field(compliance(width), pad=width, window=window, reach=_NEAR * window)
            near[side] = field.at(spacing * apart)[..., 0]
        return near

    def give(self, solid: WaveSolid) -> FloatArray:
        """Return how far the surface of a block goes with a friction of 1 N under each tip [m/N], shape (2,)."""
        return _give(solid, _TOUCH * self.sizes)


def at_rest(scene: Scene) -> SceneState:
    """Return a scene's state with the tissue at rest and no instrument in it."""
    tools, each = scene.near.shape[:2]
    points = tools * each
    return SceneState(
        tick=mesh_at_rest(scene.tick) if isinstance(scene.tick, MeshTick) else tissue_at_rest(scene.tick),
        forces=np.zeros(points),
        touching=np.zeros(points, dtype=np.bool_),
        holding=np.zeros(points, dtype=np.bool_),
        drag=np.zeros((tools, 2)),
        aside=np.zeros((tools, 2)),
        leaning=np.zeros((tools, 2)),
        slip=np.zeros((tools, 2)),
        sliding=np.zeros(tools),
        lowest=np.zeros((tools, 3)),
        flags=np.zeros((tools, 5)),
        depths=np.zeros((tools, each)),
        slopes=np.zeros((tools, each, 2)),
        sunk=np.zeros((tools, each)),
        below=np.zeros(points),
        own=np.zeros((tools, each, each)),
        across=np.zeros((each, each)),
        rest=np.zeros(points),
        factor=np.zeros((tools, each, each)),
        order=np.zeros((tools, each + 1), dtype=np.int64),
        inside=np.zeros(tools, dtype=np.bool_),
        wrong=np.zeros(each, dtype=np.bool_),
        frames=np.zeros((tools, 4, 3)),
        motions=np.zeros((tools, 3)),
        rises=np.zeros(tools),
        middles=np.zeros((tools, 3)),
        spreads=np.zeros((tools, 3, 3)),
        centre=np.zeros(3),
        vectors=np.zeros((6, 3)),
        springs=springs_at_rest(scene.springs, tools, each),
    )


def _cutoff(model: LiveModel, window: float, tolerance: float) -> float:
    """Return the wavenumber [1/m] beyond which waves add less than a share to what a patch feels."""
    rows, columns = model.surface_modes
    static = model.surface_oscillators.yielding[:, :1, 0]
    return measured_cutoff(
        static.reshape(rows, columns, 1), model.size, 2 * window, Profile.GAUSSIAN, tolerance
    )


def _give(solid: WaveSolid, radii: FloatArray) -> FloatArray:
    """Return how far the surface goes with a friction of 1 N spread over a disc in the middle of the block [m/N]."""
    gives = []
    size = solid.size
    for radius in radii.tolist():
        press = Press(x=size[0] / 2, y=size[1] / 2, radius=radius, force=1.0, tilt=_TILT)
        angles = np.linspace(0, 2 * pi, 12, endpoint=False)
        ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1) * (radius * 2**-0.5)
        under = np.array([press.x, press.y, 0.0]) + np.vstack([np.zeros(3), ring])
        moved = solid.displacement(solid.static((press,)), under)[:, 0].mean()
        gives.append(float(moved / np.sin(_TILT)))
    return np.array(gives)
