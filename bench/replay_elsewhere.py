"""Replay recorded attempts on other machines, and print how far that is from their replay here.

Another machine is this one made to run other code, in a process of its own: numba compiles for an older processor, what
it compiled here out of reach; OpenBLAS, NumPy and the C library choose the code they have for one. What then differs is
what differs between machines: sums in another order, multiplications fused with additions or not, other polynomials for
sines. Attempts go by way of a file of records, as `trocar replay --attempt` reads them. Known for x86-64 and glibc.

Run: python bench/replay_elsewhere.py [--attempts palpate,lift] [--machines sse2,haswell] [--json]. It exits 1 where a
number is off by more than 1e-9 of the largest of its kind, or where anything that is counted or decided is another.
"""

from __future__ import annotations

import argparse
import ctypes
import hashlib
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from trocar.realtime.tracking import Following
from trocar.records.scripted import attempt_on_record
from trocar.records.store import Records
from trocar.simulation import (
    DEPTH,
    DIRECTION,
    DRAG,
    DT,
    FORCE,
    HANDLE_FORCE,
    MOMENT,
    OUTSIDE,
    PLACE,
    RECORD_JAW,
    RECORD_ROLL,
    TIP,
    TOUCH,
    TWIST,
    play,
)
from trocar.training.headless import attempt
from trocar.training.session import assess, judged, marked, scene_of
from trocar.training.strip import Piece, header, recorded, write_piece
from trocar.training.tasks.catalogue import task as task_by_name

MOST = 1e-9  # of the largest of its kind
PAGE = 11  # ticks between two poses of a page: 90 a second

MACHINES = {
    "sse2": {  # any x86-64: no AVX, nothing fused
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "OPENBLAS_NUM_THREADS": "1",
        "OPENBLAS_CORETYPE": "Prescott",
        "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-XSAVE",
    },
    "haswell": {  # of 2013: AVX2 and fused, no AVX-512
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "",
        "OPENBLAS_NUM_THREADS": "1",
        "OPENBLAS_CORETYPE": "Haswell",
        "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR",
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F",
    },
}
KINDS = {  # columns of a record that are measured alike: first, how many
    "tip": (TIP, 3),
    "direction": (DIRECTION, 3),
    "roll": (RECORD_ROLL, 1),
    "jaw": (RECORD_JAW, 1),
    "force": (FORCE, 3),
    "hand force": (HANDLE_FORCE, 3),
    "depth": (DEPTH, 1),
    "outside": (OUTSIDE, 1),
    "drag": (DRAG, 2),
    "place": (PLACE, 2),
    "moment": (MOMENT, 3),
    "twist": (TWIST, 1),
}


def machine() -> dict[str, str]:
    """Say what code this process runs: what was compiled for and what the libraries chose."""
    codegen = play.targetctx.codegen()
    mapped = Path("/proc/self/maps").read_text().splitlines()
    found = {
        "numba": str(codegen.magic_tuple()[1]),
        "compiled": "here" if not play.stats.cache_hits else "before",
    }
    for path in sorted({line.split()[-1] for line in mapped if "openblas" in line}):
        library = ctypes.CDLL(path)
        for name in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename"):
            if hasattr(library, name):
                ask = getattr(library, name)
                ask.restype = ctypes.c_char_p
                found["blas of scipy" if "scipy.libs" in path else "blas of numpy"] = ask().decode()
    found["numpy"] = " ".join(np.show_config(mode="dicts")["SIMD Extensions"].get("found", ["nothing more"]))
    sines = [math.sin(0.002 * k) for k in range(20000)]
    found["libm's sines"] = hashlib.sha256(np.array(sines).tobytes()).hexdigest()[:8]
    return found


def record(folder: Path, names: list[str]) -> None:
    """Put attempts on record: NAME of the scripted expert, NAME:novice, NAME:page as a page would have told it."""
    with Records.open(folder) as records:
        for name in names:
            task, _, how = name.partition(":")
            if how == "page":
                _record_of_a_page(records, task)
            else:
                attempt_on_record(records, task, skill=how or "expert", seed=1)


def _record_of_a_page(records: Records, name: str) -> None:
    """Keep the expert's handles as 90 poses a second that a servo follows."""
    poses = attempt(name, seed=1).recording.poses
    told = np.repeat(poses[::PAGE], PAGE, axis=0)[: len(poses)]
    began = np.zeros(len(told), bool)
    began[0] = True
    piece = Piece(targets=told, began=began, skipped=np.zeros(len(told), int))
    how, task = header(DT, Following()), task_by_name(name, 1)
    number = records.begin(records.trainee("page"), task=name, level=1, device="web", header=how, dt=DT)
    data = write_piece(piece)
    records.add(number, data, len(told))
    records.finish(number, assess(task, recorded(how, [data])))


def replay(folder: Path) -> Iterator[tuple[str, np.ndarray, dict[str, Any]]]:
    """Replay every attempt of the records of a folder: its name, the records of every tick, and the card."""
    with Records.open(folder, writing=False) as records:
        for row in records.attempts():
            task, kept = task_by_name(row.task, row.level), recorded(*records.chunks(row.id))
            played = kept.played(scene_of(task))
            card = marked(task, *judged(task, kept.times, played))
            yield f"{row.task}, {row.trainee}", played, card.as_dict()


def replay_elsewhere(
    folder: Path, name: str
) -> tuple[dict[str, str], list[tuple[np.ndarray, dict[str, Any]]]]:
    """Replay them in a process that runs another machine's code, all of it compiled there."""
    with TemporaryDirectory(prefix="trocar-elsewhere-") as place:
        out = Path(place)
        subprocess.run(
            [sys.executable, __file__, "--replay", str(folder), str(out)],
            env=os.environ | MACHINES[name] | {"NUMBA_CACHE_DIR": str(out / "numba")},
            check=True,
        )
        cards = json.loads((out / "cards.json").read_text())
        return json.loads((out / "machine.json").read_text()), [
            (np.load(out / f"{number}.npy"), card) for number, card in enumerate(cards)
        ]


def write_replay(folder: Path, out: Path) -> None:
    """Replay, and leave what comes of it in a folder: what the other process does."""
    cards = []
    for number, (_, played, card) in enumerate(replay(folder)):
        np.save(out / f"{number}.npy", played)
        cards.append(card)
    (out / "cards.json").write_text(json.dumps(cards))
    (out / "machine.json").write_text(json.dumps(machine()))


def differences(here: np.ndarray, there: np.ndarray) -> dict[str, float]:
    """Return the largest difference of each kind, relative to the largest of its kind here."""
    found = {}
    for kind, (first, many) in KINDS.items():
        columns = slice(first, first + many)
        largest = float(np.abs(here[..., columns]).max())
        apart = float(np.abs(here[..., columns] - there[..., columns]).max())
        found[kind] = apart / largest if largest > 0 else apart
    return found


def card_differences(here: dict[str, Any], there: dict[str, Any]) -> tuple[float, bool]:
    """Return the largest relative difference of a metric or the score, and whether all that is decided is the same."""
    one, other = here.pop("metrics"), there.pop("metrics")
    pairs = [(one[name]["value"], other[name]["value"]) for name in one if name in other]
    pairs.append((here.pop("score"), there.pop("score")))
    worst = max(abs(a - b) / max(abs(a), 1e-12) for a, b in pairs)
    return worst, here == there and list(one) == list(other)


def compare(names: list[str], machines: list[str]) -> dict[str, Any]:
    """Record attempts, replay them here and on the other machines, and return what differs."""
    with TemporaryDirectory(prefix="trocar-elsewhere-") as place:
        folder = Path(place)
        record(folder, names)
        ours = list(replay(folder))
        result: dict[str, Any] = {"here": machine(), "machines": {}}
        for name in machines:
            code, theirs = replay_elsewhere(folder, name)
            attempts = {}
            for (what, played, card), (other, their_card) in zip(ours, theirs, strict=True):
                metrics, decided = card_differences(dict(card), their_card)
                attempts[what] = {
                    "ticks": len(played),
                    "peak_force_n": float(np.abs(played[..., FORCE : FORCE + 3]).max()),
                    **differences(played, other),
                    "metrics": metrics,
                    "touches_differ": int((played[..., TOUCH] != other[..., TOUCH]).sum()),
                    "decisions_same": decided,
                }
            result["machines"][name] = {"code": code, "attempts": attempts}
    return result


def within(one: dict[str, Any]) -> bool:
    """Return whether an attempt came out as promised."""
    worst = max(one[kind] for kind in (*KINDS, "metrics"))
    return worst <= MOST and one["touches_differ"] == 0 and one["decisions_same"]


def main() -> int:
    """Compare and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--attempts", default="palpate,lift,bimanual-hold,palpate:novice,palpate:page")
    parser.add_argument("--machines", default=",".join(MACHINES))
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--replay", nargs=2, type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.replay:
        write_replay(*arguments.replay)
        return 0
    found = compare(arguments.attempts.split(","), arguments.machines.split(","))
    every = [one for each in found["machines"].values() for one in each["attempts"].values()]
    if arguments.json:
        print(json.dumps(found, indent=2))
        return 0 if all(map(within, every)) else 1
    print(f"here: {found['here']}")
    for name, each in found["machines"].items():
        print(f"\n{name}: {each['code']}")
        for what, one in each["attempts"].items():
            print(f"  {what}: {one['ticks']} ticks, peak force {one['peak_force_n']:.3f} N")
            print("    " + ", ".join(f"{kind} {one[kind]:.1e}" for kind in (*KINDS, "metrics")))
            decided = "the same" if one["decisions_same"] else "NOT THE SAME"
            print(f"    touch bits that differ: {one['touches_differ']}; mistakes, times, pass: {decided}")
    return 0 if all(map(within, every)) else 1


if __name__ == "__main__":
    sys.exit(main())
