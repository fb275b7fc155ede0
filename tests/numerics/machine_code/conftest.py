"""What the tests of machine code share: a cache of their own, machines to compile for, units in the last place."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Kernels of a test are kept in a folder of its own, and not in memory before it."""
    kernels = pytest.importorskip(
        "centrode.numerics.machine_code.kernels", reason="machine code needs llvmlite"
    )
    folder = tmp_path / "kernels"
    monkeypatch.setenv("CENTRODE_CACHE", str(folder))
    kernels.forget()
    return folder
