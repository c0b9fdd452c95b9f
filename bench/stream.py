"""Print what a pose takes through the web server, on loopback, with a source that does nothing.

The tissue's own share comes on top: here a pose is shown as soon as it is there. Beside it stands what encoding one
frame takes. Run: python bench/stream.py [SECONDS]
"""

import sys
import time

import numpy as np

from trocar.web.latency import stream_latency
from trocar.web.messages import Camera, Hello, InstrumentShape, LayerSize, TissueSize
from trocar.web.source import InstrumentState, Snapshot, Status, Touch
from trocar.web.wire import encode

LAYERS, NODES = 3, 64
HANDLE = (-0.05, 0.03, 0.25)
STATE = InstrumentState(
    tip=(0.03, 0.03, 0.0),
    direction=(0.0, 0.0, -1.0),
    roll=0.0,
    jaw=0.0,
    force=(0.0, 0.0, 0.0),
    handle_force=(0.0, 0.0, 0.0),
    touch=Touch.PRESENT,
    depth=0.0,
)


class StillSource:
    """Tissue at rest; each snapshot shows the newest pose's number."""

    def __init__(self) -> None:
        self._sequences = [0, 0]
        self._heights = np.zeros((LAYERS, NODES, NODES), np.float32)
        layers = tuple(LayerSize(name=f"layer {place}", thickness_m=1e-3) for place in range(LAYERS))
        shape = {"length_m": 0.3, "shaft_radius_m": 2.5e-3, "tip": "probe", "port_m": (0.0, 0.03, 0.1)}
        self._hello = Hello(
            tissue=TissueSize(name="still", size_m=(0.06, 0.06), layers=layers),
            grid=(NODES, NODES),
            instruments=tuple(
                InstrumentShape(name=name, handle_m=HANDLE, **shape) for name in ("left", "right")
            ),
            camera=Camera(port_m=(0.03, -0.05, 0.1), target_m=(0.03, 0.03, 0.0)),
            linear_force_n=0.5,
            rate_hz=1000,
        )

    def hello(self):
        """Return the greeting."""
        return self._hello

    def latest(self):
        """Return the tissue at rest, and the poses' numbers."""
        return Snapshot(
            tick=0,
            time=0.0,
            pose_sequence=tuple(self._sequences),
            rate=1000.0,
            missed_ticks=0,
            tick_p50=0.0,
            tick_p99=0.0,
            status=Status.ALIVE,
            instruments=(STATE, STATE),
            heights=self._heights,
        )

    def pose(self, instrument, pose):
        """Keep a pose's number."""
        self._sequences[instrument] = pose.sequence

    def reset(self):
        """Do nothing: it is at rest."""

    def notices(self):
        """Return nothing to say."""
        return ()

    def beat(self):
        """Do nothing: there are no forces."""


def main() -> None:
    """Measure and print."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    found = stream_latency(StillSource(), seconds=seconds)
    print(f"{len(found.total)} poses, frame period {1e3 * found.frame_period:.2f} ms")
    print(f"{'ms':>10} {'p50':>8} {'p99':>8} {'max':>8}")
    for name in ("inward", "wait", "outward", "total"):
        values = 1e3 * getattr(found, name)
        print(f"{name:>10} {np.median(values):8.2f} {np.percentile(values, 99):8.2f} {values.max():8.2f}")
    snapshot = StillSource().latest()
    begun = time.perf_counter()
    for count in range(1000):
        encode(snapshot, count)
    print(
        f"encoding one frame of {len(encode(snapshot, 1))} bytes: {1e3 * (time.perf_counter() - begun):.0f} us"
    )


if __name__ == "__main__":
    main()
