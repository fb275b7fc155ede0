"""Lists of kinematic chains: seconds, over what is promised."""

from __future__ import annotations

import time
from collections.abc import Iterator

import centrode as ct
from benchmarks.table import Promise, Row
from centrode.chains.kinematic_chains import _enumerated_chains

BOUNDS = {10: 10.0, 12: 300.0}
"""Links -> seconds in which all chains of mobility 1 are to be listed."""


def chain_lists() -> Iterator[Row]:
    """Processor seconds for all chains of so many links, and a chain's share."""
    for links, bound in BOUNDS.items():
        _enumerated_chains.cache_clear()
        start = time.process_time()
        count = len(ct.chains(links))
        used = time.process_time() - start
        yield Row(
            f"{links} links, {count} chains",
            {"s": used, "us a chain": 1e6 * used / count},
            promises=[Promise(f"all chains of {links} links, s", used, at_most=bound)],
        )
