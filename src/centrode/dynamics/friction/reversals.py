"""Where friction jumps: values of the drive at which a contact turns round."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.amounts import Constant, Friction
from centrode.dynamics.efforts import Acting, Effort
from centrode.dynamics.friction.contacts import Contact
from centrode.dynamics.reducer import Burden, Reducer
from centrode.kinematics.ready import Ready

Array: TypeAlias = npt.NDArray[np.float64]
UNIT = Friction(Constant(1.0))


def reversals(prepared: Ready, contacts: Sequence[Contact], first: float, last: float) -> Array:
    """Values of the only drive, in increasing order, between two values."""
    rubbing = Acting("friction", tuple(Effort(contact.motion, UNIT) for contact in contacts))
    return Reducer(prepared, Burden((), (rubbing,))).jumps(first, last)
