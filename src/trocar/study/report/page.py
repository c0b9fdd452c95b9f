"""The report: one HTML file that holds everything it shows and asks nothing of the network."""

from __future__ import annotations

from base64 import b64encode
from collections import Counter
from collections.abc import Mapping, Sequence
from types import SimpleNamespace

from jinja2 import Environment, PackageLoader, StrictUndefined

from trocar import __version__
from trocar.study.film import PRESS
from trocar.study.linear_range import Ranges
from trocar.study.measured.leg import MeasuredLeg
from trocar.study.protocol import MARGIN, REFERENCE, Study
from trocar.study.report import protocol_tables, result_tables, statistic_tables
from trocar.study.report.answer import answer, overlooked
from trocar.study.report.figures.animation import Moving, animation_alt
from trocar.study.report.measured_section import measured_parts
from trocar.study.report.picture import Picture
from trocar.study.report.table import Table, percent
from trocar.units import MILLISECOND

CONTENTS = (
    ("protocol", "What was done"),
    ("small", "The small load"),
    ("paper", "The paper's load"),
    ("range", "The linear range"),
    ("validity", "How hard the waves may be pressed"),
    ("held", "How the block is held"),
    ("angle", "At an angle, and two tools"),
    ("motion", "In motion"),
    ("published", "Statistics as published"),
    ("agreement", "What answers the question"),
    ("strength", "Does the tissue tear?"),
    ("cost", "What it costs"),
    ("ledger", "Reproduction ledger"),
    ("tissue", "Tissue and sources"),
    ("made", "How this was made"),
    ("licence", "Licence and sources"),
)

MEASURED = ("measured", "Measured tissue")


def environment() -> Environment:
    """Return the templates that ship with the package, escaping whatever is put into them."""
    made = Environment(
        loader=PackageLoader("trocar.study.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        keep_trailing_newline=True,
    )
    made.globals |= {"version": __version__, "style": made.loader.get_source(made, "style.css")[0]}  # type: ignore[union-attr]
    return made


def report_page(
    study: Study,
    pictures: Mapping[str, Picture],
    film: Moving,
    *,
    ledger: Sequence[Mapping[str, object]] = (),
    ranges: Ranges | None = None,
    measured: MeasuredLeg | None = None,
    command: str = "",
    created: str = "",
) -> str:
    """Return the report of a study as HTML.

    Args:
        study: the results.
        pictures: as `trocar.study.report.pictures.pictures` draws them.
        film: the moving picture.
        ledger: entries with id, published (or printed), recomputed, unit, verdict, note; none where not kept.
        ranges: verdicts on the linear range by case; None where not assessed.
        measured: what was foretold of measured tissue; None where no data were named.
        command: that made it.
        created: when, as it shall be shown.
    """
    plan = study.plan
    not_predicted = "Not a prediction: outside the linear range."
    said = answer(study, ranges)
    tables = SimpleNamespace(
        protocol=protocol_tables.protocol_table(study),
        small=_deflections(study, "small"),
        paper=_deflections(study, "paper", not_predicted if said.paper_inside is False else ""),
        range=result_tables.range_table(study, ranges),
        validity=result_tables.validity_table(study),
        supports=result_tables.support_table(study),
        tilted=_deflections(study, "tilted"),
        pair=_deflections(study, "pair"),
        tap=_deflections(study, "tap"),
        published=statistic_tables.published_table(study),
        normal=statistic_tables.normal_table(study),
        agreement=statistic_tables.agreement_table(study),
        uncertainty=statistic_tables.uncertainty_table(study),
        equivalence=statistic_tables.equivalence_table(study),
        strength=result_tables.strength_table(study, predicted=said.paper_inside is not False),
        cost=result_tables.cost_table(study),
        ledger=statistic_tables.ledger_rows(tuple(ledger)),
        tissue=protocol_tables.tissue_table(study),
        machine=protocol_tables.machine_table(study, command, created),
    )
    return (
        environment()
        .get_template("report.html.jinja")
        .render(
            study=study,
            answer=said,
            contents=CONTENTS if measured is None else _with_measured(CONTENTS),
            measured=measured,
            parts=() if measured is None else measured_parts(measured),
            tables=tables,
            pictures=pictures,
            film=b64encode(film.gif).decode(),
            still=b64encode(film.still).decode(),
            film_alt=animation_alt(study.film),
            press_ms=f"{PRESS / MILLISECOND:g}",
            small=f"{plan.small:g} N",
            peak=f"{plan.peak:g} N",
            margin=percent(MARGIN),
            overlooked=percent(overlooked(study.paper[REFERENCE].block)),
            samples=study.paper[REFERENCE].time.size,
            verdicts=_verdicts(ledger),
            created=created,
        )
    )


def _with_measured(contents: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    """Return the contents with the third leg in front of what it costs."""
    place = [key for key, _ in contents].index("cost")
    return (*contents[:place], MEASURED, *contents[place:])


def _deflections(study: Study, key: str, note: str = "") -> Table:
    name, comparison = result_tables.cases(study)[key]
    return result_tables.deflection_table(comparison, f"Largest deflections: {name}.", note)


def _verdicts(ledger: Sequence[Mapping[str, object]]) -> str:
    counts = Counter(str(entry["verdict"]) for entry in ledger)
    parts = ", ".join(f"{count} {verdict}" for verdict, count in counts.most_common())
    return f"{len(ledger)} entries: {parts}."
