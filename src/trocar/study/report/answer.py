"""The answer in words: how far the wave model can be trusted, written from the numbers alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray, Support
from trocar.study.compare import Comparison
from trocar.study.linear_range import Ranges
from trocar.study.protocol import MODEL, REFERENCE, Study
from trocar.study.report.figures.style import label, three
from trocar.study.report.figures.supports import WORDS
from trocar.study.report.table import percent
from trocar.study.statistics.published import t_test
from trocar.tissues.catalogue import record
from trocar.units import MILLIMETRE, MILLISECOND

MEMBRANE = "wave-membrane"


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One number of the answer, large, with what it is."""

    value: str
    meaning: str


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What the report says first.

    Attributes:
        paragraph: the answer.
        limits: one sentence for each thing that bounds it.
        figures: the numbers to remember.
        small_inside: whether the small load lies inside the linear range; None where nobody assessed it.
        paper_inside: the same of the paper's load; False too where it would push deeper than the block is thick.
        paper_verdict: that in a sentence.
    """

    paragraph: str
    limits: tuple[str, ...]
    figures: tuple[Figure, ...]
    small_inside: bool | None
    paper_inside: bool | None
    paper_verdict: str


def answer(study: Study, ranges: Ranges | None) -> Answer:
    """Write the answer.

    Args:
        study: the results.
        ranges: verdicts on the linear range, by case.
    """
    small, plan = study.small, study.plan
    solid, membrane = study.agreement["small"][MODEL], study.agreement["small"][MEMBRANE]
    peak = float(small[REFERENCE].block.max())
    error = max(curve.largest_relative_error for curve in solid.values())
    spread = max(curve.nrmse for curve in solid.values())
    by_membrane = max(curve.largest_relative_error for curve in membrane.values())
    bound = max(
        2 * numbers.comparison.uncertainty / float(small[REFERENCE].deflection[layer].max())
        for layer, numbers in study.numerics.items()
    )
    resolved = any(numbers.comparison.resolved for numbers in study.numerics.values())
    ratio = small[REFERENCE].cpu_seconds / small[MODEL].cpu_seconds
    in_time = study.tap[REFERENCE].cpu_seconds / study.tap[MODEL].cpu_seconds
    title = record(plan.tissue).title
    paragraph = (
        f"On {title[0].lower() + title[1:]}, {_support(plan.support)}, pressed with {plan.small:g} N by a "
        f"{plan.diameter / MILLIMETRE:g} mm tool, {label(MODEL)} follows three-dimensional finite elements within "
        f"{percent(error)} of the peak in every layer, at every moment of press and release ({percent(spread)} as "
        "NRMSE), where the "
        f"block deflects {three(peak / MILLIMETRE)} mm. "
        + (
            f"That is more than the uncertainty of computing it, {percent(bound)}. "
            if resolved
            else f"The uncertainty of computing this difference is {percent(bound)}, so none is left that "
            "could be told from numerical error. "
        )
        + f"{label(MEMBRANE)}, the paper's kind of model with fitted coefficients, "
        f"stays within {percent(by_membrane)}. "
        f"The same case costs {label(MODEL)} {_times(ratio)} less processor time, set-up included."
    )
    verdict, inside = _paper_verdict(study, ranges)
    near = None if ranges is None else ranges.get("small")
    return Answer(
        paragraph=paragraph,
        limits=(
            *_small_limit(plan.small, ranges),
            verdict if inside is not False else f"{verdict} That is not a prediction.",
            *_limits(study),
        ),
        figures=(
            Figure(value=percent(error), meaning=f"largest difference of {label(MODEL)} in any layer"),
            Figure(value=percent(by_membrane), meaning=f"the same of {label(MEMBRANE)}"),
            Figure(value=f"± {percent(bound)}", meaning="numerical uncertainty of the comparison"),
            Figure(
                value=f"{_round(ratio)}×",
                meaning=f"cheaper: a press; {_round(in_time)}× a tap, at default settings",
            ),
        ),
        small_inside=None if near is None else near.inside,
        paper_inside=inside,
        paper_verdict=verdict,
    )


def overlooked(curve: FloatArray) -> float:
    """Return how much too far a model could deflect at every moment and still pass the published t-test [1].

    Args:
        curve: samples of the reference, shape (n,).
    """
    low, high = 0.0, 10.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (low, middle) if t_test((1 + middle) * curve, curve).rejected else (middle, high)
    return low


def _limits(study: Study) -> tuple[str, ...]:
    sentences = []
    for support, comparison in study.supports.items():
        if support is not study.plan.support:
            differences = " and ".join(
                f"{label(model)} by {percent(_at_peak(comparison, model), signed=True)}"
                for model in (MODEL, MEMBRANE)
            )
            sentences.append(
                f"{_support(support).capitalize()}, the same press differs: {differences} at the peak."
            )
    worst = {model: _over_time(study.tap, model) for model in (MODEL, MEMBRANE)}
    duration = study.tap.case.duration / MILLISECOND
    sentences.append(
        f"In motion, during a tap of {duration:g} ms, {label(MODEL)} stays within {percent(worst[MODEL])} "
        "of the peak and "
        f"{label(MEMBRANE)} within {percent(worst[MEMBRANE])}"
        + (
            ": it is fitted to how the solid answers slow loads and lags behind in faster ones."
            if worst[MEMBRANE] > 0.05
            else "."
        )
    )
    sentences.append(
        "It is model against model: finite elements of the same linear tissue. No measurement of living "
        "tissue is part of "
        "it, and moduli of living tissue are known far less closely than these figures."
    )
    return tuple(sentences)


def _small_limit(force: float, ranges: Ranges | None) -> tuple[str, ...]:
    """Return what bounds the small load itself, where it was assessed."""
    verdict = None if ranges is None else ranges.get("small")
    if verdict is None:
        return ()
    decided = verdict.limiting.replace("_", " ")
    end = f"{three(verdict.force_limit)} N, decided by the {decided}"
    if verdict.inside:
        return (f"All this holds for small loads: the linear range of this press ends at {end}.",)
    return (
        f"Even {force:g} N lies outside the linear range, which ends at {end}: nothing here is a prediction.",
    )


def _paper_verdict(study: Study, ranges: Ranges | None) -> tuple[str, bool | None]:
    plan = study.plan
    depth = float(study.paper[REFERENCE].block.max())
    thickness = study.paper.case.tissue.thickness
    said = (
        f"Under the paper's {plan.peak:g} N linear finite elements say {three(depth / MILLIMETRE)} mm, in a block "
        f"{three(thickness / MILLIMETRE)} mm thick"
    )
    verdict = None if ranges is None else ranges.get("paper")
    if verdict is not None and verdict.inside:
        return f"{said}: inside the linear range.", True
    if verdict is not None:
        return (
            f"{said}: outside the linear range, which ends at {three(verdict.force_limit)} N "
            f"({verdict.limiting.replace('_', ' ')})."
        ), False
    if depth > thickness:
        return f"{said}, which cannot be: the load is far outside the linear range.", False
    return f"{said}; whether that lies inside the linear range is not assessed.", None


def _at_peak(comparison: Comparison, model: str) -> float:
    truth = float(comparison[REFERENCE].block.max())
    return (float(comparison[model].block.max()) - truth) / truth


def _over_time(comparison: Comparison, model: str) -> float:
    truth = comparison[REFERENCE].block
    return float(np.abs(comparison[model].block - truth).max() / truth.max())


def _support(support: Support) -> str:
    return WORDS[support].replace("\n", " ").split(": ", 1)[1].replace(" (the paper)", "")


def _times(ratio: float) -> str:
    return f"{_round(ratio)} times" if ratio >= 1 else "no"


def _round(ratio: float) -> str:
    return f"{float(f'{ratio:.2g}'):g}"
