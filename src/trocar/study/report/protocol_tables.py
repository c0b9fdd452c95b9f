"""What was done: the protocol and how its gaps were filled, the tissue and its sources, the machine."""

from __future__ import annotations

from collections.abc import Iterator

from trocar import __version__
from trocar.study.plan import PERIOD, RATE, TAP
from trocar.study.protocol import Study
from trocar.study.report.figures.supports import WORDS
from trocar.study.report.table import Table, count
from trocar.tissues.catalogue import record
from trocar.tissues.record import Statement, Status
from trocar.tissues.tissue import Tissue
from trocar.units import DEGREE, MILLIMETRE, MILLISECOND


def protocol_table(study: Study) -> Table:
    """Return the paper's protocol, what it left open, and what was taken instead."""
    plan, case = study.plan, study.small.case
    a, b = (f"{side / MILLIMETRE:g}" for side in case.size)
    layers = ", ".join(f"{layer.name} {layer.thickness / MILLIMETRE:g} mm" for layer in case.tissue.layers)
    places = " and ".join(f"{tool.position[0] / MILLIMETRE:g} mm" for tool in study.pair.case.tools)
    ramp = plan.peak / RATE
    rows = (
        (
            "block",
            "60 mm × 60 mm; the dermis 1 mm thick, the other layers not printed",
            f"{a} mm × {b} mm; {layers}",
        ),
        (
            "tissue",
            "moduli, Poisson's ratios, damping: “literature values”, not printed",
            "the table of the tissue, each value with its source",
        ),
        (
            "support",
            "“fixed support at all edges”; the base is not mentioned",
            f"{_support(study)}; the others in the table of supports",
        ),
        (
            "tool",
            "5 to 8 mm, shape and contact not stated",
            f"flat disc of {plan.diameter / MILLIMETRE:g} mm, the force spread evenly over it",
        ),
        (
            "load",
            "5 N at 0.05 N/s on and off, “over a time period of 100 seconds”: 5 N takes 100 s each way",
            (
                f"{plan.peak:g} N, {ramp:g} s up and {ramp:g} s down; besides, {plan.small:g} N at the same rate"
            ),
        ),
        (
            "load in the wave model",
            "none: its equation 5 only releases an initial shape",
            "the same traction in every model",
        ),
        (
            "wave model",
            "one membrane, one mode, of the dermis",
            (
                f"{count(study.small['wave-solid'].dofs)} unknowns (WaveSolid), "
                f"{count(study.small['wave-membrane'].dofs)} (WaveMembrane)"
            ),
        ),
        (
            "finite elements",
            "program, elements and mesh not stated",
            f"20-node bricks, {count(study.small['fea'].dofs)} unknowns in a quarter of the block",
        ),
        (
            "sampling",
            "not stated; its t critical fits 81 samples a model",
            f"{study.small['fea'].time.size} samples, every {PERIOD:g} s of {2 * ramp:g} s",
        ),
        (
            "tool at an angle",
            "drawn, the angle not stated",
            f"{plan.tilt / DEGREE:g}° from the normal, {plan.small:g} N along the tool",
        ),
        ("two tools", "drawn, places not stated", f"at x = {places}, {plan.small:g} N each"),
        (
            "motion",
            "“static mechanical study”",
            f"quasi-static; besides, a tap of {2 * TAP / MILLISECOND:g} ms with inertia and damping",
        ),
        *_own_rows(plan.layers),
    )
    return Table(
        caption="The protocol: what the paper says, and what was done here where it leaves something open.",
        head=("", "the paper", "here"),
        rows=rows,
    )


def _own_rows(layers: Tissue) -> Iterator[tuple[str, str, str]]:
    """Yield what must be said of a tissue that remembers, or that has laws for large strain."""
    if layers.relaxation_times:
        yield (
            "memory",
            "none",
            "as the layers state it; left out under clamped sides and where it is pressed hard",
        )
    if layers.large_deformation:
        yield "law", "linear", "linear, but where it is pressed hard: there as the layers state it"


def tissue_table(study: Study) -> Table:
    """Return every value of the tissue with its source."""
    tissue = record(study.plan.tissue)
    rows = tuple(
        (f"{layer.name}: {item.title}", _value(item), _status(item), f"{item.source}; {item.method}")
        for layer in tissue.layers
        for item in layer.stated
    )
    return Table(
        caption=f"{tissue.title} (preset “{tissue.name}”): every value, its spread and where it comes from.",
        head=("property", "value", "status", "source and method"),
        rows=rows,
        note="read: in the source or its abstract; derived: computed from values read; chosen: an engineering choice; "
        "REMEMBERED: from memory, verify before citing. A spread after ± is a standard deviation, “a to b” a range.",
    )


def machine_table(study: Study, command: str, created: str) -> Table:
    """Return what made the report."""
    rows = (
        ("command", command),
        ("made", created),
        ("Trocar", __version__),
        *((name, version) for name, version in study.machine.items()),
        ("compiling", f"{study.compile_seconds:.1f} s, before anything was timed"),
        ("study", f"{study.seconds:.1f} s by the clock, compiling included, report not"),
    )
    return Table(caption="What made this report.", head=("", ""), rows=rows)


def _support(study: Study) -> str:
    return WORDS[study.plan.support].replace("\n", " ")


def _value(item: Statement) -> str:
    unit = "" if item.unit == "1" else f" {item.unit}"
    spread = f" ({item.spread_text})" if isinstance(item.spread, tuple) else f" {item.spread_text}".rstrip()
    return (
        f"{item.value_text}{unit}{spread}"
        if isinstance(item.spread, tuple)
        else f"{item.value_text}{spread}{unit}"
    )


def _status(item: Statement) -> str:
    return item.status.value.upper() if item.status is Status.REMEMBERED else item.status.value
