"""`centrode` and `python -m centrode` are the command line."""

import importlib
import os
import sys
import threading

from centrode.interruption import INTERRUPTED, end_at_interruption


def main() -> int:
    """Run the command line and return its exit code; Ctrl-C ends it at any moment with a line or in silence."""
    end_at_interruption()
    code: int = importlib.import_module("centrode.cli.main").main()
    if code == INTERRUPTED and any(thread.daemon for thread in threading.enumerate()):
        # what a thread computes nobody waits for any more; Python would close the libraries that it is in
        os._exit(code)
    return code


if __name__ == "__main__":
    sys.exit(main())
