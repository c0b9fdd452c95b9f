"""What a page is shown of: a tissue, two instruments and the scene made of them, and how a state of it looks."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from math import isfinite
from typing import Any

import numpy as np

from trocar.contact.instrument import Instrument, Vector
from trocar.contact.port_sets import instruments_over, instruments_through
from trocar.errors import InputError
from trocar.model import FloatArray, Press, Support
from trocar.realtime.physics import Physics, physics_of
from trocar.simulation import (
    DEPTH,
    DIRECTION,
    FORCE,
    RECORD_JAW,
    RECORD_ROLL,
    TIP,
    TOUCH,
    Scene,
    make_scene,
)
from trocar.simulation.kind import AnyScene, kind_of
from trocar.simulation.live import LIVE_MODELS, LIVE_SIZE, live_model
from trocar.simulation.organ import Organ, make_organ_scene
from trocar.simulation.organ_surface import OrganSurface
from trocar.simulation.phantom import Phantom
from trocar.simulation.sheet_scene import SheetScene, make_sheet_scene
from trocar.simulation.sheet_surface import sheet_planes_shown
from trocar.simulation.surface import Surface
from trocar.study.linear_range import linear_range
from trocar.tissues.catalogue import tissue as preset
from trocar.tissues.layer import Layer
from trocar.tissues.nodule import Nodule
from trocar.tissues.tissue import Tissue
from trocar.training.tasks.task import Task
from trocar.waves.sheet.sheet import POISSON_RATIO, Sheet
from trocar.waves.solid import WaveSolid
from trocar.web.messages import Camera, Hello, InstrumentShape, LayerSize, OrganShape, TissueSize
from trocar.web.source import InstrumentState, Snapshot, Status, Touch

GRID = (64, 64)
ORGAN_MODEL = "wave-mesh"
_NODE, _MOST_NODES = 1.5e-3, 160  # [m] between the nodes of an organ's surface; of a side at most
_CAMERA_BACK, _CAMERA_UP = 0.1, 0.11  # [m] from the middle of the block
_TRAY = 0.012  # [m] depth of what a film is clipped over


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A scene and what belongs to its picture.

    Attributes:
        tissue: the layers.
        model: of their waves, one of `LIVE_MODELS`, or `ORGAN_MODEL`.
        size: sides of the block [m].
        scene: made of them.
        instruments: left and right.
        linear_force: up to this force the tissue's answer is trusted as linear [N].
        grid: nodes of the surface along x and y.
        nodules: in the tissue.
        organ: what the scene is made of, if that is no block; `tissue` is then one of its material.
        sheet: in the tissue's place; the tissue then only says how it looks.
    """

    tissue: Tissue
    model: str
    size: tuple[float, float]
    scene: AnyScene = field(repr=False)
    instruments: tuple[Instrument, Instrument]
    linear_force: float
    nodules: tuple[Nodule, ...] = ()
    organ: Organ | None = None
    grid: tuple[int, int] = GRID
    sheet: Sheet | None = None

    @cached_property
    def _surface(self) -> Surface | OrganSurface:
        assert isinstance(self.scene, Scene)
        if self.organ is not None:
            return OrganSurface(self.scene, self.organ, grid=self.grid)
        return Surface(self.scene, self.tissue, size=self.size, grid=self.grid)

    def _shown(self, amplitudes: FloatArray, records: FloatArray) -> dict[str, Any]:
        """Return heights, in_plane and cut of a `Snapshot`."""
        if isinstance(self.scene, SheetScene):
            return sheet_planes_shown(amplitudes)
        heights, in_plane = self._surface.moved(amplitudes, records)
        return {"heights": heights, "in_plane": in_plane}

    @property
    def physics(self) -> Physics:
        """What the servo moves the scene with."""
        return physics_of(kind_of(self.scene))

    @cached_property
    def _shape(self) -> OrganShape | None:
        if self.organ is None:
            return None
        assert isinstance(self._surface, OrganSurface)
        corners, normals, faces = self._surface.sides
        return OrganShape(
            rest_m=tuple(round(z, 6) if isfinite(z) else None for z in self._surface.rest.ravel().tolist()),
            rim=tuple(self._surface.rim.tolist()),
            rim_m=tuple((x, y) for x, y in np.round(self._surface.rim_places, 6).tolist()),
            corners_m=tuple(_vector(corner) for corner in np.round(corners, 6)),
            normals=tuple(_vector(normal) for normal in np.round(normals, 3)),
            faces=tuple((a, b, c) for a, b, c in faces.tolist()),
        )

    def suits(self, task: Task) -> bool:
        """Return whether a task is done in this scene."""
        if task.sheet is not None or self.sheet is not None:
            return (self.sheet, self.instruments) == (task.sheet, task.instruments)
        if task.organ is not None:
            return (self.organ, self.instruments) == (task.organ.organ, task.instruments)
        return (
            self.tissue == preset(task.tissue)
            and self.instruments == task.instruments
            and self.nodules == task.nodules
            and self.organ is None
            and (self.model, self.size) == (LIVE_MODELS[0], LIVE_SIZE)
        )

    def hello(self, *, by_page: bool, lessons: bool = False) -> Hello:
        """Return what a page must know to draw it.

        Args:
            by_page: whether the page's hands move the instruments.
            lessons: whether there are tasks to do.
        """
        middle = (self.size[0] / 2, self.size[1] / 2, self._middle_height)
        return Hello(
            tissue=TissueSize(
                name=self.tissue.name,
                size_m=self.size,
                layers=tuple(
                    LayerSize(name=layer.name, thickness_m=layer.thickness) for layer in self.tissue.layers
                ),
            ),
            grid=self.grid,
            instruments=tuple(_shape(instrument) for instrument in self.instruments),
            shape=self._shape,
            under_m=0.0 if self.sheet is None else _TRAY,
            camera=Camera(port_m=(middle[0], middle[1] - _CAMERA_BACK, _CAMERA_UP), target_m=middle),
            linear_force_n=self.linear_force,
            rate_hz=round(1 / self.scene.dt, 6),
            lessons=lessons,
            steered_by="page" if by_page else "trainer",
        )

    @property
    def _middle_height(self) -> float:
        """How high the middle of the tissue lies [m]."""
        if self.organ is None:
            return 0.0
        assert isinstance(self._surface, OrganSurface)
        height = float(self._surface.rest[self.grid[1] // 2, self.grid[0] // 2])
        return height if isfinite(height) else 0.0

    def snapshot(
        self,
        records: FloatArray,
        amplitudes: FloatArray,
        *,
        tick: int,
        time: float,
        status: Status,
        hand_forces: FloatArray | None = None,
        pose_sequence: tuple[int, int] = (0, 0),
        rate: float = 0.0,
        missed_ticks: int = 0,
        tick_p50: float = 0.0,
        tick_p99: float = 0.0,
    ) -> Snapshot:
        """Return a state of the scene as a page is shown it; the rest as in `Snapshot`.

        Args:
            records: of both instruments, shape (2, RECORD).
            amplitudes: of the waves [m], shape (layers, M, N).
            tick: ticks since the start.
            time: the tissue's [s].
            status: how what moves it fares.
            hand_forces: what the hands feel [N], shape (2, 3); nothing if not given.
            pose_sequence: the poses followed.
            rate: ticks achieved in a second [Hz].
            missed_ticks: since the start.
            tick_p50: median duration of a tick [s].
            tick_p99: 99th percentile of it [s].
        """
        forces = np.linalg.norm(records[:, FORCE : FORCE + 3], axis=1)
        if forces.max() > self.linear_force:
            status |= Status.BEYOND_LINEAR
        felt = np.zeros((2, 3)) if hand_forces is None else hand_forces
        left, right = (_instrument(record, force) for record, force in zip(records, felt, strict=True))
        return Snapshot(
            tick=tick,
            time=time,
            pose_sequence=pose_sequence,
            rate=rate,
            missed_ticks=missed_ticks,
            tick_p50=tick_p50,
            tick_p99=tick_p99,
            status=status,
            instruments=(left, right),
            **self._shown(amplitudes, records),
        )


def set_stage(
    tissue: str,
    *,
    ports: str = "usual",
    model: str = LIVE_MODELS[0],
    size: tuple[float, float] = LIVE_SIZE,
    nodules: tuple[Nodule, ...] = (),
) -> Stage:
    """Make a stage of names.

    Args:
        tissue: name of a preset, or the path of a tissue file.
        ports: name of a port set, or a file (`contact.port_sets`).
        model: one of `LIVE_MODELS`.
        size: sides of the block [m].
        nodules: in the tissue.

    Raises:
        InputError: something named is not there or does not go together.
    """
    if model not in LIVE_MODELS:
        raise InputError("model", " or ".join(LIVE_MODELS), model)
    layers = preset(tissue)
    instruments = instruments_through(ports, size)
    return Stage(
        tissue=layers,
        model=model,
        size=size,
        scene=make_scene(live_model(layers, model, size=size), layers, instruments, nodules=nodules),
        instruments=instruments,
        linear_force=_linear_force(layers, size, instruments),
        nodules=nodules,
    )


def organ_stage(organ: Organ, *, ports: str = "usual") -> Stage:
    """Make a stage of an organ.

    Args:
        organ: the tissue.
        ports: name of a port set, about the middle of the organ's rectangle as about that of the usual block; or a file
            (`contact.port_sets`).

    Raises:
        InputError: the ports are not there, or do not go together.
    """
    instruments = instruments_over(ports, organ.size, LIVE_SIZE)
    nodes_x, nodes_y = (min(max(round(side / _NODE) + 1, GRID[0]), _MOST_NODES) for side in organ.size)
    return Stage(
        tissue=organ.block,
        model=ORGAN_MODEL,
        size=organ.size,
        scene=make_organ_scene(organ, instruments),
        instruments=instruments,
        linear_force=_linear_force(organ.block, organ.size, instruments),
        organ=organ,
        grid=(nodes_x, nodes_y),
    )


def _linear_force(
    layers: Tissue, size: tuple[float, float], instruments: tuple[Instrument, Instrument]
) -> float:
    """Return up to which force the tissue's answer is trusted as linear [N]."""
    # The range's thresholds were found under flat tools, so it is that of a flat tool as wide as the shaft.
    press = Press(x=size[0] / 2, y=size[1] / 2, radius=instruments[0].shaft_radius, force=1e-2)
    solid = WaveSolid(layers, size=size, support=Support.BASE)
    return linear_range(solid, layers, (press,)).force_limit


@lru_cache(maxsize=8)
def _stage_through(tissue: str, ports: str, nodules: tuple[Nodule, ...]) -> Stage:
    return set_stage(tissue, ports=ports, nodules=nodules)


@lru_cache(maxsize=8)
def sheet_stage(name: str, ports: str, sheet: Sheet) -> Stage:
    """Make the stage of a sheet.

    Args:
        name: of what it is made of.
        ports: name of a port set, or a file (`contact.port_sets`).
        sheet: the film.

    Raises:
        InputError: there is no such port set.
    """
    film = Layer(
        name="film",
        thickness=sheet.thickness,
        young_modulus=sheet.young_modulus,
        poisson_ratio=POISSON_RATIO,
        density=sheet.density,
    )
    instruments = instruments_through(ports, sheet.size)
    return Stage(
        tissue=Tissue(name=name, layers=(film,)),
        model="sheet",
        size=sheet.size,
        scene=make_sheet_scene(sheet, instruments),
        instruments=instruments,
        linear_force=sheet.linear_force(instruments[0].shaft_radius),
        grid=sheet.nodes,
        sheet=sheet,
    )


@lru_cache(maxsize=4)
def _phantom_stage(phantom: Phantom, ports: str) -> Stage:
    return organ_stage(phantom.organ, ports=ports)


def stage_of(task: Task) -> Stage:
    """Return the stage a task is done on."""
    if task.sheet is not None:
        return sheet_stage(task.tissue, task.ports, task.sheet)
    if task.organ is not None:
        return _phantom_stage(task.organ, task.ports)
    return _stage_through(task.tissue, task.ports, task.nodules)


def _shape(instrument: Instrument) -> InstrumentShape:
    return InstrumentShape(
        name="left" if instrument.name == "left" else "right",
        port_m=instrument.port,
        length_m=instrument.length,
        shaft_radius_m=instrument.shaft_radius,
        tip=instrument.tip.value,
        handle_m=instrument.handle,
    )


def _instrument(record: FloatArray, hand_force: FloatArray) -> InstrumentState:
    return InstrumentState(
        tip=_vector(record[TIP : TIP + 3]),
        direction=_vector(record[DIRECTION : DIRECTION + 3]),
        roll=float(record[RECORD_ROLL]),
        jaw=float(record[RECORD_JAW]),
        force=_vector(record[FORCE : FORCE + 3]),
        handle_force=_vector(hand_force),
        touch=Touch(int(record[TOUCH])),
        depth=float(record[DEPTH]),
    )


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
