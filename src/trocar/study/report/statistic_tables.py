"""The paper's statistics, and beside them those that answer whether the models agree."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

from trocar.study.protocol import BLOCK, Study
from trocar.study.report.figures.style import label, power_of_ten, three, with_uncertainty
from trocar.study.report.table import Table, percent
from trocar.study.statistics.curves import CurveComparison
from trocar.units import MILLIMETRE

MICROMETRE = 1e-6  # [m]


def _layers(study: Study, load: str) -> list[tuple[str, str, CurveComparison]]:
    return [
        (label(model), "whole block" if layer == BLOCK else layer, curve)
        for model, layers in study.agreement[load].items()
        for layer, curve in layers.items()
    ]


def published_table(study: Study) -> Table:
    """Return the equal-variance t-test of each layer, as the paper makes it, under the paper's load."""
    rows = []
    for model, layer, curve in _layers(study, "paper"):
        test = curve.published_t_test
        rows.append(
            (
                model,
                layer,
                three(test.t),
                f"{test.df:g}",
                three(test.p),
                f"{test.critical:.4g}",
                _yes(test.p > test.alpha),
                _yes(test.t < test.critical),
            )
        )
    return Table(
        caption=f"Two-sample t-test with equal variances, wave model against finite elements, {study.plan.peak:g} N.",
        head=(
            "model",
            "upper face of",
            "t",
            "df",
            "p (two tails)",
            "t critical",
            "p > 0.05",
            "t < t critical",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 5),
        note="Whatever the load, the result is the same: in linear models both curves scale with it.",
    )


def normal_table(study: Study) -> Table:
    """Return mean and standard deviation of each layer's samples under finite elements and each model."""
    rows = []
    for model, layer, curve in _layers(study, "paper"):
        one, two = curve.published_normal_reference, curve.published_normal_model
        rows.append(
            (
                model,
                layer,
                three(one.mean / MILLIMETRE),
                three(two.mean / MILLIMETRE),
                three(one.sd / MILLIMETRE),
                three(two.sd / MILLIMETRE),
                three(one.shapiro_p),
            )
        )
    return Table(
        caption="Normal distributions fitted to the samples, as published, and whether finite elements' "
        "samples are normal.",
        head=(
            "model",
            "upper face of",
            "mean, finite elements / mm",
            "mean, model / mm",
            "sd, finite elements / mm",
            "sd, model / mm",
            "Shapiro-Wilk p",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 5, 6),
        note="A small Shapiro-Wilk p says that the samples are not normal. They cannot be: they rise and "
        "fall with the load.",
    )


def agreement_table(study: Study) -> Table:
    """Return the measures of agreement of whole curves under the small load."""
    rows = []
    for model, layer, curve in _layers(study, "small"):
        limits = curve.limits
        rows.append(
            (
                model,
                layer,
                percent(curve.nrmse),
                three(curve.largest_error / MICROMETRE),
                percent(curve.largest_relative_error),
                f"{curve.peak.time:g} ± {curve.peak.resolution:.3g}",
                f"{curve.peak.force:g}",
                (
                    f"{three(limits.bias / MICROMETRE)} ({three(limits.lower / MICROMETRE)} to "
                    f"{three(limits.upper / MICROMETRE)})"
                ),
                three(1 - curve.concordance.value),
            )
        )
    return Table(
        caption=f"Agreement of whole curves with finite elements under {study.plan.small:g} N.",
        head=(
            "model",
            "upper face of",
            "NRMSE",
            "largest error / µm",
            "of the range",
            "peak shift / s",
            "peak shift / N",
            "bias (limits of agreement) / µm",
            "1 − concordance",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 5, 6, 7, 8),
        note="NRMSE: root mean square error over the range of finite elements. Limits: Bland and Altman's, 95 %. "
        "Concordance: Lin's coefficient, shown as its distance from perfect agreement.",
    )


def equivalence_table(study: Study) -> Table:
    """Return the two one-sided tests with the margin fixed beforehand."""
    rows = []
    for model, layer, curve in _layers(study, "small"):
        honest, naive = curve.equivalence, curve.equivalence_if_independent
        testable = isfinite(honest.p)
        rows.append(
            (
                model,
                layer,
                three(curve.margin / MICROMETRE),
                three(honest.difference / MICROMETRE),
                f"{three(naive.low / MICROMETRE)} to {three(naive.high / MICROMETRE)}",
                three(naive.p) if naive.p >= 1e-4 else "below 0.0001",
                _yes(naive.shown),
                f"{curve.effective_n:.2g} of {curve.n}",
                (_yes(honest.shown) if testable else "no test possible"),
            )
        )
    return Table(
        caption=f"Equivalence by two one-sided tests under {study.plan.small:g} N.",
        head=(
            "model",
            "upper face of",
            "margin / µm",
            "mean difference / µm",
            "90 % interval / µm",
            "p",
            "equivalent",
            "independent samples",
            "equivalent, with these",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 5),
        note="The interval, p and the first verdict treat all samples as independent, as the paper's "
        "test does. Neighbouring "
        "points of one curve are not: the last columns say how many independent samples they are worth and what a test "
        "with so few can show. Below two, no test is possible, and the error itself, above, is the evidence.",
    )


def uncertainty_table(study: Study) -> Table:
    """Return each layer's comparison error beside the numerical uncertainty of both models."""
    rows = []
    for layer, numbers in study.numerics.items():
        difference = numbers.comparison
        rows.append(
            (
                layer,
                with_uncertainty(difference.error / MICROMETRE, 2 * difference.uncertainty / MICROMETRE),
                three(numbers.reference.standard_uncertainty / MICROMETRE),
                numbers.reference.kind.value,
                three(numbers.model.standard_uncertainty / MICROMETRE),
                numbers.model.kind.value,
                "larger than its uncertainty" if difference.resolved else "within its uncertainty",
            )
        )
    return Table(
        caption="WaveSolid minus finite elements on the finest mesh with the most modes, and what "
        "refinement says of both.",
        head=(
            "upper face of",
            "difference ± 2 u / µm",
            "u, finite elements / µm",
            "mesh refinement",
            "u, WaveSolid / µm",
            "mode refinement",
            "the difference is",
        ),
        rows=tuple(rows),
        numeric=(1, 2, 4),
        note="u: standard numerical uncertainty, from three refinements by Richardson extrapolation "
        "(Roache 1994; ASME V&V 20).",
    )


def ledger_rows(ledger: tuple[Mapping[str, object], ...]) -> Table:
    """Return the reproduction ledger; each entry is a mapping as it is written to ledger.json."""
    rows = []
    for entry in ledger:
        recomputed = entry.get("recomputed")
        rows.append(
            (
                str(entry["id"]),
                _printed(entry),
                _number(f"{recomputed:.4g}") if isinstance(recomputed, int | float) else "",
                "" if entry.get("unit", "1") == "1" else str(entry["unit"]),
                str(entry["verdict"]),
                str(entry["note"]),
            )
        )
    return Table(
        caption="Every number of the paper, recomputed from what the paper states.",
        head=("entry", "published", "recomputed", "unit", "verdict", "note"),
        rows=tuple(rows),
        numeric=(1, 2),
        note="reproduced: the stated inputs give the stated value, to the printed digits; inconsistent: "
        "they do not; not "
        "specified: the text does not say enough.",
    )


def _printed(entry: Mapping[str, object]) -> str:
    """Return the published value as it is printed where that is known."""
    text = entry.get("printed") or entry.get("published")
    return "" if text is None else _number(str(text))


def _number(text: str) -> str:
    """Return a number as it is read, "6.48e-05" as "6.48×10⁻⁵"; other text as it is."""
    if not _is_number(text):
        return text
    mantissa, power, _ = text.partition("e")
    return power_of_ten(float(text), sum(map(str.isdigit, mantissa))) if power else text.replace("-", "−")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _yes(fact: bool) -> str:
    return "yes" if fact else "no"
