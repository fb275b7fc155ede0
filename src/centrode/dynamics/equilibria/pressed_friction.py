"""Friction at rest that goes with the reactions of its joints: how much of it balances a load along what can move.

At rest the multipliers of the closures, and with them the reactions of joints, are straight in the forces f of
friction: r = r_0 + G f. A force Q along the free direction is balanced where Q + sum a f = 0 with every
|f| <= c m(r_0 + G f). Of such forces those are looked for that use the same share of what each contact could hold,
against the motion that Q would begin: with f = -Q sign(a) g / sum |a| g, g = c m(r_0 + G f), the balance is kept by
every f, and sum |a| g is what friction can hold. As long as motion begins in one way only, everything slips at once
where it begins, so the position is held if that sum is at least |Q|. (F. Pfeiffer and C. Glocker, Multibody Dynamics
with Unilateral Contacts, 1996, chapter 6.)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.linear_equations import TIME, LinearEquations, LoadedMechanism
from centrode.dynamics.forward_dynamics.contacts import Contact
from centrode.dynamics.forward_dynamics.reaction_friction import pressing_force
from centrode.dynamics.kinetostatics.friction import FrictionLaw, FrictionRule
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]
LoadSharing: TypeAlias = Callable[[Array], tuple[Array, Array]]
"""Forces of friction (n, k) -> forces that share the load as these allow (n, k), and what they can hold (n)."""

MOST_STEPS, SETTLED = 60, 1e-13
"""Steps of Newton's method for forces of friction, and share of the load at which they have settled."""
DIFFERENCE = 1e-7
"""Step of differences, as a share of the load."""


@dataclass(frozen=True)
class PressedJoints:
    """What presses joints at n positions, for k contacts (dry frictions of a given size first) and c coordinates.

    Attributes
    ----------
    contacts : all of them
    sizes : (n, k) greatest friction of a given size [N or N m]; not a number of what is pressed
    along : (n, k, c) derivatives of what they act along
    base : (n, k, 2) reactions without friction [N or N m]
    gain : (n, k, 2, k) what a unit of each friction adds to them at rest
    moving : (n, k, 2, k) what it adds where accelerations are free; not a number without masses
    """

    contacts: tuple[Contact, ...]
    sizes: Array
    along: Array
    base: Array
    gain: Array
    moving: Array

    def greatest(self, forces: Array, shares: Array) -> Array:
        """The most that contacts hold (n, k) [N or N m] at forces of friction (n, k), of which these are shares (n)."""
        reactions = self.base + np.einsum("nkji,ni->nkj", self.gain, forces)
        found = self.sizes.copy()
        for k, contact in enumerate(self.contacts):
            if contact.pressing is None:
                continue
            pressing = contact.pressing
            reaction = [reactions[:, k, j] for j in range(len(pressing.openings))]
            # what slips would slip against its friction
            parts = pressing.parts(
                reaction, -np.sign(forces[:, k]), np.minimum(shares, 1.0) * pressing.static
            )
            found[:, k] = pressing.static * pressing_force(ARRAYS, contact, *parts)
        return found

    def holding(self, load: Array, tangents: Array) -> Array:
        """What friction can hold (n) of a load (n) along free directions (n, coordinates), in the unit of the load."""
        slopes = np.einsum("nkc,nc->nk", self.along, tangents)

        def share_load(forces: Array) -> tuple[Array, Array]:
            held = np.zeros(len(load))
            shares = np.ones(len(load))
            # the moment of friction on the faces of a slider knows its share; one correction of it is enough each time
            for _correction in range(2):
                greatest = self.greatest(forces, shares)
                held = np.sum(np.abs(slopes) * greatest, axis=1)
                shares = np.abs(load) / np.where(held > 0.0, held, np.inf)
            some = np.where(held > 0.0, held, 1.0)[:, None]
            return -load[:, None] * np.sign(slopes) * greatest / some, held

        forces, _held = share_load(np.zeros_like(slopes))
        forces, _held = share_load(forces)
        forces = self._settle_forces(share_load, forces, load)
        return share_load(forces)[1]

    def _settle_forces(self, share_load: LoadSharing, forces: Array, load: Array) -> Array:
        """Forces (n, k) that agree with the shares to which they lead, by Newton's method with differences."""
        count = forces.shape[1]
        left, step = np.arange(len(load)), DIFFERENCE
        scale = np.maximum(np.max(np.abs(forces), axis=1), 1e-300)
        for _step in range(MOST_STEPS):
            missed = forces - share_load(forces)[0]
            slopes = np.empty((len(load), count, count))
            for k in range(count):
                moved = forces.copy()
                moved[:, k] += step * scale
                slopes[:, :, k] = (moved - share_load(moved)[0] - missed) / (step * scale)[:, None]
            change = -np.einsum(
                "nij,nj->ni", np.linalg.pinv(np.nan_to_num(slopes), 1e-9), np.nan_to_num(missed)
            )
            longest = np.max(np.abs(change), axis=1)
            forces = forces + change * np.minimum(1.0, scale / np.maximum(longest, 1e-300))[:, None]
            left = np.flatnonzero(longest > SETTLED * scale)
            if not len(left):
                break
        return forces

    def feedback(self) -> Array:
        """By how much frictions could at most feed one another (n); from 1 on slip and rest may both be possible."""
        factors = [0.0 if one.pressing is None else float(one.pressing.static) for one in self.contacts]
        moving = np.nan_to_num(self.moving)
        for k, contact in enumerate(self.contacts):
            if contact.pressing is not None and len(contact.pressing.openings) == 2:
                first, second = contact.pressing.parts(
                    [moving[:, k, 0], moving[:, k, 1]], 0.0, contact.pressing.static
                )
                moving[:, k, 0], moving[:, k, 1] = first, second
        factor = np.broadcast_to(np.array(factors), self.sizes.shape)
        rules = np.full(len(factors), FrictionRule.LENGTH, dtype=np.int8)
        return FrictionLaw(factor, self.base, moving, rules).feedback


def pressed_joints(loaded: LoadedMechanism, places: Array, found: LinearEquations) -> PressedJoints:
    """What presses joints at positions (n, coordinates), at which `found` are the equations."""
    count, e, c, k = len(places), loaded.equations.equations, loaded.size, len(loaded.equations.contacts)
    values: dict[str, Any] = {TIME: 0.0} | dict(loaded.numbers)
    values |= {f"coordinate {i}": places[:, i] for i in range(c)}
    shapes = {
        "along": (k, c), "force": (k, 2), "mass": (k, 2, c), "rows": (k, 2, e), "own": (k, 2, k),
    }  # fmt: skip
    arrays: dict[str, Any] = {name: np.zeros((count, *shape)) for name, shape in shapes.items()}
    for name, x in evaluate(loaded.graph_of_openings, values).items():
        kind, *at = name.split()
        place: tuple[slice | int, ...] = (slice(None), *map(int, at))
        arrays[kind][place] = x
    along = arrays["along"]
    of_load = loaded.reactions(found)
    of_frictions = np.stack([loaded.reactions_to(found.rows, along[:, i]) for i in range(k)], axis=2)
    base = np.einsum("nkje,ne->nkj", arrays["rows"], of_load) - arrays["force"]
    gain = np.einsum("nkje,nei->nkji", arrays["rows"], of_frictions) - arrays["own"]
    sizes = np.full((count, k), np.nan)
    sizes[:, : len(loaded.frictions)] = np.abs(found.friction)
    moving = _moving_gain(loaded, found, arrays)
    return PressedJoints(loaded.equations.contacts, sizes, along, base, gain, moving)


def _moving_gain(loaded: LoadedMechanism, found: LinearEquations, arrays: dict[str, Array]) -> Array:
    """What a unit of each friction adds to reactions where it accelerates what it acts on (n, k, 2, k)."""
    joints, e = loaded.joints, loaded.equations.equations
    count, k = arrays["along"].shape[:2]
    units = np.append(loaded.units[:joints], np.ones(e))
    matrix = np.zeros((count, joints + e, joints + e))
    matrix[:, :joints, :joints] = found.mass[:, :joints, :joints]
    matrix[:, :joints, joints:] = found.rows[:, :, :joints].transpose(0, 2, 1)
    matrix[:, joints:, :joints] = found.rows[:, :, :joints]
    matrix = matrix * units[:, None] * units
    if not np.any(found.mass):
        return np.full((count, k, 2, k), np.nan)
    right = np.zeros((count, joints + e, k))
    right[:, :joints] = arrays["along"][:, :, :joints].transpose(0, 2, 1)
    solved = np.linalg.pinv(matrix, 1e-12) @ (right * units[:, None]) * units[:, None]
    whole = np.concatenate([arrays["mass"][:, :, :, :joints], arrays["rows"]], axis=3)
    return np.asarray(np.einsum("nkjx,nxi->nkji", whole, solved) - arrays["own"])


def held_by_friction(
    loaded: LoadedMechanism, places: Array, found: LinearEquations, tangents: Array
) -> Array:
    """What friction can hold (n) along free directions (n, coordinates) at positions [J per unit of these]."""
    if not loaded.equations.contacts:
        slopes = np.abs(np.einsum("nfc,nc->nf", found.along, tangents))
        return np.asarray(np.sum(slopes * np.abs(found.friction), axis=1))
    load = np.einsum("nc,nc->n", found.force, tangents)
    return pressed_joints(loaded, places, found).holding(load, tangents)
