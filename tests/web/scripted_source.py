"""A source for tests: two instruments, a dent under each present tip, a tick with each snapshot. No physics."""

import threading
from collections import deque

import numpy as np

from trocar.web.messages import Camera, Hello, InstrumentShape, LayerSize, Notice, TissueSize
from trocar.web.source import InstrumentState, Pose, Snapshot, Status, Touch

SIZE = (0.06, 0.06)
GRID = (64, 64)
LENGTH = 0.3
PORTS = ((0.0, 0.03, 0.1), (0.06, 0.03, 0.1))
HANDLES = ((-0.05, 0.03, 0.25), (0.11, 0.03, 0.25))

HELLO = Hello(
    tissue=TissueSize(
        name="skin",
        size_m=SIZE,
        layers=(
            LayerSize(name="epidermis", thickness_m=1e-4),
            LayerSize(name="dermis", thickness_m=2e-3),
            LayerSize(name="fat", thickness_m=1e-2),
        ),
    ),
    grid=GRID,
    instruments=(
        InstrumentShape(
            name="left",
            port_m=PORTS[0],
            length_m=LENGTH,
            shaft_radius_m=2.5e-3,
            tip="grasper",
            handle_m=HANDLES[0],
        ),
        InstrumentShape(
            name="right",
            port_m=PORTS[1],
            length_m=LENGTH,
            shaft_radius_m=2.5e-3,
            tip="probe",
            handle_m=HANDLES[1],
        ),
    ),
    camera=Camera(port_m=(0.03, -0.05, 0.1), target_m=(0.03, 0.03, 0.0)),
    linear_force_n=0.5,
    rate_hz=1000,
)


def rest_pose(instrument, sequence=1, **changes):
    """Return a pose of an instrument at its start."""
    content = {"present": True, "handle": HANDLES[instrument], "roll": 0.0, "jaw": 0.5, **changes}
    return Pose(instrument=instrument, sequence=sequence, **content)


class ScriptedSource:
    """Show the last poses it was given; count beats, resets and snapshots."""

    def __init__(self, grid=GRID):
        nx, ny = grid
        self._hello = HELLO.model_copy(update={"grid": grid})
        x, y = np.meshgrid(np.linspace(0, SIZE[0], nx), np.linspace(0, SIZE[1], ny))
        self._x, self._y = x.astype(np.float32), y.astype(np.float32)
        self._waiting = deque()
        self.poses = [rest_pose(0, 0, present=False), rest_pose(1, 0, present=False)]
        self.guidance = None
        self.ticks = 0
        self.beats = 0
        self.resets = 0
        self.beating = threading.Event()
        self.failing = False

    def hello(self):
        return self._hello

    def latest(self):
        self.ticks += 1
        states = tuple(self._state(pose) for pose in self.poses)
        surface = np.zeros_like(self._x)
        for state in states:
            if state.touch:
                distance = (self._x - state.tip[0]) ** 2 + (self._y - state.tip[1]) ** 2
                surface -= np.float32(1e-3) * np.exp(-distance / np.float32(5e-3**2))
        heights = np.stack([surface, surface / 2, surface / 4])
        left, right = self.poses
        return Snapshot(
            tick=self.ticks,
            time=self.ticks * 1e-3,
            pose_sequence=(left.sequence, right.sequence),
            rate=1000.0,
            missed_ticks=0,
            tick_p50=25e-6,
            tick_p99=50e-6,
            status=Status.ALIVE,
            instruments=states,
            heights=heights,
        )

    def pose(self, instrument, pose):
        self.poses[instrument] = pose

    def reset(self):
        self.resets += 1

    def say(self, level, text):
        self._waiting.append(Notice(level=level, text=text))

    def guiding(self):
        return self.guidance

    def notices(self):
        said = list(self._waiting)
        self._waiting.clear()
        return said

    def beat(self):
        if self.failing:
            raise OSError("the servo is gone")
        self.beats += 1
        self.beating.set()

    def _state(self, pose):
        to_port = np.subtract(PORTS[pose.instrument], pose.handle)
        direction = to_port / np.linalg.norm(to_port)
        tip = np.add(pose.handle, LENGTH * direction)
        return InstrumentState(
            tip=tuple(tip.tolist()),
            direction=tuple(direction.tolist()),
            roll=pose.roll,
            jaw=pose.jaw,
            force=(0.0, 0.0, 0.1 * pose.present),
            handle_force=(0.0, 0.0, -0.1 * pose.present),
            touch=Touch.PRESENT if pose.present else Touch(0),
            depth=0.0,
        )
