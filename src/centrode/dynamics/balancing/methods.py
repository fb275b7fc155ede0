"""The products of mass and radius that were requested: force zero, least greatest effects, a fraction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.dynamics.balancing.counterweights import (
    LEAST,
    PARAMETERS,
    Counterweight,
    CounterweightPlace,
    add_inertia,
    columns_of,
    hinged_from,
    mass_moments,
    number,
    parameters,
    replace_parts,
)
from centrode.dynamics.balancing.minimax import CLOSED, MinimaxSolution, MinimaxTerm, least
from centrode.dynamics.balancing.shaking_forces import (
    Array,
    Complex,
    Effects,
    MassTracks,
    ShakingTurning,
    cross,
    greatest_of,
    heavy,
    orders,
    tops_of,
)
from centrode.dynamics.state import Mass
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.gears import Gear
from centrode.model.mechanism import Link, Mechanism

# Full balance of the shaking force: the common centre of mass is brought to rest.
#
# The sum of mass times place of all links is to be constant. Places of bases and rotors of links with
# counterweights are functions of the drive; where the sum lies in their span (with constants) the
# counterweights follow from linear equations: the method of linearly independent vectors (R. S. Berkof, G. G.
# Lowen, Journal of Engineering for Industry 91, 1969, 21-26) by numbers in place of the closure of loops.

INSTANTS = 90
"""Values of the drive in a turn at which the sum is looked at."""
SAME = 1e-9
"""What is left of the sum, over the sum of masses times the greatest length, that counts as rounding."""
MOST_ROUNDS = 60
SETTLED = 1e-14


@dataclass(frozen=True)
class FullBalance:
    """Products of mass and radius (spots) in the axes of their links [kg m].

    Attributes
    ----------
    left : float
        What is left of the sum of mass times place, over all masses times the greatest length.
    unique : bool
        Whether no other counterweights on these links do the same.
    """

    products: Complex
    left: float
    unique: bool

    @property
    def complete(self) -> bool:
        """Whether the centre of mass is at rest."""
        return self.left <= SAME


def full_balance(turning: ShakingTurning, spots: Sequence[CounterweightPlace]) -> FullBalance:
    """The counterweights on given links that come nearest to a centre of mass at rest.

    The mass of a counterweight whose base moves acts on what carries it, so it is found in rounds.
    """
    values = turning.values(INSTANTS * turning.turns)
    state, tracks = turning.at(values)
    mass = np.array([each.mass for each in turning.masses])
    # constants do not shake: only what differs from the mean counts
    own = _remove_mean(mass @ tracks.places[0])
    pairs = [mass_moments(state, spot) for spot in spots]
    bases = np.array([_remove_mean(base) for base, _rotor in pairs]).reshape(len(spots), len(values))
    rotors = np.array([_remove_mean(rotor) for _base, rotor in pairs]).reshape(len(spots), len(values))
    products = np.zeros(len(spots), dtype=np.complex128)
    rank = len(spots)
    for _round in range(MOST_ROUNDS):
        # the mass that goes with a product acts on what carries its base: it is known from the round before
        masses = np.array(
            [spot.making.counterweight_for(abs(s)).mass for spot, s in zip(spots, products, strict=True)]
        )
        before = products
        if len(spots):
            # spots whose rotors depend on each other to rounding share the work: the least products are taken
            products, _rest, rank, _sizes = np.linalg.lstsq(rotors.T, -(own + masses @ bases), rcond=SAME)
        if np.max(np.abs(products - before), initial=0.0) <= SETTLED * float(mass.sum()) * state.scale:
            break
    masses = np.array(
        [spot.making.counterweight_for(abs(s)).mass for spot, s in zip(spots, products, strict=True)]
    )
    rest = own + masses @ bases + products @ rotors
    whole = float(mass.sum() + masses.sum()) * state.scale
    return FullBalance(products, float(np.max(np.abs(rest))) / whole, int(rank) == len(spots))


def _remove_mean(places: Complex) -> Complex:
    """Places less their mean."""
    return np.asarray(places - places.mean())


def enough_spots(
    turning: ShakingTurning, candidates: Sequence[CounterweightPlace]
) -> list[CounterweightPlace]:
    """Candidates that suffice for balance, as few as possible and early ones first; all where no choice suffices."""
    hung = [spot for spot in candidates if spot.fixed]
    chosen = list(hung)
    # first those hinged to the frame, as their mass alone does nothing; then others until the balance is
    # complete
    for spot in [each for each in candidates if not each.fixed]:
        if full_balance(turning, chosen).complete:
            break
        chosen.append(spot)
    if not full_balance(turning, chosen).complete:
        return list(candidates)
    # from the last one back: what has become superfluous goes
    for spot in reversed(list(chosen)):
        fewer = [each for each in chosen if each is not spot]
        if full_balance(turning, fewer).complete:
            chosen = fewer
    return chosen


# Slider-cranks and four-bars by their parts, with masses replaced at joints: the textbook's way to
# counterweights.
#
# A link's mass with its centre on the line of two joints is replaced by two masses there with the same
# centre; as complex numbers also one beside the line: m z_S = m (1 - c) z_P + m c z_Q with c = (S - P)/(Q -
# P) in the link's axes.


@dataclass(frozen=True)
class Share:
    """The mass of a link replaced at its joints [kg]; the part beside their line is imaginary."""

    link: str
    first: str
    second: str
    at_first: complex
    at_second: complex


@dataclass(frozen=True)
class Loop:
    """A crank O-A, a coupler A-B, and what B moves with: a rocker B-D, or a guide of the frame.

    `slider` is the mass [kg] that moves with B along the guide besides the coupler's share; 0 with a rocker.
    """

    crank: str
    coupler: str
    rocker: str | None
    O: str
    A: str
    B: str
    D: str | None
    slider: float


def loop_of(mechanism: Mechanism, masses: Sequence[Mass]) -> Loop | None:
    """The four-bar or slider-crank that a mechanism is, driven at the crank; None for any other."""
    if mechanism.gears or mechanism.rolling or len(mechanism.drives) != 1:
        return None
    crank = mechanism.drives[0].link
    fixed = set(mechanism.frame.points)
    joints = {name: _joints(mechanism, name) for name in mechanism.links}
    if crank is None or mechanism.drives[0].relative_to != "frame":
        return None
    own = joints[crank]
    if len(own) != 2 or len(fixed & set(own)) != 1:
        return None
    O = next(point for point in own if point in fixed)
    A = next(point for point in own if point != O)
    couplers = [name for name, points in joints.items() if name != crank and A in points]
    if len(couplers) != 1 or len(joints[couplers[0]]) != 2:
        return None
    B = next(point for point in joints[couplers[0]] if point != A)
    rest = [name for name in mechanism.links if name not in (crank, couplers[0])]
    if not mechanism.guides and len(rest) == 1 and B in joints[rest[0]] and fixed & set(joints[rest[0]]):
        D = next(point for point in joints[rest[0]] if point in fixed)
        return Loop(crank, couplers[0], rest[0], O, A, B, D, 0.0)
    if len(mechanism.guides) == 1 and mechanism.guides[0].on == "frame" and mechanism.guides[0].point == B:
        if len(rest) > 1 or (rest and rest[0] != mechanism.guides[0].link):
            return None
        slider = sum(mass.mass for mass in masses if mass.link in rest)
        return Loop(crank, couplers[0], None, O, A, B, None, float(slider))
    return None


def _joints(mechanism: Mechanism, link: str) -> list[str]:
    """Points of a link that another one, the frame or a guide has too."""
    shared = set(mechanism.frame.points) | {guide.point for guide in mechanism.guides}
    for name, other in mechanism.links.items():
        if name != link:
            shared |= set(other.coordinates)
    return [point for point in mechanism.links[link].coordinates if point in shared]


def share_of(mechanism: Mechanism, masses: Sequence[Mass], link: str, first: str, second: str) -> Share:
    """The mass of a link replaced at two of its points."""
    places = {name: complex(*xy) for name, xy in mechanism.links[link].coordinates.items()}
    for mass in masses:
        if mass.link == link:
            centre = mass.planar_centre
            at = places[centre.base] + complex(centre.along, centre.across)
            # of the base along the joints' line and across it: one complex number says both
            c = (at - places[first]) / (places[second] - places[first])
            return Share(link, first, second, mass.mass * (1.0 - c), mass.mass * c)
    return Share(link, first, second, 0j, 0j)


def arm(mechanism: Mechanism, link: str, first: str, second: str) -> complex:
    """The way from one point of a link to another, in its axes [m]."""
    places = mechanism.links[link].coordinates
    return complex(*places[second]) - complex(*places[first])


def shares_of(mechanism: Mechanism, masses: Sequence[Mass], loop: Loop) -> tuple[Share, ...]:
    """Crank, coupler and rocker replaced at their joints; what stands at a fixed joint does not move."""
    shares = [
        share_of(mechanism, masses, loop.crank, loop.O, loop.A),
        share_of(mechanism, masses, loop.coupler, loop.A, loop.B),
    ]
    if loop.rocker is not None and loop.D is not None:
        shares.append(share_of(mechanism, masses, loop.rocker, loop.D, loop.B))
    return tuple(shares)


def fraction_of_slider_crank(
    mechanism: Mechanism, masses: Sequence[Mass], loop: Loop, fraction: float
) -> complex:
    """Product on the crank that balances what turns with its pin and a fraction of what moves to and fro [kg m]."""
    crank, coupler = shares_of(mechanism, masses, loop)
    rotating = crank.at_second + coupler.at_first
    reciprocating = coupler.at_second + loop.slider
    # opposite to the crank's pin
    return -(rotating + fraction * reciprocating) * arm(mechanism, loop.crank, loop.O, loop.A)


# Balance of the shaking moment: discs that turn against links hinged to the frame, and inertia added to the
# others.
#
# Once the force is balanced, the moment of momentum does not depend on the place it is taken about. Where it
# is a sum of constants times the angular velocities of the links, discs geared one to one against the links
# on the frame cancel their shares. Of an in-line four-bar the coupler has no share if it is a physical
# pendulum, k^2 = r r' with r, r' the distances of its centre of mass from its joints (R. S. Berkof, Mechanism
# and Machine Theory 8, 1973, 397-410).


@dataclass(frozen=True)
class CounterweightDisc:
    """Inertia that balances the shaking moment.

    Attributes
    ----------
    link : str
        The link it is geared to, one to one, or fixed to.
    base : str or None
        The point of the frame about which it turns against the link; None where it is fixed to the link.
    inertia : float [kg m^2]
    """

    link: str
    base: str | None
    inertia: float


def discs_for(turning: ShakingTurning, mechanism: Mechanism) -> tuple[CounterweightDisc, ...]:
    """The discs that balance the moment of a mechanism whose force is balanced.

    Raises MotionError where none do: the links are not in line, or a link has more inertia than it may have.
    """
    values = turning.values(INSTANTS * turning.turns)
    state, tracks = turning.at(values)
    momentum, size = _momentum(tracks, turning.masses)
    hinged = hinged_from(mechanism)
    names = [name for name in mechanism.links if _turns(orders(state.angle(name), len(values))[1])]
    rates = np.array([orders(state.angle(name), len(values))[1] for name in names])
    # momentum as a sum of constants times rates: the constants are the inertias that are too much
    inertias, _rest, _rank, _sizes = np.linalg.lstsq(rates.T, momentum, rcond=SAME)
    left = float(np.max(np.abs(momentum - inertias @ rates), initial=0.0))
    if left > SAME * size:
        raise MotionError(
            "",
            _("discs cannot balance the shaking moment: {share:.2%} of it would remain").format(
                share=left / float(np.max(np.abs(momentum)))
            ),
            _("put the centres of mass of the links on the lines between their joints"),
        )
    discs = []
    for name, inertia in zip(names, inertias, strict=True):
        if abs(inertia) * float(np.max(np.abs(rates))) <= SAME * size:
            # what is rounding beside the whole is no disc
            continue
        base = hinged.get(name)
        # too much inertia on the frame: a disc turns against the link; too little: the link gets more
        if inertia > 0.0 and base in mechanism.frame.points:
            discs.append(CounterweightDisc(name, base, float(inertia)))
        elif inertia < 0.0:
            discs.append(CounterweightDisc(name, None, -float(inertia)))
        else:
            raise _too_much(name, float(inertia))
    return tuple(discs)


def _momentum(tracks: MassTracks, masses: Sequence[Mass]) -> tuple[Array, float]:
    """Moment of momentum at unit speed of the drive (n), and the greatest sum of the sizes of its parts."""
    mass, inertia = (np.array([getattr(each, name) for each in masses]) for name in ("mass", "inertia"))
    # about any place, as the force is balanced; near the middle numbers are small
    middle = tracks.places[0].mean()
    parts = [mass[:, None] * cross(tracks.places[0] - middle, tracks.places[1])]
    parts.append(inertia[:, None] * tracks.angles[1])
    whole = np.concatenate(parts)
    return whole.sum(axis=0), float(np.max(np.abs(whole).sum(axis=0)))


def _turns(rate: Array) -> bool:
    return bool(np.max(np.abs(rate)) > SAME)


def _too_much(link: str, surplus: float) -> MotionError:
    what = _(
        "the shaking moment cannot be balanced: the moment of inertia of {link} is {surplus:.6g} kg·m² too "
        "large, and the link is not hinged to the frame, so that no counter-rotating disc can be placed"
    )
    return MotionError(
        f"[links.{link}]",
        what.format(link=link, surplus=surplus),
        _(
            "make it a physical pendulum: reduce its moment of inertia, or move its centre of mass towards the "
            "middle of its joints"
        ),
    )


def with_discs(mechanism: Mechanism, discs: Sequence[CounterweightDisc]) -> Mechanism:
    """The description with the discs: fixed ones in the inertia of their links, the others as links with gears."""
    links, gears = dict(mechanism.links), list(mechanism.gears)
    own = {mass.link: mass for mass in heavy(mechanism)}
    for disc in discs:
        if disc.base is None:
            links[disc.link] = add_inertia(links[disc.link], own.get(disc.link), disc.inertia)
            continue
        name = disc_name(mechanism, disc.link)
        # geared one to one against the link, about the same point of the frame
        links[name] = Link(points={disc.base: (0.0, 0.0)}, inertia=disc.inertia)
        gears.append(Gear(links=(disc.link, name), ratio=-1.0))
    return replace_parts(mechanism, links=links, gears=tuple(gears))


def disc_name(mechanism: Mechanism, link: str) -> str:
    """A name for the disc of a link that no link has."""
    taken = set(mechanism.links)
    name = f"disc {link}"[:40]
    number = 2
    while name in taken:
        name, number = f"disc {number} {link}"[:40], number + 1
    return name


# What counterweights are weighed by: the greatest effects over a cycle, and how they depend on the products.

PULL = 1e-9
"""Weight of the greatest product over `unit`: of counterweights that do the same the smaller ones are taken."""
BETWEEN = 1e-9
"""By how much a top between instants may stand out, over the value, before it becomes an instant."""


@dataclass(frozen=True)
class Objective:
    """Weights of greatest shaking force, shaking moment and moment of the drive, each over that of before."""

    force: float = 1.0
    moment: float = 0.0
    driving: float = 0.0

    @property
    def parts(self) -> list[tuple[str, float]]:
        """Names and weights of what counts."""
        named = (("force", self.force), ("moment", self.moment), ("driving", self.driving))
        return [(name, weight) for name, weight in named if weight > 0.0]


@dataclass(frozen=True)
class BalanceProblem:
    """Spots on a turning mechanism, looked at at some values of the drive; unknowns are products over `unit`."""

    turning: ShakingTurning
    spots: tuple[CounterweightPlace, ...]
    aim: Objective
    sizes: tuple[float, ...]
    values: Array

    @cached_property
    def own(self) -> Effects:
        """Effects of the links."""
        return self.turning.effects(self.values)

    @cached_property
    def columns(self) -> list[Effects]:
        """Effects of the parameters of each counterweight."""
        return self.columns_at(self.values)

    def columns_at(self, values: Array) -> list[Effects]:
        """Effects of the parameters of each counterweight at values (n) of the drive."""
        state, pace = self.turning.instants.state(values), self.turning.instants.pace(values)
        return [columns_of(state, spot, pace, self.turning.about) for spot in self.spots]

    @property
    def unit(self) -> float:
        """Unit of products of mass and radius [kg m]: the sum of all masses times the greatest length."""
        scale = self.turning.instants.ready.kinematics.path.scale
        return scale * (sum(each.mass for each in self.turning.masses) or 1.0)

    @property
    def linear(self) -> bool:
        """Whether effects that count depend linearly on the products."""
        return all(name == "force" for name, _weight in self.aim.parts) and all(
            spot.fixed for spot in self.spots
        )

    @property
    def convex(self) -> bool:
        """Whether effects depend linearly on the products and their lengths: inertia of discs goes with the square."""
        return self.linear or all(spot.making.thickness is None for spot in self.spots)

    @cached_property
    def pull(self) -> float:
        """Weight of the greatest product, where several counterweights may do the same."""
        if not self.linear:
            return PULL
        rows = np.concatenate([column.force[1:3] for column in self.columns]).T
        parts = np.concatenate([rows.real, rows.imag])
        # rows that depend on each other: several sets of products do the same, and the smallest is wanted
        return (
            0.0 if np.linalg.matrix_rank(parts, tol=SAME * np.linalg.norm(parts)) == parts.shape[1] else PULL
        )

    def products(self, x: Array) -> Complex:
        """Products [kg m] of the unknowns, which are real pairs."""
        return np.asarray(self.unit * (x[::2] + 1j * x[1::2]))

    def effects(self, x: Array, own: Effects, columns: Sequence[Effects]) -> Effects:
        """Effects of links and counterweights."""
        whole = own
        for spot, product, column in zip(self.spots, self.products(x), columns, strict=True):
            whole = whole + column.times(parameters(spot.making.counterweight_for(abs(product)), product))
        return whole

    def terms(self, x: Array, lengths: Sequence[bool]) -> list[MinimaxTerm]:
        """Terms of the minimax problem, linear about `x`; `lengths` marks spots whose length is an unknown."""
        whole = self.effects(x, self.own, self.columns)
        products = self.products(x)
        # all unknowns: components of the products, then their lengths
        place = np.concatenate([x, np.abs(products) / self.unit])
        slopes = [self._slopes(*each) for each in zip(self.spots, products, lengths, strict=True)]
        terms = []
        for (name, weight), size in zip(self.aim.parts, self.sizes, strict=True):
            parts = [s @ getattr(column, name) for s, column in zip(slopes, self.columns, strict=True)]
            rows = np.concatenate([*(part[:2] for part in parts), *(part[2:] for part in parts)]).T
            rows = rows * (self.unit / size)
            # what makes the linear function agree with the effects at x
            constant = np.asarray(getattr(whole, name) / size - rows @ place)
            terms.append(MinimaxTerm(weight, constant, rows))
        if not self.pull:
            return terms
        pairs = len(self.spots)
        # the greatest product itself as a term of very little weight
        small = np.zeros((pairs, 3 * pairs), dtype=np.complex128)
        small[np.arange(pairs), 2 * np.arange(pairs)] = 1.0
        small[np.arange(pairs), 2 * np.arange(pairs) + 1] = 1j
        return [*terms, MinimaxTerm(self.pull, np.zeros(pairs, dtype=np.complex128), small)]

    def _slopes(self, spot: CounterweightPlace, product: complex, length: bool) -> Array:
        """Derivatives of the parameters by the product's components and its length (3, PARAMETERS)."""
        made = spot.making.counterweight_for(abs(product), LEAST * self.unit)
        # the direction in which the length of the product grows
        towards = product / abs(product) if product else 0j
        by_length = np.array([made.mass_slope, 0.0, 0.0, made.inertia_slope])
        slopes = np.zeros((3, PARAMETERS))
        slopes[0, 1] = slopes[1, 2] = 1.0
        if length:
            slopes[2] = by_length
        else:
            slopes[0] += towards.real * by_length
            slopes[1] += towards.imag * by_length
        return slopes

    def value(self, x: Array) -> float:
        """The weighted sum of greatest effects at the instants."""
        whole = self.effects(x, self.own, self.columns)
        return self.pull * float(np.max(np.hypot(x[::2], x[1::2]))) + sum(
            weight * float(np.max(np.abs(getattr(whole, name)))) / size
            for (name, weight), size in zip(self.aim.parts, self.sizes, strict=True)
        )

    def with_tops(self, x: Array) -> BalanceProblem | None:
        """The problem with tops between its instants as further instants; None where none stands out."""
        added: list[Array] = []
        whole = self.effects(x, self.own, self.columns)
        for name, _weight in self.aim.parts:
            places, heights = tops_of(lambda q, name=name: self._size(x, name, q), self.turning.nodes)  # type: ignore[misc]
            greatest = float(np.max(np.abs(getattr(whole, name))))
            added.append(places[heights > greatest * (1.0 + BETWEEN)])
        if not any(len(places) for places in added):
            return None
        values = np.concatenate([self.values, *added])
        return BalanceProblem(self.turning, self.spots, self.aim, self.sizes, values)

    def _size(self, x: Array, name: str, values: Array) -> Array:
        whole = self.effects(x, self.turning.effects(values), self.columns_at(values))
        return np.asarray(np.abs(getattr(whole, name)))


# Counterweights with the least greatest effects: shaking force, shaking moment, moment of the drive,
# weighted.
#
# With bases in the frame the force depends linearly on the products of mass and radius, and the least
# greatest force is found with a proof (`minimax`). Masses and inertias go with the length of the products,
# which may be an unknown of its own, not below them: a convex problem that bounds the answer. Where its
# lengths are those of its products it is the answer. Else, and with discs, linear problems are solved one
# after the other within a region of trust.

MINIMAX_INSTANTS = 180
WIDE = 20.0
"""Products of mass and radius are looked for up to so many times all masses times the greatest length."""
STEPS, EXCHANGES = 60, 8
CONVERGED, ROUGHLY = 1e-9, 1e-3
"""Gain that a linear problem still promises, over the value, at which a search ends, and a first look."""
NEARBY, LEAST_TRUST = 1e-2, 1e-9
"""Region of trust about an answer that more instants change a little, and the least one."""
CRUMB = 1e-6
"""Product over `unit` of a counterweight that is tried to be left out."""
TIGHT = 1e-7
"""By how much the value may exceed that of the problem in which lengths of products are free to be greater."""


@dataclass(frozen=True)
class Lightest:
    """Products of mass and radius (spots), the value reached, and what none can go below (None where not proved)."""

    products: Complex
    value: float
    bound: float | None


def lightest(
    turning: ShakingTurning, spots: Sequence[CounterweightPlace], aim: Objective, sizes: Sequence[float]
) -> Lightest:
    """The counterweights with the least weighted sum of greatest effects over a cycle.

    `sizes` are the greatest effects without counterweights, of what counts, which the effects are measured by.
    """
    problem = BalanceProblem(
        turning, tuple(spots), aim, tuple(sizes), turning.values(MINIMAX_INSTANTS * turning.turns)
    )
    most = [spot.making.greatest for spot in spots]
    # in units of the problem, and never without a bound, as linear programmes need a bounded box
    limits = np.array([WIDE if limit is None else min(WIDE, limit / problem.unit) for limit in most])
    x, bound = _solve_problem(problem, limits, None)
    for _exchange in range(EXCHANGES):
        finer = problem.with_tops(x)
        if finer is None:
            break
        problem = finer
        x, bound = _solve_problem(problem, limits, x)
    x = _without_crumbs(problem, x)
    return Lightest(problem.products(x), problem.value(x), bound)


def _solve_problem(problem: BalanceProblem, limits: Array, near: Array | None) -> tuple[Array, float | None]:
    """The answer, with what no answer goes below where that is proved; `near` is one for a few instants less."""
    zero = np.zeros(2 * len(problem.spots))
    if problem.convex:
        solution = _linear(problem, zero, limits, WIDE, CLOSED, [True] * len(problem.spots))
        x = solution.x[: len(zero)]
        # without what the small pull may have added
        bound = max(solution.bound - problem.pull * WIDE, 0.0)
        # lengths that are free to be greater than their products' would not make it better: then the convex
        # answer is the answer
        if problem.value(x) <= solution.value + TIGHT * max(solution.value, 1e-3):
            return x, bound
        # more inertia than the products have would be better: what was proved is not reached
    if near is not None:
        return _descend(problem, near, limits, CONVERGED, NEARBY), None
    full = full_balance(problem.turning, problem.spots).products / problem.unit
    resting = np.stack([full.real, full.imag], axis=1).reshape(-1)
    longest = np.repeat(np.maximum(np.hypot(resting[::2], resting[1::2]) / limits, 1.0), 2)
    # a full balance that is too heavy is shortened until it is allowed
    resting = resting / longest
    # the search is local: from no counterweights, from the full balance, from half of it, and from the other
    # side
    beginnings = [zero, resting, 0.5 * resting, -0.5 * resting]
    looked = [_descend(problem, x, limits, ROUGHLY, WIDE) for x in beginnings]
    return _descend(problem, min(looked, key=problem.value), limits, CONVERGED, 10.0 * NEARBY), None


def _linear(
    problem: BalanceProblem, x: Array, limits: Array, trust: float, closed: float, lengths: Sequence[bool]
) -> MinimaxSolution:
    """The answer of the linear problem about some unknowns, within a region of trust."""
    own = np.hypot(x[::2], x[1::2])
    low = np.concatenate([np.maximum(x - trust, -WIDE), np.maximum(own - 2.0 * trust, 0.0)])
    high = np.concatenate([np.minimum(x + trust, WIDE), np.minimum(own + 2.0 * trust, limits)])
    return least(problem.terms(x, lengths), low, high, closed)


def _descend(problem: BalanceProblem, x: Array, limits: Array, converged: float, trust: float) -> Array:
    """Linear problems one after the other.

    The length of a product bends where it is zero: there, and only there, it is an unknown of its own.
    """
    value = problem.value(x)
    for _step in range(STEPS):
        # the length of a product that is nearly zero bends too much to be linear
        lengths = (np.hypot(x[::2], x[1::2]) < CRUMB).tolist()
        solution = _linear(problem, x, limits, trust, max(CLOSED, 0.1 * converged), lengths)
        there = solution.x[: len(x)]
        reached = problem.value(there)
        # what the linear problem promised against what came of it decides on the region of trust
        promised, gained = value - solution.value, value - reached
        step = float(np.max(np.abs(there - x)))
        if gained > 0.0:
            x, value = there, reached
        if promised <= converged * value:
            break
        if gained < 0.25 * promised:
            # a quarter of the step taken, if that was shorter than the region
            trust = 0.25 * min(trust, step or trust)
        elif gained > 0.75 * promised:
            trust = min(2.0 * trust, WIDE)
        if trust < LEAST_TRUST:
            break
    return x


def _without_crumbs(problem: BalanceProblem, x: Array) -> Array:
    """Without the counterweights that are nothing but what is left of the search."""
    small = np.repeat(np.hypot(x[::2], x[1::2]) < CRUMB, 2)
    fewer = np.where(small, 0.0, x)
    # only if the value does not grow by it
    return fewer if problem.value(fewer) <= problem.value(x) * (1.0 + CLOSED) else x


ROUNDING = 1e-9
"""Effects below this share of what their parts amount to are nothing but rounding."""
EFFECTS = {"force": "shaking_force", "moment": "shaking_moment", "driving": "inertia_on_drive"}


@dataclass(frozen=True)
class Chosen:
    """Products of mass and radius [kg m] in the axes of their links; the other attributes are those of `Balance`."""

    spots: tuple[CounterweightPlace, ...]
    products: Complex
    fraction: float | None = None
    weights: tuple[float, ...] | None = None
    left: float | None = None
    unique: bool = True
    bound: float | None = None
    proved: bool = False


def fully(
    mechanism: Mechanism, turning: ShakingTurning, spots: Sequence[CounterweightPlace], *, named: bool
) -> Chosen:
    """The force zero, by all spots where they were named, else by as few as are enough."""
    spots = spots if named else enough_spots(turning, spots)
    chosen = full_balance(turning, spots)
    if not chosen.complete:
        raise _cannot(turning, mechanism, spots, chosen.left)
    return Chosen(tuple(spots), chosen.products, left=chosen.left, unique=chosen.unique)


def least_effects(
    turning: ShakingTurning, spots: Sequence[CounterweightPlace], weights: Sequence[float]
) -> Chosen:
    """The least weighted sum of greatest effects."""
    aim = _aim(weights)
    greatest = greatest_of(turning)
    # weights count relative to the effects without counterweights
    sizes = [greatest[f"greatest_{EFFECTS[name]}"] for name, _weight in aim.parts]
    whole = {"force": turning.sizes[0], "moment": turning.sizes[1], "driving": turning.sizes[1]}
    # an effect that is rounding from the start has no share to be weighed by
    small = [size <= ROUNDING * whole[name] for (name, _weight), size in zip(aim.parts, sizes, strict=True)]
    if any(small):
        raise InputError("weights", _("the weighted effects are zero without counterweights"))
    try:
        chosen = lightest(turning, spots, aim, sizes)
    except ArithmeticError:
        what = _("the search for counterweights fails: effects over the cycle differ too much in size")
        raise MotionError(
            "", what, _("check whether a limit position is near, or choose the full balance")
        ) from None
    bound = None
    # in steady motion the counterweights change the speed itself, so nothing is proved
    proved = chosen.bound is not None and turning.instants.panels is None
    if chosen.bound is not None and proved and aim.force and len(aim.parts) == 1:
        bound = chosen.bound * sizes[0] / aim.force
    weighed = (aim.force, aim.moment, aim.driving)
    return Chosen(tuple(spots), chosen.products, weights=weighed, bound=bound, proved=proved)


def by_fraction(
    mechanism: Mechanism,
    turning: ShakingTurning,
    spots: Sequence[CounterweightPlace],
    loop: Loop | None,
    fraction: float,
) -> Chosen:
    """The one counterweight on the crank of a slider-crank."""
    share = number(fraction, "fraction", "ratio")
    if not 0.0 <= share <= 1.0:
        what = _("expected a number from 0 to 1, got {value}").format(value=f"{share:g}")
        raise InputError("fraction", what, _("half or two thirds are usual"))
    if loop is None or loop.rocker is not None:
        what = _("a fraction of the reciprocating masses is balanced in slider-cranks only")
        raise InputError("fraction", what, _("choose the full balance, or the least maximum force"))
    if [(spot.link, spot.base) for spot in spots] != [(loop.crank, loop.O)]:
        what = _("this counterweight is on the crank {crank}").format(crank=loop.crank)
        raise InputError("on", what, _("omit the links"))
    product = fraction_of_slider_crank(mechanism, turning.masses, loop, share)
    return Chosen(tuple(spots), np.array([product]), fraction=share)


def check_masses(spots: Sequence[CounterweightPlace], weighed: Sequence[Counterweight]) -> None:
    """Refuse counterweights with more mass than they may have."""
    for spot, weight in zip(spots, weighed, strict=True):
        most = spot.making.most
        if most is not None and weight.mass > most * (1.0 + 1e-9):
            what = _("the counterweight on {link} would have {mass:.6g} kg, more than {most:.6g} kg")
            raise MotionError(
                "most",
                what.format(link=weight.link, mass=weight.mass, most=most),
                _("allow a larger mass or radius, or choose the least maximum force"),
            )


def _aim(weights: Sequence[float]) -> Objective:
    numbers = [number(weight, "weights", "ratio") for weight in weights]
    if len(numbers) != 3 or min(numbers) < 0.0 or not max(numbers) > 0.0:
        what = _("expected three numbers, none negative and not all zero: of force, moment and drive")
        raise InputError("weights", what, "(1, 0, 0)")
    return Objective(*numbers)


def _cannot(
    turning: ShakingTurning, mechanism: Mechanism, spots: Sequence[CounterweightPlace], left: float
) -> MotionError:
    """Why the force cannot be balanced fully."""
    hinged = hinged_from(mechanism)
    heavy = [mass.link for mass in turning.masses if mass.weighs and mass.link not in hinged]
    links = ", ".join(spot.link for spot in spots) or _("none")
    if heavy:
        what = _(
            "the shaking force cannot be balanced fully: no chain of hinges connects the frame and {links}"
        )
        return MotionError(
            "", what.format(links=", ".join(heavy)), _("choose the least maximum force instead")
        )
    what = _(
        "counterweights on {links} do not balance the shaking force: the common centre of mass would still move "
        "({left:.2g} of the greatest length)"
    )
    return MotionError(
        "", what.format(links=links, left=left), _("name more links, or leave the choice to centrode")
    )
