"""Coefficients of the sheets that tasks are done on, kept as data, so that every machine has the same.

Some coefficients hardly matter to what is matched, so where a fit ends depends on rounding: two machines agree to seven
digits of a force, with two versions of SciPy to fewer. An attempt is kept as poses, and its forces follow from these
numbers. `bench/live_fits.py` prints them; `tests/simulation/test_live.py` holds them to what the fit finds.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from trocar.waves.fit import Fit
from trocar.waves.stack import Coupling, Sheet, Stack

FITS: Mapping[str, Fit] = MappingProxyType(
    {
        "skin": Fit(
            stack=Stack(
                sheets=(
                    Sheet(
                        name="epidermis",
                        tension_x=1.48794401e-05,
                        tension_y=1.48794401e-05,
                        areal_density=0.0099819167,
                        bending=1.82929778e-08,
                        damping=0.0,
                        retardation_time=0.000148544614,
                    ),
                    Sheet(
                        name="dermis",
                        tension_x=20.250042,
                        tension_y=20.250042,
                        areal_density=0.0099819167,
                        bending=3.30227718e-05,
                        damping=0.0,
                        retardation_time=0.000148544614,
                    ),
                    Sheet(
                        name="fat",
                        tension_x=3.18399549e-05,
                        tension_y=3.18399549e-05,
                        areal_density=9.9819167,
                        bending=3.08220348e-05,
                        damping=0.0,
                        retardation_time=0.000148544614,
                    ),
                ),
                couplings=(
                    Coupling(stiffness=1763236320000.0, retardation_time=0.00286478898),
                    Coupling(stiffness=34389386.7, retardation_time=0.00286478898),
                    Coupling(stiffness=555700.083, retardation_time=0.000770280943),
                ),
            ),
            error=0.0559923328,
        ),
        "silicone-pad": Fit(
            stack=Stack(
                sheets=(
                    Sheet(
                        name="skin",
                        tension_x=0.0200604024,
                        tension_y=0.0200604024,
                        areal_density=0.0112833206,
                        bending=7.34805973e-06,
                        damping=0.0,
                        retardation_time=0.000169765273,
                    ),
                    Sheet(
                        name="body",
                        tension_x=4.87544079,
                        tension_y=4.87544079,
                        areal_density=11.2833206,
                        bending=5.97805627e-05,
                        damping=0.0,
                        retardation_time=0.000437936,
                    ),
                ),
                couplings=(
                    Coupling(stiffness=95486570.1, retardation_time=0.00152788745),
                    Coupling(stiffness=884146.653, retardation_time=0.00055506495),
                ),
            ),
            error=0.0358648447,
        ),
    }
)
"""By preset, for `LIVE_SIZE` on a held base."""
