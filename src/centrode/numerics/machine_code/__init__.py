"""Scans as machine code, through llvmlite (the extra `fast`). Without it everything runs on NumPy.

In the order of the work: `functions` (operations in LLVM's `language`, vector mathematics by `polynomials`), `loops`
(the whole function) or `integrations`, `targets` (the processor), `compile`, `cache`, `kernels` (what is called).
"""

from __future__ import annotations

from importlib.util import find_spec

PRESENT = find_spec("llvmlite") is not None
"""Whether llvmlite is installed; it is not imported to find out."""
