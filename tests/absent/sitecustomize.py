"""Read by every Python that finds it at its start: libraries named in CENTRODE_WITHOUT cannot be imported."""

import os
import sys

for name in os.environ.get("CENTRODE_WITHOUT", "").split():
    sys.modules[name] = None  # type: ignore[assignment]
