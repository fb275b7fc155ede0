"""Counterweights for a mechanism: what was requested, what was found, and the mechanism before and after."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import xarray as xr

from centrode.dynamics.balancing.counterweights import (
    Counterweight,
    Lengths,
    Masses,
    asked_spots,
    counterweight,
    with_counterweights,
)
from centrode.dynamics.balancing.methods import (
    CounterweightDisc,
    Loop,
    Share,
    by_fraction,
    check_masses,
    discs_for,
    fully,
    least_effects,
    loop_of,
    shares_of,
    with_discs,
)
from centrode.dynamics.balancing.shaking_forces import (
    ORDERS,
    About,
    ShakingTurning,
    Speed,
    check_speed,
    on_sphere,
    place_of,
    shaking,
)
from centrode.errors import InputError
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary

To: TypeAlias = Literal["full", "least", "fraction"]
KINDS = get_args(To)


@dataclass(frozen=True, repr=False)
class Balance(PrintsSummary):
    """Counterweights of a mechanism with one drive, and what they do.

    Attributes
    ----------
    mechanism, balanced : Mechanism
        As described; with the counterweights (and discs) in its links.
    to : "full", "least" or "fraction"
    counterweights : tuple of Counterweight
    discs : tuple of CounterweightDisc
        Inertia that balances the shaking moment; none where it was not requested.
    before, after : Dataset
        Of `shaking`, of both mechanisms; their attributes hold the greatest values over the cycle.
    fraction : float or None
        Of what moves to and fro, where that was requested.
    weights : three numbers or None
        Of force, moment and drive in the least greatest effects.
    left : float or None
        Of a full balance: what is left of the sum of mass times place, over all masses times the greatest length.
    unique : bool
        Of a full balance: no other counterweights on these links do the same.
    bound : float or None [N]
        Of the least greatest force: no counterweights on these links, with these radii, go below it.
    proved : bool
        Of least greatest effects: no counterweights on these links, with these radii, do better.
    motion : Dataset
        Of the mechanism over the range of its description; pictures show a sample of it.
    loop, shares
        Of a slider-crank or four-bar: its parts, and the masses replaced at its joints.
    """

    mechanism: Mechanism
    balanced: Mechanism
    to: To
    counterweights: tuple[Counterweight, ...]
    discs: tuple[CounterweightDisc, ...]
    before: xr.Dataset
    after: xr.Dataset
    fraction: float | None
    weights: tuple[float, ...] | None
    left: float | None
    unique: bool
    bound: float | None
    proved: bool
    loop: Loop | None
    shares: tuple[Share, ...]
    motion: xr.Dataset


def balance(
    mechanism: MechanismSource,
    on: Sequence[str] | None = None,
    *,
    to: To = "full",
    radius: Lengths = None,
    most: Masses = None,
    thickness: float | str | None = None,
    density: float | str = 7800.0,
    weights: Sequence[float] = (1.0, 0.0, 0.0),
    fraction: float = 0.5,
    moment: bool = False,
    about: About = (0.0, 0.0),
    speed: Speed = "mean",
    samples: int | None = None,
    orders: int = ORDERS,
) -> Balance:
    """Counterweights that balance a planar mechanism whose drive turns all the way round.

    Parameters
    ----------
    on : links, or "LINK@POINT" with the point that the radius is measured from
        Left out: those hinged to the frame; for "full" as few as are enough, and others where these are not.
    to : "full", "least" or "fraction"
        Shaking force zero; the least greatest effects; for a slider-crank, what turns with the crank's pin and a
        `fraction` of the reciprocating masses.
    radius : length, or link -> length
        From the point to the counterweight's centre; half the way to the link's farthest point by default.
    most : mass, or link -> mass
        Greatest mass of a counterweight.
    thickness, density : length, density
        Of discs; a mass in one point without a thickness. A disc without `radius` touches its point with its edge.
    weights : three numbers
        For "least": of the greatest shaking force, shaking moment and moment of the drive, each over that of before.
    moment : bool
        Also balance the shaking moment by discs that turn against links (with "full").
    about, speed, samples, orders
        As for `shaking`.

    Returns
    -------
    Balance
        Counterweights, the description with them, and `shaking` before and after.

    Raises
    ------
    InputError
        No masses, several drives, a drive without a constant speed or a turn, unknown links, values that do not fit.
    MotionError
        The mechanism does not turn fully; it cannot be balanced fully by counterweights on these links, or not by so
        little mass; its shaking moment cannot be balanced.
    NotComputedYet
        The sphere.

    Notes
    -----
    A full balance leaves rounding. The least greatest effects are found to 1e-8, mostly with a proof (`proved`); with
    discs, and where more inertia than counterweights have would be better, they are the best of several searches. In
    steady motion counterweights are sought at the speed without them; `after` has its own real speed.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.balance(ct.example("six-bar-press"))
    >>> print(ct.summary(found).splitlines()[0])
    balance             shaking force zero
    """
    mechanism = mechanism_of(mechanism)
    if mechanism.space == "sphere":
        raise on_sphere()
    _check(to, speed, moment)
    centre = place_of(mechanism, about)
    spots = asked_spots(mechanism, on, to, radius, most, thickness, density)
    turning = ShakingTurning.of(
        mechanism, complex(*centre), speed, [(spot.link, spot.base) for spot in spots]
    )
    loop = loop_of(mechanism, turning.masses)
    if to == "full":
        chosen = fully(mechanism, turning, spots, named=on is not None)
    elif to == "least":
        chosen = least_effects(turning, spots, weights)
    else:
        chosen = by_fraction(mechanism, turning, spots, loop, fraction)
    weighed = tuple(
        counterweight(mechanism, spot, s) for spot, s in zip(chosen.spots, chosen.products, strict=True)
    )
    # after the choice: a full balance says what is needed, and may need more mass than is allowed
    check_masses(chosen.spots, weighed)
    balanced = with_counterweights(mechanism, turning.masses, weighed)
    discs: tuple[CounterweightDisc, ...] = ()
    if moment:
        # discs balance what the counterweights' own inertia adds as well
        discs = discs_for(ShakingTurning.of(balanced, complex(*centre), speed), balanced)
        balanced = with_discs(balanced, discs)
    # over one whole cycle, so that greatest values before and after are of the same motion
    ends = (turning.first, turning.first + turning.period) if speed == "mean" else (None, None)
    before, after = (
        shaking(each, samples, *ends, about=centre, speed=speed, orders=orders)
        for each in (mechanism, balanced)
    )
    return Balance(
        mechanism,
        balanced,
        to,
        weighed,
        discs,
        before,
        after,
        chosen.fraction,
        chosen.weights,
        chosen.left,
        chosen.unique,
        chosen.bound,
        chosen.proved,
        loop,
        () if loop is None else shares_of(mechanism, turning.masses, loop),
        motion(mechanism),
    )


def _check(to: str, speed: str, moment: bool) -> None:
    if to not in KINDS:
        what = _("{name} is not a balancing method").format(name=f'"{to}"')
        raise InputError("to", what, _("use one of {known}").format(known=", ".join(KINDS)))
    check_speed(speed)
    if moment and to != "full":
        what = _("discs balance the shaking moment only if the shaking force is balanced fully")
        raise InputError("moment", what, _('use to = "full"'))
