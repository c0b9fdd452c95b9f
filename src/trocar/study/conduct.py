"""Run a study and write its folder: everything that can be refused is refused before the work begins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from trocar.study.ledger import ledger
from trocar.study.linear_range import Ranges
from trocar.study.measured.leg import MeasuredLeg, run_leg
from trocar.study.measured.sets import read_sets
from trocar.study.paper_preset import PaperStudy, run_paper_study
from trocar.study.plan import Plan
from trocar.study.protocol import MODEL, REFERENCE, Study, Watch, run_study
from trocar.study.writing.folder import check_folder
from trocar.study.writing.paper_results import write_paper_study
from trocar.study.writing.results import write_study

PAPER_PRESET = "paper-2014"
STUDY_SHARE = 0.85  # of the whole work, the rest is drawing and writing
MEASURED_SHARE = 0.35  # of the whole work, where there are measured sets


@dataclass(frozen=True, kw_only=True)
class Conducted:
    """A study that was run and written.

    Attributes:
        study: the results.
        report: the path of the report.
        measured: the third leg, or None.
        writing_seconds: spent drawing and writing [s], by the clock.
    """

    study: Study
    report: Path
    measured: MeasuredLeg | None
    writing_seconds: float


def conduct(
    plan: Plan,
    out: Path,
    *,
    data: Path | None = None,
    command: str = "",
    watch: Watch = lambda _what, _share: None,
) -> Conducted:
    """Run the validation study and write it.

    Args:
        plan: the choices.
        out: the folder; new, empty, or an earlier study's, which is replaced whole.
        data: a folder of measured sets, for the third leg; None leaves it out.
        command: that asked for it, recorded.
        watch: told what is being done and the share of all done, 0 to 1.

    Raises:
        InputError: the plan or a folder is impossible, or a measured set is broken.
        OSError: the folder cannot be written.
        SolverError: a model could not be solved.
    """
    check_folder(out)
    _refuse_impossible(plan)
    measured, begun = None, 0.0
    if data is not None:  # first: what is wrong with the data is then told soon
        begun = MEASURED_SHARE
        measured = run_leg(read_sets(data), lambda what, share: watch(what, MEASURED_SHARE * share))
    study = run_study(plan, lambda what, share: watch(what, begun + (STUDY_SHARE - begun) * share))
    began = perf_counter()
    watch("drawing and writing", STUDY_SHARE)
    report = write_study(
        study, out, ledger=_ledger(study), ranges=_ranges(study), measured=measured, command=command
    )
    watch("done", 1.0)
    return Conducted(study=study, report=report, measured=measured, writing_seconds=perf_counter() - began)


def conduct_paper(out: Path, *, command: str = "") -> tuple[PaperStudy, Path]:
    """Run the paper's formula, printed and corrected, and write it; return results and report.

    Raises:
        InputError: the folder is impossible.
        OSError: it cannot be written.
    """
    check_folder(out)
    study = run_paper_study()
    return study, write_paper_study(study, out, ledger=_ledger(None), command=command)


def _refuse_impossible(plan: Plan) -> None:
    """Make every case once: each refuses what it cannot be, before any is computed."""
    for load in (plan.small, plan.peak):
        plan.central(load)
    for case in (plan.tilted, plan.pair, plan.tap):
        case()


def _ledger(study: Study | None) -> Sequence[Mapping[str, object]]:
    """Return the reproduction ledger's entries as plain values, with what this machine took for the paper's load."""
    if study is None:
        return [entry.as_dict() for entry in ledger()]
    seconds = {
        "wave_seconds": study.paper[MODEL].cpu_seconds,
        "fea_seconds": study.paper[REFERENCE].cpu_seconds,
    }
    return [entry.as_dict() for entry in ledger(seconds)]


def _ranges(study: Study) -> Ranges:
    """Return the verdicts on the linear range by case."""
    return {name: comparison[MODEL].linear_range for name, comparison in study.cases.items()}
