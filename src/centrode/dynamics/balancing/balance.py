"""Counterweights for a mechanism: what was asked for, what was found, and the mechanism before and after."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
import xarray as xr

from centrode.dynamics.balancing.asked import Lengths, Masses, asked_spots, number
from centrode.dynamics.balancing.counterweights import (
    Counterweight,
    Spot,
    counterweight,
    with_counterweights,
)
from centrode.dynamics.balancing.full import enough_spots, full_balance
from centrode.dynamics.balancing.inertial import Complex
from centrode.dynamics.balancing.instants import Speed, check_speed, on_sphere
from centrode.dynamics.balancing.lightest import Aim, lightest
from centrode.dynamics.balancing.loops import Loop, Share, fraction_of_slider_crank, loop_of, shares_of
from centrode.dynamics.balancing.moments import Disc, discs_for, with_discs
from centrode.dynamics.balancing.reachable import hinged_from
from centrode.dynamics.balancing.shaking import ORDERS, About, greatest_of, place_of, shaking
from centrode.dynamics.balancing.turning import Turning
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.mechanism import Mechanism

To: TypeAlias = Literal["full", "least", "fraction"]
KINDS = get_args(To)
EFFECTS = {"force": "shaking_force", "moment": "shaking_moment", "driving": "inertia_on_drive"}


@dataclass(frozen=True)
class Balance:
    """Counterweights of a mechanism with one drive, and what they do.

    Attributes
    ----------
    mechanism, balanced : Mechanism
        As described; with the counterweights (and discs) in its links.
    to : "full", "least" or "fraction"
    counterweights : tuple of Counterweight
    discs : tuple of Disc
        Inertia that balances the shaking moment; none where it was not asked for.
    before, after : Dataset
        Of `shaking`, of both mechanisms; their attributes hold the greatest values over the cycle.
    left : float or None
        Of a full balance: what is left of the sum of mass times place, over all masses times the greatest length.
    unique : bool
        Of a full balance: no other counterweights on these links do the same.
    bound : float or None [N]
        Of the least greatest force at constant speed, with bases in the frame: no counterweights on these links go
        below it.
    loop, shares
        Of a slider-crank or four-bar: its parts, and the masses replaced at its joints.
    """

    mechanism: Mechanism
    balanced: Mechanism
    to: To
    counterweights: tuple[Counterweight, ...]
    discs: tuple[Disc, ...]
    before: xr.Dataset
    after: xr.Dataset
    left: float | None
    unique: bool
    bound: float | None
    loop: Loop | None
    shares: tuple[Share, ...]


def balance(
    mechanism: Mechanism,
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
    speed: Speed = "drive",
    samples: int | None = None,
    orders: int = ORDERS,
) -> Balance:
    """Counterweights that balance a planar mechanism whose drive turns all the way round.

    Parameters
    ----------
    on : links, or "LINK@POINT" with the point that the radius is measured from
        Left out: for "full" as few links as are enough, those hinged to the frame first; else those hinged to the frame.
    to : "full", "least" or "fraction"
        Shaking force zero; the least greatest effects; for a slider-crank, what turns with the crank's pin and a
        `fraction` of what moves to and fro.
    radius : length, or link -> length
        From the point to the counterweight's centre; half the way to the link's farthest point if left out.
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
    A full balance leaves rounding. The least greatest force is found to 1e-8 of itself, with `bound` as its proof;
    with moments, or counterweights on links that are not hinged to the frame, it is the best of several searches.
    In steady motion counterweights are sought at the speed without them; `after` has its own real speed.
    """
    if mechanism.space == "sphere":
        raise on_sphere()
    _check(to, speed, moment)
    centre = place_of(mechanism, about)
    turning = Turning.of(mechanism, complex(*centre), speed)
    spots = asked_spots(mechanism, on, to, radius, most, thickness, density)
    loop = loop_of(mechanism, turning.masses)
    left, unique, bound = None, True, None
    if to == "full":
        spots = enough_spots(turning, spots) if on is None else spots
        found = full_balance(turning, spots)
        if not found.complete:
            raise _cannot(turning, mechanism, spots, found.left)
        products, left, unique = found.products, found.left, found.unique
    elif to == "least":
        products, bound = _least(turning, spots, weights)
    else:
        spots, products = _by_fraction(mechanism, turning, spots, loop, fraction)
    weighed = tuple(counterweight(mechanism, spot, s) for spot, s in zip(spots, products, strict=True))
    _check_masses(spots, weighed)
    balanced = with_counterweights(mechanism, turning.masses, weighed)
    discs: tuple[Disc, ...] = ()
    if moment:
        discs = discs_for(Turning.of(balanced, complex(*centre), speed), balanced)
        balanced = with_discs(balanced, discs)
    before, after = (
        shaking(one, samples, about=centre, speed=speed, orders=orders) for one in (mechanism, balanced)
    )
    shares = () if loop is None else shares_of(mechanism, turning.masses, loop)
    return Balance(mechanism, balanced, to, weighed, discs, before, after, left, unique, bound, loop, shares)


def _check(to: str, speed: str, moment: bool) -> None:
    if to not in KINDS:
        what = _("{name} is no way to balance").format(name=f'"{to}"')
        raise InputError("to", what, _("use one of {known}").format(known=", ".join(KINDS)))
    check_speed(speed)
    if moment and to != "full":
        what = _("discs balance the shaking moment only where the force is balanced fully")
        raise InputError("moment", what, _('use to = "full"'))


def _least(turning: Turning, spots: Sequence[Spot], weights: Sequence[float]) -> tuple[Complex, float | None]:
    """Products with the least greatest effects, and the force [N] that none go below."""
    numbers = [number(weight, "weights", "ratio") for weight in weights]
    if len(numbers) != 3 or min(numbers) < 0.0 or not max(numbers) > 0.0:
        what = _("expected three numbers, none negative and not all zero: of force, moment and drive")
        raise InputError("weights", what, "(1, 0, 0)")
    aim = Aim(*numbers)
    greatest = greatest_of(turning)
    sizes = [greatest[f"greatest_{EFFECTS[name]}"] for name, _weight in aim.parts]
    if min(sizes) == 0.0:
        raise InputError("weights", _("what they count is zero without counterweights"))
    found = lightest(turning, spots, aim, sizes)
    # in steady motion the counterweights change the speed itself
    proved = found.bound is not None and turning.instants.panels is None
    return found.products, (found.bound or 0.0) * sizes[0] / aim.force if proved else None


def _by_fraction(
    mechanism: Mechanism, turning: Turning, spots: Sequence[Spot], loop: Loop | None, fraction: float
) -> tuple[list[Spot], Complex]:
    """The one counterweight on the crank of a slider-crank."""
    share = number(fraction, "fraction", "ratio")
    if not 0.0 <= share <= 1.0:
        what = _("expected a number from 0 to 1, got {value}").format(value=f"{share:g}")
        raise InputError("fraction", what, _("half or two thirds are usual"))
    if loop is None or loop.rocker is not None:
        what = _("a fraction of what moves to and fro is balanced in slider-cranks only")
        raise InputError("fraction", what, _("ask for the full balance, or for the least greatest force"))
    chosen = [spot for spot in spots if spot.link == loop.crank]
    if len(chosen) != 1 or len(spots) != 1 or chosen[0].base != loop.O:
        what = _("this counterweight stands on the crank {crank}").format(crank=loop.crank)
        raise InputError("on", what, _("leave the links out"))
    return chosen, np.array([fraction_of_slider_crank(mechanism, turning.masses, loop, share)])


def _check_masses(spots: Sequence[Spot], weighed: Sequence[Counterweight]) -> None:
    for spot, one in zip(spots, weighed, strict=True):
        most = spot.making.most
        if most is not None and one.mass > most * (1.0 + 1e-9):
            what = _("the counterweight on {link} would have {mass:.6g} kg, more than {most:.6g} kg")
            raise MotionError(
                "most",
                what.format(link=one.link, mass=one.mass, most=most),
                _("allow more, give it a greater radius, or ask for the least greatest force"),
            )


def _cannot(turning: Turning, mechanism: Mechanism, spots: Sequence[Spot], left: float) -> MotionError:
    """Why the force cannot be balanced fully."""
    hinged = hinged_from(mechanism)
    heavy = [one.link for one in turning.masses if one.weighs and one.link not in hinged]
    links = ", ".join(spot.link for spot in spots) or _("none")
    if heavy:
        what = _("its force cannot be balanced fully: hinges alone do not lead from the frame to {links}")
        return MotionError(
            "", what.format(links=", ".join(heavy)), _("ask for the least greatest force instead")
        )
    what = _(
        "counterweights on {links} do not balance its force: the common centre of mass would still move"
        " ({left:.2g} of the greatest length)"
    )
    return MotionError(
        "", what.format(links=links, left=left), _("name more links, or leave the choice to centrode")
    )
