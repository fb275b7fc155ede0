"""Masses and loads of a mechanism together: what everything about forces starts from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.loads import Acting, loads_of
from centrode.dynamics.masses import Given, Mass, masses_of
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.loads import Load
from centrode.model.mechanism import Mechanism

Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Burden:
    """Masses and loads of a mechanism."""

    masses: tuple[Mass, ...]
    loads: tuple[Acting, ...]

    @classmethod
    def of(cls, mechanism: Mechanism, given: Given | None = None, m: Namespace = ARRAYS) -> Burden:
        """What the description gives; `given` are numbers by their paths in place of its own, `m` has their functions.

        Raises
        ------
        InputError
            Neither masses nor loads, or some that are not complete.
        NotComputedYet
            Friction by a coefficient.
        """
        return cls._of(mechanism, given, m, mechanism.loads)

    @classmethod
    def for_reactions(cls, mechanism: Mechanism) -> Burden:
        """The same without friction by coefficients, as forces on points and links; InputError for what is no force."""
        loads = [load for load in mechanism.loads if load.coefficient is None]
        return cls._of(mechanism, None, ARRAYS, loads)._as_forces()

    @classmethod
    def _of(
        cls, mechanism: Mechanism, given: Given | None, m: Namespace, described: Sequence[Load]
    ) -> Burden:
        masses = masses_of(mechanism, given, m)
        loads = loads_of(mechanism, masses, given, m, described)
        if not masses and not loads:
            what = _("there are neither masses nor loads")
            raise InputError("", what, _("give links a mass, or [[loads]]"))
        return cls(masses, loads)

    @classmethod
    def in_plane(cls, mechanism: Mechanism) -> Burden:
        """The same as forces on links of the plane; NotComputedYet on the sphere, InputError for what is no force."""
        if mechanism.space == "sphere":
            what = _("force polygons on the sphere are not computed yet")
            raise NotComputedYet("space", what, _("describe a plane one"))
        return cls.of(mechanism)._as_forces()

    def _as_forces(self) -> Burden:
        for load in self.loads:
            if any(effort.works is not None for effort in load.efforts):
                what = _("a plain sum is no moment in a hinge, so it makes no reactions")
                raise InputError(load.where, what, _("take form out"))
        return self

    @property
    def links(self) -> tuple[str, ...]:
        """Links that have mass or inertia."""
        return tuple(mass.link for mass in self.masses)

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the loads, weights at the end."""
        return tuple(load.label for load in self.loads)

    @property
    def needs_law(self) -> bool:
        """Whether a load depends on time or on speeds, so that it matters how the drive moves."""
        return any(effort.needs_law for load in self.loads for effort in load.efforts)
