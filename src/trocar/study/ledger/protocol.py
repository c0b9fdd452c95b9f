"""Sections 4.1, 5.2 and 8: block and tool, the load, the cost, and a reference's year."""

from __future__ import annotations

from dataclasses import replace

from trocar.study.ledger import paper
from trocar.study.ledger.entry import Entry, recomputed_entry, unspecified_entry

SECONDS_A_MINUTE = 60.0
VOLUMES_A_YEAR = 2  # Annals of Surgery


def protocol_entries(
    wave_seconds: float | None = None, fea_seconds: float | None = None
) -> tuple[Entry, ...]:
    """Return the entries of block, load, cost and references.

    Args:
        wave_seconds: time the wave model takes here for the case [s]; None where not measured.
        fea_seconds: time the finite elements take for the same case [s]; None where not measured.
    """
    ramp = float(paper.FORCE_N) / float(paper.RATE_N_S)
    small, large = (float(diameter) for diameter in paper.TOOL_MM)
    side = float(paper.SIDE_MM)
    return (
        unspecified_entry(
            "block_over_tool",
            "1",
            f"Tools of 5 to 8 mm are named, the one used is not; the side is {side / large:.3g} to "
            f"{side / small:.3g} diameters.",
            side / large,
        ),
        recomputed_entry(
            "load_time",
            paper.LOAD_TIME_S,
            ramp,
            "s",
            "5 N at 0.05 N/s takes 100 s one way; the text can also be read as 100 s for both ways.",
        ),
        recomputed_entry(
            "load_cycle",
            paper.LOAD_TIME_S,
            2 * ramp,
            "s",
            "Read as one time for loading and unloading it contradicts the rate, which needs 100 s a way.",
        ),
        unspecified_entry(
            "load_steps",
            "1",
            "An increment is given in N/s; in steps of one second it is 0.05 N, so many each way.",
            ramp,
        ),
        _cost(wave_seconds, fea_seconds),
        _year_of_reference_7(),
    )


def _cost(wave_seconds: float | None, fea_seconds: float | None) -> Entry:
    """Return the cost ratio: reproduced where ours is at least the paper's, as it claims a saving."""
    claimed = float(paper.FEA_MINUTES) * SECONDS_A_MINUTE / float(paper.WAVE_SECONDS)
    stated = f"{claimed:g} times on a Core 2 Duo, mesh and steps not given"
    entry = unspecified_entry(
        "cost_ratio",
        "1",
        f"{stated}; not measured in this run.",
        printed=f"{paper.WAVE_SECONDS} s, approximately {paper.FEA_MINUTES} minutes",
    )
    if wave_seconds is None or fea_seconds is None:
        return entry
    ratio = fea_seconds / wave_seconds
    return replace(
        entry,
        recomputed=ratio,
        note=f"{stated}; here {wave_seconds:.3g} s against {fea_seconds:.3g} s, both on one machine, at default "
        "settings and not at equal error.",
    )


def _year_of_reference_7() -> Entry:
    """Return the year of reference 7 from its volume and those of the others in the same journal."""
    others = [(int(volume), int(year)) for key, (volume, year) in paper.ANNALS_OF_SURGERY.items() if key != 7]
    volume, printed = paper.ANNALS_OF_SURGERY[7]
    years = {year + (int(volume) - other) // VOLUMES_A_YEAR for other, year in others}
    last = max(
        years
    )  # an odd count of volumes may end in either of two years; the later is nearer the printed
    return recomputed_entry(
        "reference_7_year",
        printed,
        last,
        "year",
        f"Volume {volume} of Annals of Surgery, two volumes a year, from references 2 and 14.",
    )
