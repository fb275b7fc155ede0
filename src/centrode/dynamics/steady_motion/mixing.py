"""Fixed points of functions of many numbers: iteration that learns from its former steps.

Source: D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547-560.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from centrode.dynamics.steady_motion.quadrature import Array

KEPT = 16
"""Former steps that the next one is made from."""


@dataclass
class Mixing:
    """Proposes arguments x for which f(x) = x, from those tried before."""

    arguments: list[Array] = field(default_factory=list)
    changes: list[Array] = field(default_factory=list)

    def following(self, argument: Array, value: Array) -> Array:
        """What to try after an argument (n) with its value (n): the combination whose change would be least."""
        self.arguments = [*self.arguments[-KEPT:], argument]
        self.changes = [*self.changes[-KEPT:], value - argument]
        if len(self.changes) == 1:
            return value
        steps = np.diff(np.stack(self.arguments), axis=0).T
        bends = np.diff(np.stack(self.changes), axis=0).T
        shares = np.linalg.lstsq(bends, self.changes[-1], rcond=1e-12)[0]
        return np.asarray(value - (steps + bends) @ shares)
