"""A study made for tests: everything the real one holds, from meshes too coarse to trust."""

from __future__ import annotations

import os
import pickle
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep

import pytest

from trocar.reference import block_model
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.study import models, protocol
from trocar.study.plan import Plan
from trocar.study.protocol import Study, run_study

COARSE = {"per_radius": 1.0, "growth": 1.5, "top": 0.7, "deepening": 1.5}
LONGEST_WAIT = 300.0  # [s] for another worker to make it

LEDGER = (
    {"id": "b11", "published": 6.11e-6, "printed": "6.11e-6", "recomputed": 6.784e-3, "unit": "m",
     "verdict": "inconsistent", "note": "the factor 4/(ab) is left out"},
    {"id": "density", "published": 18.0, "recomputed": 18.0, "unit": "g/m3", "verdict": "reproduced",
     "note": "<lighter> than air & too light"},
    {"id": "damping", "published": None, "recomputed": None, "unit": "1", "verdict": "not specified",
     "note": "not printed"},
)  # fmt: skip


def small_study() -> Study:
    """Run the quick plan on coarse meshes with long steps."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(protocol, "COARSE_MESH", MeshSize(**COARSE))
        patch.setattr(block_model, "_LONGEST_STEP", 2e-3)
        patch.setitem(models.QUICK_MODELS, "fea", _coarse)
        return run_study(Plan(quick=True))


def shared_small_study(folder: Path) -> Study:
    """Run it once for all workers of a test run: the first makes it, the others read it.

    Args:
        folder: the same for all workers.
    """
    kept, lock = folder / "small-study.pickle", folder / "small-study.lock"
    try:
        lock.touch(exist_ok=False)
    except FileExistsError:
        return _read_when_there(kept, lock)
    try:
        study = small_study()
    except BaseException:
        lock.unlink()  # whoever waits need not wait for nothing
        raise
    partial = folder / "small-study.partial"
    partial.write_bytes(pickle.dumps(study))
    partial.rename(kept)
    return study


def _read_when_there(kept: Path, lock: Path) -> Study:
    began = monotonic()
    while monotonic() - began < LONGEST_WAIT:
        with suppress(FileNotFoundError):
            study = pickle.loads(kept.read_bytes())
            assert isinstance(study, Study)
            return study
        assert lock.exists(), "the worker that made the study failed"
        sleep(0.1)
    raise TimeoutError("no worker made the study")


def _coarse(case):
    return FEASolid(
        case.tissue, size=case.size, support=case.support, around=case.load_at(0.0), mesh=MeshSize(**COARSE)
    )


def shared_folder(base: Path) -> Path:
    """Return the folder all workers of a run share, from the base folder of one."""
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
