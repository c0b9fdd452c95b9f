"""Fit the live tissues anew, and print src/trocar/simulation/live_fits.py's table: what to do when a preset changes.

Run: python bench/live_fits.py [TISSUE ...]; those that are kept already if none is named.
"""

from __future__ import annotations

import sys

from trocar.model import Support
from trocar.simulation.live import LIVE_SIZE
from trocar.simulation.live_fits import FITS
from trocar.tissues.catalogue import tissue
from trocar.waves.fit import fitted_stack

DIGITS = 9  # what a fit has on one machine is another's to seven
SHEET = ("tension_x", "tension_y", "areal_density", "bending", "damping", "retardation_time")


def number(value: float) -> str:
    """Return a coefficient as it is kept."""
    return repr(float(f"{value:.{DIGITS}g}"))


def main() -> None:
    """Print the table."""
    for name in sys.argv[1:] or FITS:
        fit = fitted_stack(tissue(name), size=LIVE_SIZE, support=Support.BASE)
        print(f'    "{name}": Fit(\n        stack=Stack(\n            sheets=(')
        for sheet in fit.stack.sheets:
            print(f'                Sheet(\n                    name="{sheet.name}",')
            for key in SHEET:
                print(f"                    {key}={number(getattr(sheet, key))},")
            print("                ),")
        print("            ),\n            couplings=(")
        for bed in fit.stack.couplings:
            stiffness, time = number(bed.stiffness), number(bed.retardation_time)
            print(f"                Coupling(stiffness={stiffness}, retardation_time={time}),")
        print(f"            ),\n        ),\n        error={number(fit.error)},\n    ),")


if __name__ == "__main__":
    main()
