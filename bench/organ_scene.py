"""Hold a scene of a mesh against a scene of a flat block, and time its tick on the whole liver.

Run: python bench/organ_scene.py [--elements 12] [--ticks 5000] [--cache FOLDER]. Prints

  of a flat block as a mesh and as sine waves, under an upright probe that presses 3 mm deep and slides: how far forces
  on the tip lie apart, of the largest;
  with --nodule alone, of the liver with a ball of 6 mm of twenty times its stiffness 9 mm below the surface: the force
  of a probe 3 mm deep over it and 15 mm to the left, and both in the same mesh without the ball;
  of the liver of about 20,000 nodes, two instruments 3 mm deep on circles at 60 mm/s: the time of a whole tick of the
  scene (ports, tips, contact, friction, modes, wrenches), and the largest change of force from tick to tick.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import replace

import numpy as np

from trocar import tissue
from trocar.contact.instrument import TipKind
from trocar.contact.port_sets import instruments_over
from trocar.model import Support
from trocar.simulation import FORCE, RECORD, TOUCH, advance, at_rest, line, make_scene, played, poses_along
from trocar.simulation.live import LIVE_SIZE
from trocar.simulation.live_organ import live_organ, organ_mesh
from trocar.simulation.organ import Organ, make_organ_scene
from trocar.study.contact.scenes import upright
from trocar.tissues import Layer, Tissue
from trocar.tissues.nodule import Nodule
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid

SIZE, THICK, DEEP = (0.06, 0.06), 0.02, 3e-3  # [m]
JELLY = Layer(
    name="jelly", thickness=THICK, young_modulus=4.5e3, poisson_ratio=0.45, density=1060, loss_factor=0.4
)
CIRCLE, SPEED = 6e-3, 0.06  # [m], [m/s]


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--elements", type=int, default=12, help="along a side of the block")
    parser.add_argument("--ticks", type=int, default=5000)
    parser.add_argument("--cache", help="a folder that modes are kept in; else they are made anew")
    parser.add_argument("--nodule", action="store_true", help="feel a nodule in the liver instead")
    arguments = parser.parse_args()
    if arguments.nodule:
        with tempfile.TemporaryDirectory() as folder:
            felt(BasisCache(arguments.cache or folder))
        return
    flat(arguments.elements)
    with tempfile.TemporaryDirectory() as folder:
        liver(BasisCache(arguments.cache or folder), arguments.ticks)


def flat(elements: int) -> None:
    """Compare a flat mesh with a flat block."""
    layers = Tissue(layers=(JELLY,))
    lines = (*(np.linspace(0, side, elements + 1) for side in SIZE), np.linspace(-THICK, 0, 5))
    organ = Organ.of(WaveMesh(block_mesh(layers, lines, support=Support.BASE), modes=30))
    tools = upright((TipKind.GRASPER, TipKind.PROBE), ((0.012, 0.03), (0.03, 0.03)))
    waves = WaveSolid(layers, size=SIZE, support=Support.BASE, modes=(52, 52), dynamic_modes=(52, 52))
    down = line((0.03, 0.03, 2e-3), (0.03, 0.03, -DEEP), 500)
    way = np.concatenate([down, np.repeat(down[-1:], 300, axis=0)])
    way = np.concatenate([way, line(way[-1], way[-1] + [4e-3, 2e-3, 0], 300)])
    poses = poses_along(tools, (None, way))
    scenes = make_organ_scene(organ, tools), make_scene(waves, layers, tools)
    ours, theirs = (played(scene, poses)[:, 1, FORCE : FORCE + 3] for scene in scenes)
    most = np.abs(theirs).max()
    apart = np.abs(ours - theirs).max(axis=0)
    print(
        f"a flat block of {elements} x {elements} x 4 elements, window {1e3 * organ.grid.window:.1f} mm: "
        f"{1e3 * most:.1f} mN at most; apart by {100 * apart[2] / most:.2f} % of that upward, "
        f"{100 * apart[:2].max() / most:.2f} % along the surface"
    )


def liver(cache: BasisCache, ticks: int) -> None:
    """Time a scene of the liver."""
    began = time.process_time()
    organ = live_organ(organ_mesh("liver", tissue("liver")), name="liver", cache=cache)
    print(
        f"the liver: {organ.model.elements.nodes.shape[1]} nodes, {len(organ.grid.places)} sites, "
        f"{organ.modes.shapes.shape[1]} modes; {time.process_time() - began:.0f} s of processor time to set up",
        flush=True,
    )
    tools = instruments_over("usual", organ.size, LIVE_SIZE)
    scene = make_organ_scene(organ, tools)
    turn = SPEED / CIRCLE * scene.dt * np.arange(ticks)
    ring = CIRCLE * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    paths = []
    for one in tools:
        middle = np.array(one.reach_of(one.handle).tip)
        places = middle[:2] + ring
        heights = organ.model.elements.heights(organ.grid.surface, places)
        round_it = np.column_stack([places, heights - DEEP])
        waiting = round_it[0] + np.linspace(5e-3 + DEEP, DEEP, 500)[:, None] * [0.0, 0.0, 1.0]
        paths.append(np.concatenate([waiting, line(waiting[-1], round_it[0], 200), round_it]))
    poses = poses_along(tools, (paths[0], paths[1]))
    state, records = at_rest(scene), np.zeros((2, RECORD))
    times, forces = np.empty(len(poses)), np.empty((len(poses), 2))
    for k, pose in enumerate(poses):
        start_ns = time.perf_counter_ns()
        assert advance(scene, state, pose, records)
        times[k] = 1e-3 * (time.perf_counter_ns() - start_ns)
        forces[k] = np.linalg.norm(records[:, FORCE : FORCE + 3], axis=1)
        assert k < 1200 or (records[:, TOUCH] == 3).all()
    steady = slice(1200, None)
    print(
        f"a tick with both tips {1e3 * DEEP:g} mm deep: median {np.median(times[steady]):.0f} us, "
        f"99 % below {np.percentile(times[steady], 99):.0f} us (Python's call of it included); "
        f"forces {1e3 * forces[steady].mean():.0f} mN, from tick to tick "
        f"{1e3 * np.abs(np.diff(forces[steady], axis=0)).max():.2f} mN at most"
    )


def felt(cache: BasisCache) -> None:
    """Press over a nodule and beside it."""
    lump = Nodule(x=0.12, y=0.05, depth=9e-3, radius=6e-3, young_modulus=9e4)
    mesh = organ_mesh("liver", tissue("liver"), nodules=(lump,))
    without = replace(mesh, region=np.zeros_like(mesh.region), materials=mesh.materials[:1])
    for name, one in (("with", mesh), ("without", without)):
        organ = live_organ(one, cache=cache)
        forces = []
        for x in (lump.x, lump.x - 15e-3):
            tools = upright((TipKind.GRASPER, TipKind.PROBE), ((x - 0.04, lump.y), (x, lump.y)))
            height = organ.model.elements.heights(organ.grid.surface, np.array([[x, lump.y]]))[0]
            down = line((x, lump.y, height + 3e-3), (x, lump.y, height - DEEP), 600)
            way = np.concatenate([down, np.repeat(down[-1:], 400, axis=0)])
            record = played(make_organ_scene(organ, tools), poses_along(tools, (None, way)))[-1, 1]
            forces.append(1e3 * float(np.linalg.norm(record[FORCE : FORCE + 3])))
        print(
            f"{name} the ball: {forces[0]:.1f} mN over its place, {forces[1]:.1f} mN 15 mm beside, "
            f"{100 * (forces[0] / forces[1] - 1):+.0f} %",
            flush=True,
        )


if __name__ == "__main__":
    main()
