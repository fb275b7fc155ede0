"""Results: the graph-analytic checks of a mechanism at some instants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import xarray as xr

from centrode.analysis.graphic.checks import GraphicCheck, graphic_check
from centrode.errors import CentrodeError, InputError, Status
from centrode.kinematics.motion import default_instants, motion
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary

MOST_INSTANTS = 100


@dataclass(frozen=True, repr=False)
class GraphicResults(PrintsSummary):
    """Graph-analytic checks of a mechanism at some instants.

    Attributes
    ----------
    mechanism : the mechanism
    motion : the labelled motion at the instants
    checks : of each instant; None where the mechanism is not reached, or the failure where it cannot be drawn
    """

    mechanism: Mechanism
    motion: xr.Dataset
    checks: tuple[GraphicCheck | CentrodeError | None, ...]


def graphic_analysis(
    mechanism: MechanismSource,
    *,
    instants: Sequence[float | str] | float | str = (),
    angle_step: float | str | None = None,
    length_step: float | str | None = None,
    scales: Mapping[str, float | str] | None = None,
    incomplete: bool = False,
) -> GraphicResults:
    """Velocities and accelerations at some instants by the drawing, beside those of the motion.

    Parameters
    ----------
    instants : values of the drive [rad or m], times [s], or texts with a unit, as `at` of `motion`; those of
        the study by default, else the initial position
    angle_step, length_step, scales : as of `graphic_check`
    incomplete : an instant that cannot be drawn fails alone, and the others are drawn

    Raises
    ------
    InputError, MotionError
        As `motion` and, unless `incomplete`, `graphic_check`.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.graphic_analysis(ct.example("crank-rocker"), instants=[1.0])
    >>> print(ct.summary(found).splitlines()[1])
    scales           μ_l = 0.05 m per mm, μ_v = 0.01 m/s per mm, μ_a = 0.015 m/s² per mm
    """
    mechanism = mechanism_of(mechanism)
    instant = mechanism.motion_parameter.instant
    places = tuple(instant.read_all(instants, "instants")) or default_instants(mechanism)

    def check(at: float) -> GraphicCheck:
        return graphic_check(mechanism, at, angle_step, length_step, scales)

    if not incomplete:
        checks = tuple(check(at) for at in places)
        return GraphicResults(mechanism, motion(mechanism, at=places), checks)
    course = motion(mechanism, at=places)
    found: list[GraphicCheck | CentrodeError | None] = []
    for at, status in zip(places, course["status"].values.tolist(), strict=True):
        try:
            found.append(check(at) if status == Status.OK else None)
        except CentrodeError as failure:
            found.append(failure)
    return GraphicResults(mechanism, course, tuple(found))


def need_few_instants(_mechanism: Mechanism, *, instants: Sequence[float] = (), **_options: object) -> None:
    """Raise InputError for more instants than anyone reads."""
    if len(instants) > MOST_INSTANTS:
        raise InputError(
            "--at",
            _("{count} instants are given").format(count=len(instants)),
            _("give at most {most}").format(most=MOST_INSTANTS),
        )
