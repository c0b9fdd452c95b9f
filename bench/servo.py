"""Print how the servo keeps time: the same as `trocar bench servo`."""

import sys

from trocar.cli import main

if __name__ == "__main__":  # its processes import this file
    sys.exit(main(["bench", "servo", *sys.argv[1:]]))
