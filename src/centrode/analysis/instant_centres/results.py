"""Results: instant centres at some instants; the centrodes of a link, with the curvature of its paths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import xarray as xr

from centrode.analysis.instant_centres.bodies import body_names
from centrode.analysis.instant_centres.centres import instant_centres
from centrode.analysis.instant_centres.centrodes import centrodes
from centrode.analysis.instant_centres.curvature import curvature
from centrode.analysis.instant_centres.kennedy import MOST_BODIES, CentreConstruction, construct_centres
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.motion import default_instants, motion
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism
from centrode.quantities import status_word

Names: TypeAlias = tuple[str, str]

MOST_CENTRES = 300
"""Centres of one instant that are computed without being asked for by name."""
MOVING = (Status.OK, Status.CUT_OFF)
"""Statuses of samples that have velocities."""


@dataclass(frozen=True)
class CentreResults:
    """Instant centres of velocity at some instants, from the velocities and constructed.

    Attributes
    ----------
    mechanism : the mechanism
    pairs : the pairs of bodies that were asked for; None for all
    motion : the labelled motion at the instants
    centres : `instant_centres` of the pairs
    constructions : of each instant; None where there are no velocities, or more bodies than a construction takes
    """

    mechanism: Mechanism
    pairs: tuple[Names, ...] | None
    motion: xr.Dataset
    centres: xr.Dataset
    constructions: tuple[CentreConstruction | None, ...]


@dataclass(frozen=True)
class CentrodeResults:
    """The centrodes of a link over a motion, and how the paths of its points bend at some instants.

    Attributes
    ----------
    mechanism : the mechanism
    link, against : the bodies
    motion, centrodes : the labelled motion, and the `centrodes` over it
    instants, curvature : the labelled motion at the instants, and the `curvature` there; None without instants
    """

    mechanism: Mechanism
    link: str
    against: str
    motion: xr.Dataset
    centrodes: xr.Dataset
    instants: xr.Dataset | None
    curvature: xr.Dataset | None


def centre_results(
    mechanism: Mechanism,
    *,
    pairs: Sequence[Names] | None = None,
    instants: Sequence[float | str] | None = None,
) -> CentreResults:
    """Instant centres of a mechanism at some instants, from velocities and by Aronhold's and Kennedy's theorem.

    Parameters
    ----------
    pairs : bodies by name; all pairs if left out, of more than 300 those against the frame
    instants : values of the drive [rad or m] or times [s], as `at` of `motion`; those of the study if left out, else
        the initial position

    Raises
    ------
    InputError, NotComputedYet
        As `motion` and `instant_centres`.
    """
    names = body_names(mechanism)
    if instants is None:
        instants = default_instants(mechanism)
    wanted = None if pairs is None else tuple(pairs)
    if wanted is None and count_of_pairs(mechanism) > MOST_CENTRES:
        wanted = tuple((name, FRAME) for name in names[1:])
    course = motion(mechanism, at=instants)
    pairs = None if pairs is None else tuple(pairs)
    return CentreResults(
        mechanism, pairs, course, instant_centres(course, wanted), _constructions(mechanism, course)
    )


def results_of_centres(mechanism: Mechanism, centres: xr.Dataset) -> CentreResults:
    """A dataset of `instant_centres` with the motion at its samples, and the construction of all centres there."""
    course = motion(mechanism, at=mechanism.motion_parameter.instants(centres))
    labels = [tuple(str(label).split(",")) for label in centres["pair"].values]
    pairs = tuple((first, second) for first, second in labels)
    return CentreResults(mechanism, pairs, course, centres, _constructions(mechanism, course))


def _constructions(mechanism: Mechanism, course: xr.Dataset) -> tuple[CentreConstruction | None, ...]:
    """Centres by Aronhold's and Kennedy's theorem at every sample that has velocities."""
    few = len(body_names(mechanism)) <= MOST_BODIES
    return tuple(
        construct_centres(course, sample) if few and has_velocities(course, sample) else None
        for sample in range(course.sizes["sample"])
    )


def centrode_results(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    *,
    link: str,
    against: str = FRAME,
    instants: Sequence[float] = (),
) -> CentrodeResults:
    """The centrodes of a link against another body, and the curvature of the paths of its points.

    Parameters
    ----------
    samples, start, stop : as of `motion`
    link, against : bodies by name
    instants : values of the drive [rad or m] or times [s] at which the paths are looked at

    Raises
    ------
    InputError, NotComputedYet
        As `motion`, `centrodes` and `curvature`.
    """
    course = motion(mechanism, samples, start, stop)
    curves = centrodes(course, link, against)
    if not len(instants):
        return CentrodeResults(mechanism, link, against, course, curves, None, None)
    bends = curvature(mechanism, link, instants, against)
    return CentrodeResults(mechanism, link, against, course, curves, motion(mechanism, at=instants), bends)


def results_of_centrodes(mechanism: Mechanism, curves: xr.Dataset) -> CentrodeResults:
    """A dataset of `centrodes` with the motion at its samples; one of `curvature` with the centrodes of its link."""
    link, against = str(curves.attrs["link"]), str(curves.attrs["against"])
    there = motion(mechanism, at=mechanism.motion_parameter.instants(curves))
    if "inflection_pole" in curves:
        course = motion(mechanism)
        return CentrodeResults(
            mechanism, link, against, course, centrodes(course, link, against), there, curves
        )
    return CentrodeResults(mechanism, link, against, there, curves, None, None)


def count_of_pairs(mechanism: Mechanism) -> int:
    """How many pairs of bodies a mechanism has, each with one instant centre."""
    count = len(body_names(mechanism))
    return count * (count - 1) // 2


def need_pairs(mechanism: Mechanism, *, pairs: Sequence[Names] | None = None, **_options: object) -> None:
    """Raise InputError for a mechanism of so many bodies that only named pairs can be shown."""
    count = count_of_pairs(mechanism)
    if pairs is None and count > MOST_CENTRES:
        names = body_names(mechanism)
        raise InputError(
            "--pair",
            _("{bodies} bodies have {count} centres").format(bodies=len(names), count=count),
            _('name those that matter, as in --pair "{first},frame"').format(first=names[1]),
        )


def is_planar(mechanism: Mechanism) -> bool:
    """Whether bodies have instant centres in a plane."""
    return mechanism.space == "plane"


def is_on_sphere(mechanism: Mechanism) -> bool:
    """Whether bodies turn about instantaneous axes through the centre of a sphere."""
    return mechanism.space == "sphere"


def has_velocities(course: xr.Dataset, sample: int) -> bool:
    """Whether a mechanism has a position with velocities at a sample."""
    return Status(int(course["status"][sample])) in MOVING


def centre_shortfall(results: CentreResults) -> None:
    """Raise MotionError where an instant has no velocities, and so no centres."""
    require_velocities(results.motion)


def centrode_shortfall(results: CentrodeResults) -> None:
    """Raise MotionError where an instant has no velocities, or the link no instant centre over the whole motion."""
    if results.instants is not None:
        require_velocities(results.instants)
    require_centres(results.centrodes)


def require_velocities(course: xr.Dataset) -> None:
    """Raise MotionError if any sample of a motion has no velocities."""
    absent = [int(code) for code in course["status"].values if Status(int(code)) not in MOVING]
    if absent:
        raise MotionError(
            "",
            _("at {n} of {all} places there are no velocities ({status})").format(
                n=len(absent), all=course.sizes["sample"], status=status_word(absent[0])
            ),
            _("choose positions between the limits"),
        )


def require_centres(curves: xr.Dataset) -> None:
    """Raise MotionError if a link has no instant centre against the other body at any sample of its `centrodes`."""
    if not (curves["centrode_piece"] >= 0).any():
        link, other = str(curves.attrs["link"]), str(curves.attrs["against"])
        what = _("{link} has no centre relative to {other} in this range: it translates, or does not move")
        if FRAME in (link, other):
            # the centre is that of the pair, whichever of the two is said to move
            link = other if link == FRAME else link
            what = _(
                "{link} has no centre relative to the frame in this range: it translates, or does not move"
            )
        raise MotionError(
            "",
            what.format(link=link, other=other),
            _("name another link, or another body with --against"),
        )
