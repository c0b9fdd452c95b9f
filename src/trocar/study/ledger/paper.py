"""What the paper prints, digit for digit. Numbers only; nothing here is computed.

Source: S. Patel and J. Suthakorn, doi 10.1007/978-3-319-27707-3_16; section, equation or table beside each.
"""

from __future__ import annotations

from types import MappingProxyType

# Table 1, the dermis
SIDE_MM = "60"
THICKNESS_MM = "1"
AREA_MM2 = "3600"
VOLUME_MM3 = "3600"
AREA_DENSITY_G_MM2 = "1.8e-8"
WEIGHT_G = "6.48e-5"
DENSITY_G_MM3 = "1.8e-8"
DENSITY_G_M3 = "18"
PRESTRESS_ALONG_MPA = "0.024"
PRESTRESS_ACROSS_MPA = "0.0093"
PRESTRESS_MPA = "2.57e-2"
TENSION_N_M = "1.54e-3"

# Equations 4 and 5
SIDE_M = "0.06"
SHAPE_FACTOR = "5"  # f(x, y) = 5 x (1 - x) y (1 - y)
B11 = "6.11e-6"
LAMBDA11 = "0.686"

# Section 4.1: tools of 5 to 8 mm; section 5.2: the load
TOOL_MM = ("5", "8")
FORCE_N = "5"
RATE_N_S = "0.05"
LOAD_TIME_S = "100"

# Section 8: 6 seconds against about 4 minutes
WAVE_SECONDS = "6"
FEA_MINUTES = "4"

# Table 2: layer -> (t Stat, P two tail, t Critical Value)
T_TESTS = MappingProxyType(
    {
        "epidermis": ("-0.912", "0.364", "1.975"),
        "dermis": ("0.911", "0.395", "1.975"),
        "fat": ("0.853", "0.363", "1.975"),
    }
)
ALPHA = "0.05"

# References in one journal, two volumes a year: number -> (volume, year)
ANNALS_OF_SURGERY = MappingProxyType({2: ("234", "2001"), 7: ("220", "1998"), 14: ("243", "2006")})
