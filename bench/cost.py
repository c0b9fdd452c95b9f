"""Print what waves and finite elements cost at equal measured error: the same as `trocar bench cost`."""

import sys

from trocar.cli import main

sys.exit(main(["bench", "cost", *sys.argv[1:]]))
