"""Print what the sheet that can be cut keeps to: a membrane's tones, Griffith's slit, a ball's press; and its time.

Run: python bench/sheet.py. Exits 1 if a figure misses its bound; times are told, not judged.
"""

from __future__ import annotations

import sys
import time
from math import log, pi, sqrt

import numpy as np

from trocar.contact.instrument import TipKind
from trocar.contact.port_sets import instruments_through
from trocar.simulation import FORCE, RECORD, line, poses_along
from trocar.simulation.kind import SHEET
from trocar.simulation.sheet_scene import make_sheet_scene, sheet_at_rest
from trocar.study.contact.scenes import upright
from trocar.waves.sheet.cut import cut_along
from trocar.waves.sheet.lattice import Lattice, LatticeState, go_on, make_lattice, taut
from trocar.waves.sheet.sheet import Sheet

DT = 1e-3  # [s]


def tone(m: int, n: int, cells: int) -> float:
    """Return the frequency of the whole sheet's mode over the membrane's."""
    sheet = Sheet(cells=cells, along=0.0, across=0.0, drag=0.0)
    a, b = sheet.size
    known = 0.5 * sheet.wave_speed * sqrt((m / a) ** 2 + (n / b) ** 2)
    dt = 1e-4
    lattice = make_lattice(sheet, dt)
    state = taut(lattice)
    at = np.arange(len(lattice.free))
    x, y = at % lattice.columns * lattice.spacing, at // lattice.columns * lattice.spacing
    shape = np.sin(m * pi * x / a) * np.sin(n * pi * y / b) * lattice.free
    state.places[2] = 1e-3 * shape
    swings = []
    for _ in range(round(2.25 / known / dt)):
        go_on(lattice, state)
        swings.append(float(shape @ state.places[2]))
    c = np.array(swings)
    twice = (c[2:] + c[:-2]) @ c[1:-1] / (c[1:-1] @ c[1:-1])
    return float(np.arccos(twice / 2) / (2 * pi * dt)) / known


def opening(links: int, cells: int, size: float, stretch: float) -> float:
    """Return how far a slit stands open in its middle over Griffith's 4 sigma a/E."""
    sheet = Sheet(size=(size, size), cells=cells, stretch=stretch, along=2e-4, drag=300.0)
    lattice = make_lattice(sheet, DT)
    state = taut(lattice)
    h, n, row = lattice.spacing, lattice.columns, cells // 2
    half = links * h / 2
    cut_along(lattice, state, size / 2 - half, (row + 0.5) * h, size / 2 + half, (row + 0.5) * h)
    _rest(lattice, state)
    moved = state.places[1].reshape(-1, n)
    return float((moved[row + 1] - moved[row]).max()) / (4 * sheet.tension / sheet.stiffness * half)


def press(depth: float, cells: int) -> tuple[float, float, float]:
    """Return the force of a probe's ball on the sheet [N], and on round membranes in the frame and around it."""
    sheet = Sheet(cells=cells)
    middle = (sheet.size[0] / 2, sheet.size[1] / 2)
    pair = upright((TipKind.GRASPER, TipKind.PROBE), ((0.02, 0.03), middle))
    scene = make_sheet_scene(sheet, pair)
    way = np.concatenate(
        [line((*middle, 2e-3), (*middle, -depth), 400), np.tile((*middle, -depth), (400, 1))]
    )
    records = SHEET.played(scene, poses_along(pair, (None, way)))
    ball = float(scene.axes[1, 0]) + scene.wider
    known = []
    for frame in (0.03, 0.03 * sqrt(2)):
        low, high = 0.0, ball
        for _ in range(60):
            r = (low + high) / 2
            up = sqrt(ball**2 - r**2)
            low, high = (r, high) if r**2 / up * log(frame / r) + ball - up < depth else (low, r)
        known.append(2 * pi * sheet.tension * r**2 / up)
    return float(records[-1, 1, FORCE + 2]), known[0], known[1]


def tick() -> tuple[float, float]:
    """Return the time of a tick that nothing touches the sheet in, and of one with both tips on it [s], medians."""
    sheet = Sheet()
    pair = instruments_through("scissors", sheet.size)
    scene = make_sheet_scene(sheet, pair)
    state = sheet_at_rest(scene)
    down = [line((x, 0.03, 2e-3), (x, 0.03, -2e-3), 100) for x in (0.022, 0.038)]
    stay = [np.tile(each[-1], (1000, 1)) for each in down]
    records = np.zeros((1000, 2, RECORD))
    SHEET.play(scene, state, poses_along(pair, (down[0], down[1])), records)
    found = []
    for tips in ((None, stay[1] + (0, 0, 0.019)), (stay[0], stay[1])):
        times = []
        for _ in range(5):
            began = time.perf_counter()
            SHEET.play(
                scene, sheet_at_rest(scene) if tips[0] is None else state, poses_along(pair, tips), records
            )
            times.append((time.perf_counter() - began) / 1000)
        found.append(float(np.median(times)))
    return found[0], found[1]


def _rest(lattice: Lattice, state: LatticeState) -> None:
    for _ in range(120):
        go_on(lattice, state)


def main() -> int:
    """Run and print."""
    kept = True
    sheet = Sheet()
    lattice = make_lattice(sheet, DT)
    print(
        f"tension {sheet.tension:.3g} N/m, waves up and down {sheet.wave_speed:.3g} m/s, {lattice.steps} small steps"
    )
    for m, n in ((1, 1), (2, 1), (2, 2), (3, 2)):
        ratios = [tone(m, n, cells) for cells in (20, 40, 80)]
        kept = kept and abs(ratios[1] - 1) < 0.01
        told = ", ".join(f"{ratio:.5f}" for ratio in ratios)
        print(f"mode {m},{n} over the membrane's, with 20, 40, 80 cells: {told}")
    for links, cells, size, stretch in (
        (7, 80, 0.12, 0.005),
        (11, 120, 0.12, 0.005),
        (15, 160, 0.12, 0.005),
        (7, 80, 0.12, 0.05),
        (7, 40, 0.06, 0.05),
    ):
        ratio = opening(links, cells, size, stretch)
        kept = kept and (stretch > 0.01 or abs(ratio - 1) < 0.05)
        print(
            f"slit of {1e3 * links * size / cells:.4g} mm in {1e3 * size:.0f} mm, nodes {1e3 * size / cells:.2g} mm "
            f"apart, stretched by {100 * stretch:.2g} %: opens {ratio:.3f} of Griffith's"
        )
    for depth in (1e-3, 2e-3, 3e-3):
        for cells in (40, 80):
            force, inside, around = press(depth, cells)
            print(
                f"pressed {1e3 * depth:.0f} mm, {cells} cells: {1e3 * force:.1f} mN; membranes {1e3 * around:.1f} "
                f"to {1e3 * inside:.1f} mN"
            )
    alone, both = tick()
    print(f"a tick: {1e6 * alone:.0f} us untouched, {1e6 * both:.0f} us with both tips on it")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
