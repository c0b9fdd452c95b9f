"""The same command line as `trocar`, by `python -m trocar`."""

from __future__ import annotations

import sys

from trocar.cli import main

if __name__ == "__main__":
    sys.exit(main())
