"""What the paper uses and does not print: nobody can redraw its curves from the text alone."""

from __future__ import annotations

from trocar.study.ledger.entry import Entry, unspecified_entry

LITERATURE = "Taken from the literature cited, not printed."
CURVE = "Only drawn, in figure 6; no number is printed."
FITTED = "Only drawn, in figure 7; no number is printed."

GAPS: tuple[tuple[str, str, str], ...] = (
    ("epidermis_thickness", "mm", LITERATURE),
    ("fat_thickness", "mm", "Taken from a study of injection sites in adults with diabetes, not printed."),
    ("moduli", "kPa", LITERATURE),
    ("poisson_ratios", "1", LITERATURE),
    ("tensile_strengths", "kPa", LITERATURE),
    *((f"density_{layer}", "kg/m3", "Table 1 exists for the dermis only.") for layer in ("epidermis", "fat")),
    *((f"tension_{layer}", "N/m", "Table 1 exists for the dermis only.") for layer in ("epidermis", "fat")),
    ("damping", "1", "A damping factor is named among the inputs of the finite elements, not printed."),
    ("layer_coupling", "N/m3", "Several wave equations are said to interact; how is not said."),
    ("wave_load", "N", "Equation 5 has no force in it: how 5 N enters the wave model is not said."),
    ("fea_mesh", "elements", "Neither elements nor their number nor the solver are named."),
    ("fea_base", "1", "Fixed support at all edges; whether the lower face is held is not said."),
    *((f"max_deflection_{layer}", "mm", CURVE) for layer in ("epidermis", "dermis", "fat")),
    ("peak_shift", "s", "Peaks are said to be shifted between the models; by how much is only drawn."),
    *((f"normal_mean_{layer}", "mm", FITTED) for layer in ("epidermis", "dermis", "fat")),
    *((f"normal_sd_{layer}", "mm", FITTED) for layer in ("epidermis", "dermis", "fat")),
    ("tool_angle", "deg", "Figure 8a shows a tool at an angle; the angle is not printed."),
    ("two_tools_distance", "mm", "Figure 8b shows two tools; where they press is not printed."),
)


def gap_entries() -> tuple[Entry, ...]:
    """Return one entry for each number that is used and not printed."""
    return tuple(unspecified_entry(name, unit, note) for name, unit, note in GAPS)
