"""What a sweep may take of memory and ask for at most; named here, told in docs/sweeps.md."""

from __future__ import annotations

WORKING_SET = 256_000_000
"""Bytes that the mechanisms solved together may take, results aside (one mechanism alone may take more)."""

BLOCK_POSITIONS = 2_000_000
"""Positions of one block, the unit that is stored and marked as done: a few seconds of work."""

BLOCKS_OF_KERNELS = 32
"""How many times as many positions stand in a block that machine code computes."""

WORTH_COMPILING = 100_000
"""Positions (nodes of the mesh, if they are more) from which on "auto" takes machine code."""

THREADS = 256
"""Threads of one sweep."""

KERNEL_LANES = 1 << 16
"""Mechanisms that machine code computes at once."""

KERNEL_BUFFER = 2_000_000
"""Bytes of the buffer that machine code writes samples to: it should stay in the cache."""

BLOCK_BYTES = 32_000_000
"""Bytes of one block's results."""

IN_MEMORY = 2_000_000_000
"""Bytes of a result that is kept in memory; a greater one needs a store."""

IN_STORE = 1_000_000_000_000
"""Bytes of a result in a store."""

MECHANISMS = 10_000_000_000
"""Mechanisms of one sweep."""

DRAWN = 20_000_000
"""Numbers of a sample (mechanisms times paths): they are drawn at once."""

LISTED = 20_000_000
"""Values given one by one."""

PATHS = 100
"""Paths that vary together."""

OUTPUTS = 200
"""Outputs, or formulas, of one sweep."""
