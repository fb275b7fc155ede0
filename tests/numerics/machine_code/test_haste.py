"""Kernels generated in haste: other code, the same numbers."""

from __future__ import annotations

import numpy as np

from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.machine_code.kernels import kernel_of
from centrode.numerics.scans import Scan


def test_haste_changes_no_bit() -> None:
    m, x, y, z = EXPRESSIONS, variable("x"), variable("y"), variable("z")
    outputs = {
        "contracted if it could": x * y + z,
        "difference": (x - y) * (x + y) / z,
        "root": m.sqrt(x * x + y * y) - z,
        "chosen": m.where(m.less(x, y), x * z, y - x * z),
        "angle": m.atan2(y * x, x - z),
    }
    scan = Scan(("x", "y"), ("z",), outputs)
    places = np.random.default_rng(0).uniform(-3.0, 3.0, (2, 1001))
    steps = np.random.default_rng(1).uniform(0.1, 3.0, (1, 3))
    plain, hasty = (kernel_of(scan, lanes_inside=True, hasty=hasty) for hasty in (False, True))
    assert plain.function.code != hasty.function.code
    assert plain.run(places, steps).outputs.tobytes() == hasty.run(places, steps).outputs.tobytes()
