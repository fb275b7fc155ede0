"""A mechanism that is left to its loads, with any number of degrees of freedom: prepared, started and integrated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import conditions_of, contacts_of
from centrode.dynamics.forward_dynamics.controllers import controls_of
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, KeptDrive
from centrode.dynamics.forward_dynamics.free_loads import (
    DriveEffort,
    coordinate_of_drive,
    dry_frictions_of,
    free_loads_of,
    shafts_of,
)
from centrode.dynamics.forward_dynamics.initial_position import InitialPosition, position_of_description
from centrode.dynamics.forward_dynamics.initial_state import (
    InitialState,
    drive_speeds,
    drive_values,
    initial_state,
)
from centrode.dynamics.forward_dynamics.integration import MotionIntegration
from centrode.dynamics.forward_dynamics.motion_steps import DURATION
from centrode.dynamics.forward_dynamics.pressed_contacts import (
    pressed_contacts_of,
    refuse_undetermined_presses,
)
from centrode.dynamics.forward_dynamics.solvability import solvable_equations
from centrode.dynamics.forward_dynamics.spanning_tree import JointCoordinate, SpanningTree, spanning_tree_of
from centrode.dynamics.forward_dynamics.trajectory import Trajectory, trajectory_of, trajectory_points
from centrode.dynamics.kinetostatics.friction import without_friction
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.masses import massless_links
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.path import DrivenBy, path_of
from centrode.laws import Law
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.executors import choose_executor
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.initial_value_problems import TIME
from centrode.numerics.jets import Jet, JetFunctions
from centrode.structure.constraints import AngleDrive, DisplacementDrive, DistanceDrive, constraints_of

Array: TypeAlias = npt.NDArray[np.float64]

ADAPTIVE, STIFF = "adaptive", "stiff"


@dataclass(frozen=True)
class FreeMotion:
    """A mechanism prepared for forward dynamics.

    Attributes
    ----------
    mechanism : the description
    equations : equations of motion with its numbers
    position : coordinates of the initial position
    mobility : degrees of freedom, kept drives taken off
    redundant : number of closure equations that others imply
    """

    mechanism: Mechanism
    equations: EquationsOfMotion
    position: InitialPosition
    mobility: int
    redundant: int

    @property
    def tree(self) -> SpanningTree:
        """Joint coordinates, and what they place."""
        return self.equations.tree

    @property
    def coordinates(self) -> tuple[JointCoordinate, ...]:
        """Joint coordinates in order."""
        return self.tree.coordinates

    @property
    def points(self) -> tuple[str, ...]:
        """Moving points, then those of the frame."""
        return trajectory_points(self.mechanism)

    @property
    def links(self) -> tuple[str, ...]:
        """Links in description order."""
        return tuple(self.mechanism.links)

    @property
    def guides(self) -> tuple[str, ...]:
        """Guides in description order."""
        return tuple(guide.id for guide in self.mechanism.guides)

    @property
    def drives(self) -> tuple[str, ...]:
        """Drives in description order, kept and free."""
        return tuple(drive.id for drive in self.mechanism.drives)

    @property
    def closures(self) -> tuple[str, ...]:
        """Labels of the closure equations, one for each."""
        return tuple(c.label for c in self.equations.constraints for _equation in range(c.size))

    @property
    def massless(self) -> tuple[str, ...]:
        """Links without mass."""
        return massless_links(self.mechanism)

    @cached_property
    def integration(self) -> MotionIntegration:
        """The equations as an initial value problem."""
        return MotionIntegration(self.equations)

    def drive_values(self, coordinates: Array) -> dict[str, float]:
        """Values of all drives [rad or m; on the sphere of guides rad] at joint coordinates."""
        return drive_values(self.equations, coordinates)

    def drive_speeds(self, start: InitialState) -> dict[str, float]:
        """Speeds of all drives [rad/s or m/s; on the sphere of guides rad/s] in a state."""
        return drive_speeds(self.equations, start)

    def with_numbers(self, equations: EquationsOfMotion) -> FreeMotion:
        """The same structure with other numbers: what is traced and compiled stays what it is."""
        other = replace(self, equations=equations)
        other.__dict__["integration"] = self.integration.with_numbers(equations)
        return other

    def initial(
        self, speeds: Mapping[str, Any] | None = None, values: Mapping[str, float] | None = None
    ) -> InitialState:
        """The state at time zero: position closed, speeds consistent.

        Parameters
        ----------
        speeds : path -> speed
            "links.OA" [rad/s], "guides.B" [m/s], "drives.K" and "points.P" = (x, y) [m/s]; what they leave open is
            chosen by the least kinetic energy.
        values : "drives.K" -> value of a drive [rad or m] in place of that of the description

        Raises
        ------
        InputError
            A path names nothing, speeds contradict one another, or the position does not close.
        """
        return initial_state(self.equations, self.position.coordinates, speeds or {}, values or {})

    def integrate(
        self,
        start: InitialState,
        duration: float,
        tolerance: float = 1e-9,
        at: npt.ArrayLike | None = None,
        samples: int = 401,
        scheme: str = ADAPTIVE,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
        at_events: bool = False,
    ) -> Trajectory:
        """The motion from a state.

        Parameters
        ----------
        duration [s], tolerance : of the error of a step, relative to what moves
        at : (n) [s], instants within the duration; evenly spaced ones where they are left out
        samples : number of instants where `at` is left out
        scheme : "adaptive", explicit; "stiff", implicit
        executor : "auto", "machine code" or "arrays"
        progress : called with the time reached [s]
        at_events : also at the instants of events, as it goes on behind them

        Raises
        ------
        InputError
            A duration that is not positive, instants outside, or an unknown scheme.
        """
        if not (isfinite(duration) and duration > 0.0):
            raise InputError(
                "[simulation] duration", _("it has to be positive"), _("give a time, such as 10 s")
            )
        times = np.linspace(0.0, duration, samples) if at is None else np.asarray(at, dtype=np.float64)
        if np.any((times < 0.0) | (times > duration * (1.0 + 1e-12))) or np.any(np.diff(times) < 0.0):
            raise InputError("at", _("instants lie within the duration and grow"), _("correct them"))
        if scheme not in (ADAPTIVE, STIFF):
            what = _("there is no scheme {name} for all coordinates").format(name=scheme)
            raise InputError("[simulation] scheme", what, _("adaptive or stiff"))
        integration = self.integration
        if scheme == STIFF and self.equations.has_events:
            what = _("events are found by the adaptive scheme alone")
            raise InputError("[simulation] scheme", what, _('write scheme = "adaptive"'))
        take = integration.explicit_steps if scheme == ADAPTIVE else integration.implicit_steps
        steps = take(start, duration, tolerance, executor, progress)
        reached = float(steps.rows[0, -1])
        if at_events:
            times = np.union1d(times, [event.time for event in steps.events])
        times = times[times <= reached] if steps.ended != DURATION else np.minimum(times, reached)
        states = integration.states_at(steps, times, executor)
        return trajectory_of(
            self.equations,
            steps,
            times,
            states,
            scheme,
            choose_executor(executor),
            integration.problem.carried_names,
        )


def free_motion_of(
    mechanism: Mechanism, keeps: Sequence[str] = (), efforts: Sequence[DriveEffort] = ()
) -> FreeMotion:
    """A mechanism prepared to be left to its loads.

    Parameters
    ----------
    keeps : drives that keep their laws; all others are free
    efforts : forces and moments of drives besides the loads

    Raises
    ------
    InputError
        It does not close, nothing has a mass, or a motion is possible that moves none.
    NotComputedYet
        What jumps with the sense of a motion, dry friction aside; kept drives whose law is a table.
    """
    tree = spanning_tree_of(mechanism)
    position = position_of_description(mechanism, tree)
    pressed = pressed_contacts_of(mechanism)
    given = without_friction(mechanism)
    burden = MassesAndLoads.of(given)
    loads = free_loads_of(given, burden.loads, efforts)
    kept = kept_drives_of(mechanism, float(position.numbers.scale), keeps)
    equations = EquationsOfMotion(
        tree,
        position.numbers,
        burden.masses,
        loads,
        kept,
        shafts=shafts_of(mechanism),
        contacts=contacts_of(mechanism, (*dry_frictions_of(given, burden.loads), *pressed)),
        conditions=conditions_of(mechanism),
        controls=controls_of(mechanism, coordinate_of_drive),
    )
    equations, rank = solvable_equations(equations, position.coordinates)
    refuse_undetermined_presses(equations, position.coordinates)
    return FreeMotion(mechanism, equations, position, equations.size - rank, equations.equations - rank)


# Drives that keep their laws in a free motion.


def kept_drives_of(mechanism: Mechanism, scale: float, keeps: Sequence[str]) -> tuple[KeptDrive, ...]:
    """Drives that keep their laws, in the order of the constraints.

    Parameters
    ----------
    scale : greatest length of the mechanism [m]
    keeps : ids of drives

    Raises
    ------
    NotComputedYet
        The law of one has text formulas in its segments.
    """
    if not keeps:
        return ()
    driven: dict[str, DrivenBy] = {one.drive.id: one for one in path_of(mechanism, scale).driven}
    found = []
    for constraint in constraints_of(mechanism):
        if (
            isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive)
            and constraint.drive in keeps
        ):
            law = driven[constraint.drive].law
            if not _is_traceable(law):
                what = _("a drive that keeps a law with text formulas in its segments is not computed here")
                repair = _("give a speed, a table, one formula, or segments with other curves")
                raise NotComputedYet(f"[[drives]] {constraint.drive}", what, repair)
            found.append(KeptDrive(constraint, driven[constraint.drive]))
    return tuple(found)


def _is_traceable(law: Law) -> bool:
    """Whether a law can be traced: text formulas of segments are chosen by the value of the time."""
    try:
        law.jet(JetFunctions(EXPRESSIONS), Jet((variable(TIME), 1.0, 0.0)))
    except TypeError:
        return False
    return True
