"""Print what one tick of the live tissue costs: the same as `trocar bench step`."""

import sys

from trocar.cli import main

sys.exit(main(["bench", "step", *sys.argv[1:]]))
