"""`python -m centrode` is the command line."""

import sys

from centrode.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
