"""The products of mass and radius that were asked for: force zero, least greatest effects, a fraction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.asked import number
from centrode.dynamics.balancing.counterweights import Counterweight, Spot
from centrode.dynamics.balancing.full import enough_spots, full_balance
from centrode.dynamics.balancing.inertial import Complex
from centrode.dynamics.balancing.lightest import lightest
from centrode.dynamics.balancing.loops import Loop, fraction_of_slider_crank
from centrode.dynamics.balancing.reachable import hinged_from
from centrode.dynamics.balancing.shaking import greatest_of
from centrode.dynamics.balancing.turning import Turning
from centrode.dynamics.balancing.weighing import Aim
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.mechanism import Mechanism

ROUNDING = 1e-9
"""Effects below this share of what their parts amount to are nothing but rounding."""
EFFECTS = {"force": "shaking_force", "moment": "shaking_moment", "driving": "inertia_on_drive"}


@dataclass(frozen=True)
class Chosen:
    """Products of mass and radius [kg m] in the axes of their links; the other attributes are those of `Balance`."""

    spots: tuple[Spot, ...]
    products: Complex
    fraction: float | None = None
    weights: tuple[float, ...] | None = None
    left: float | None = None
    unique: bool = True
    bound: float | None = None
    proved: bool = False


def fully(mechanism: Mechanism, turning: Turning, spots: Sequence[Spot], *, named: bool) -> Chosen:
    """The force zero, by all spots where they were named, else by as few as are enough."""
    spots = spots if named else enough_spots(turning, spots)
    found = full_balance(turning, spots)
    if not found.complete:
        raise _cannot(turning, mechanism, spots, found.left)
    return Chosen(tuple(spots), found.products, left=found.left, unique=found.unique)


def least_effects(turning: Turning, spots: Sequence[Spot], weights: Sequence[float]) -> Chosen:
    """The least weighted sum of greatest effects."""
    aim = _aim(weights)
    greatest = greatest_of(turning)
    sizes = [greatest[f"greatest_{EFFECTS[name]}"] for name, _weight in aim.parts]
    whole = {"force": turning.sizes[0], "moment": turning.sizes[1], "driving": turning.sizes[1]}
    small = [size <= ROUNDING * whole[name] for (name, _weight), size in zip(aim.parts, sizes, strict=True)]
    if any(small):
        raise InputError("weights", _("what they count is zero without counterweights"))
    try:
        found = lightest(turning, spots, aim, sizes)
    except ArithmeticError:
        what = _("the search for counterweights fails: effects over the cycle differ too much in size")
        raise MotionError("", what, _("look for places near a limit, or ask for the full balance")) from None
    bound = None
    # in steady motion the counterweights change the speed itself, so nothing is proved
    proved = found.bound is not None and turning.instants.panels is None
    if found.bound is not None and proved and aim.force and len(aim.parts) == 1:
        bound = found.bound * sizes[0] / aim.force
    weighed = (aim.force, aim.moment, aim.driving)
    return Chosen(tuple(spots), found.products, weights=weighed, bound=bound, proved=proved)


def by_fraction(
    mechanism: Mechanism, turning: Turning, spots: Sequence[Spot], loop: Loop | None, fraction: float
) -> Chosen:
    """The one counterweight on the crank of a slider-crank."""
    share = number(fraction, "fraction", "ratio")
    if not 0.0 <= share <= 1.0:
        what = _("expected a number from 0 to 1, got {value}").format(value=f"{share:g}")
        raise InputError("fraction", what, _("half or two thirds are usual"))
    if loop is None or loop.rocker is not None:
        what = _("a fraction of what moves to and fro is balanced in slider-cranks only")
        raise InputError("fraction", what, _("ask for the full balance, or for the least greatest force"))
    if [(spot.link, spot.base) for spot in spots] != [(loop.crank, loop.O)]:
        what = _("this counterweight stands on the crank {crank}").format(crank=loop.crank)
        raise InputError("on", what, _("leave the links out"))
    product = fraction_of_slider_crank(mechanism, turning.masses, loop, share)
    return Chosen(tuple(spots), np.array([product]), fraction=share)


def check_masses(spots: Sequence[Spot], weighed: Sequence[Counterweight]) -> None:
    """Refuse counterweights with more mass than they may have."""
    for spot, one in zip(spots, weighed, strict=True):
        most = spot.making.most
        if most is not None and one.mass > most * (1.0 + 1e-9):
            what = _("the counterweight on {link} would have {mass:.6g} kg, more than {most:.6g} kg")
            raise MotionError(
                "most",
                what.format(link=one.link, mass=one.mass, most=most),
                _("allow more, give it a greater radius, or ask for the least greatest force"),
            )


def _aim(weights: Sequence[float]) -> Aim:
    numbers = [number(weight, "weights", "ratio") for weight in weights]
    if len(numbers) != 3 or min(numbers) < 0.0 or not max(numbers) > 0.0:
        what = _("expected three numbers, none negative and not all zero: of force, moment and drive")
        raise InputError("weights", what, "(1, 0, 0)")
    return Aim(*numbers)


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
