"""Scissors: two blades that meet along a short edge, from the tip back along the shaft.

Open, either blade leans away from the shaft's line by the same angle about a pivot one edge's length behind the tip, to
both sides of the line in the plane that roll turns. At s behind the tip the blades stand

    +-g(s) y,   g(s) = (length - s) tan(angle),

off the line, y the direction they open in. A surface lies between them there where one is above it and the other below.
"""

from __future__ import annotations

SPLIT = 3e-4  # [m] beyond what lies between them, at both ends: a narrower strand between two snips would not hold
EDGE = 10e-3  # [m] of the blades of 5 mm scissors, as far as they cut
LEAN = 0.36  # tan of the angle of each open blade: 20 degrees
"""How far open blades stand off the shaft's line, for each metre from the pivot [1]."""
