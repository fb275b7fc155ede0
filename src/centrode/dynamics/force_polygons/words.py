"""The steps of a group in words: equations of moments with their terms, equations of forces, what follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from centrode.dynamics.force_polygons.actions import Action
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.ledger import Ledger
from centrode.dynamics.force_polygons.sides import Dyad, Side
from centrode.locale import _

NONE = 1e-14
"""Arms and moments smaller than this part of what they are made of are rounding of none."""


@dataclass
class Words:
    """Lines told so far."""

    lines: list[str] = field(default_factory=list)

    def tangential(self, side: Side, inner: Joint, ledger: Ledger, arm: float, size: float) -> None:
        """Moments of a link about the inner hinge give the part of the outer reaction square to the arm."""
        symbol = ledger.symbol(side.joint, side.body) + "ᵗ"
        terms = ledger.told([side.body], inner.place)
        size = size if terms else 0.0
        self.about(side.body, inner, ledger, f"{symbol}·{arm:.5g}{terms} = 0, {symbol} = {size:.6g} N")

    def about(self, body: str, joint: Joint, ledger: Ledger, equation: str) -> None:
        """An equation of moments of one link."""
        self.lines.append(
            _("moments of link {link} about {point}: {equation}").format(
                link=self.link(body, ledger), point=joint_words(joint), equation=equation
            )
        )

    def polygon(self, dyad: Dyad, ledger: Ledger) -> None:
        """The forces of the group, and along what the unknown ones lie."""
        first, second = dyad.first, dyad.second
        one, other = (ledger.symbol(side.joint, side.body) for side in (first, second))
        known = names([*ledger.actions[first.body], *ledger.actions[second.body]])
        if dyad.inner.letter == "P":
            beside = _("⊥ guide {guide}").format(guide=dyad.inner.name)
            before, after = [f"{one}ⁿ", f"{one}ᵗ"], [other]
            unknown = [f"{one}ⁿ {beside}"]
            if second.joint.letter == "P":
                unknown.append(f"{other} {square_to(second.joint)}")
        else:
            before = [f"{one}ⁿ", f"{one}ᵗ"] if first.joint.letter == "R" else [one]
            after = [f"{other}ᵗ", f"{other}ⁿ"] if second.joint.letter == "R" else [other]
            unknown = [
                f"{symbol}ⁿ ∥ {between(side.joint, dyad.inner)}"
                if side.joint.letter == "R"
                else f"{symbol} {square_to(side.joint)}"
                for side, symbol in ((first, one), (second, other))
            ]
        told = " + ".join([*before, *known, *after])
        text = _("polygon of {links}: {equation}")
        self.lines.append(
            text.format(links=self.links(dyad, ledger), equation=f"{told} = 0, {', '.join(unknown)}")
        )

    def links(self, dyad: Dyad, ledger: Ledger) -> str:
        """Numbers of the bodies of a dyad."""
        numbers = sorted(ledger.bodies.number(side.body) for side in (dyad.first, dyad.second))
        return ", ".join(map(str, numbers))

    def closing(self, body: str, ledger: Ledger, outer: Joint | None, last: Action) -> None:
        """The polygon of one link gives the reaction that is left."""
        known = names(ledger.actions[body])
        if outer is not None:
            known = [ledger.symbol(outer, body), *known]
        told = " + ".join([*known, last.symbol])
        equation = f"{told} = 0, |{last.symbol}| = {abs(last.force):.6g} N"
        self.lines.append(
            _("polygon of {links}: {equation}").format(links=ledger.bodies.number(body), equation=equation)
        )

    def along_guide(self, side: Side, inner: Joint, ledger: Ledger, part: float) -> None:
        """A link that slides is in equilibrium along its guide without the other link."""
        symbol = ledger.symbol(side.joint, side.body) + "ᵗ"
        known = names(ledger.actions[side.body])
        told = " + ".join([symbol, *known])
        self.lines.append(
            _("link {link} along guide {guide}: {equation}").format(
                link=self.link(side.body, ledger),
                guide=inner.name,
                equation=f"{told} = 0, {symbol} = {part + 0.0:.6g} N",
            )
        )

    def about_far_hinge(
        self, dyad: Dyad, ledger: Ledger, part: float, lever: float, reach: float, left: float
    ) -> None:
        """Moments of the whole group about the second outer hinge."""
        symbol = ledger.symbol(dyad.first.joint, dyad.first.body)
        terms = ledger.told([dyad.first.body, dyad.second.body], dyad.second.joint.place)
        held = f" {'-' if part * lever < 0 else '+'} {abs(part * lever):.5g} ({symbol}ᵗ)"
        if abs(lever) <= NONE * ledger.scale:
            held = ""
        equation = f"{symbol}ⁿ·{reach:.5g}{held}{terms} = 0, {symbol}ⁿ = {left:.6g} N"
        self.lines.append(
            _("moments of the group {links} about {point}: {equation}").format(
                links=self.links(dyad, ledger), point=joint_words(dyad.second.joint), equation=equation
            )
        )

    def guide_moment(self, joint: Joint, body: str, ledger: Ledger, moment: float, force: complex) -> None:
        """Moment of a guide on a link, and by how much its force therefore passes beside."""
        symbol = ledger.symbol(joint, body)
        loads = sum(abs(action.force) for action in ledger.actions[body]) + abs(force)
        some = abs(moment) > NONE * ledger.scale * loads
        size = f"M{symbol.removeprefix('R')} = {moment if some else 0.0:.6g} N m"
        if force and some:
            beside = _("{symbol} acts {arm} m beside").format(
                symbol=symbol, arm=f"{abs(moment) / abs(force):.5g}"
            )
            size = f"{size}, {beside}"
        self.lines.append(
            _("moments of link {link} about {point}: {equation}").format(
                link=self.link(body, ledger), point=joint_words(joint), equation=size
            )
        )

    def notes(self, joints: Sequence[Joint]) -> None:
        """What a reader has to know of meshes, and of contacts that something else keeps."""
        for joint in joints:
            if joint.kind == "mesh" and joint.has_force:
                text = _(
                    "gear {name}: the part of the teeth's force that presses the wheels apart is left out"
                )
            elif joint.kind == "mesh":
                text = _(
                    "gear {name}: moments alone, because nothing tells its pitch point; what forces between"
                    " teeth add in the bearings is left out"
                )
            elif joint.kind == "rolling" and len(joint.bases) == 1:
                text = _(
                    "wheel {name} is kept at its track by other joints: equilibrium does not determine its"
                    " normal force, which is taken as none, here and in the joints that keep it"
                )
            else:
                continue
            self.lines.append(text.format(name=joint.name))

    def say(self, line: str) -> None:
        """Any other line."""
        self.lines.append(line)

    def link(self, body: str, ledger: Ledger) -> str:
        """Number of a body."""
        return str(ledger.bodies.number(body))


def names(actions: Sequence[Action]) -> list[str]:
    """Symbols of what has a force."""
    return [action.symbol for action in actions if action.force != 0]


def between(first: Joint, second: Joint) -> str:
    """The line through two hinges: AB, with longer names parted."""
    names = joint_words(first), joint_words(second)
    return "".join(names) if max(map(len, names)) <= 2 else " – ".join(names)


def square_to(joint: Joint) -> str:
    """Direction of a guide's force."""
    return _("⊥ guide {guide}").format(guide=joint.name)


def joint_words(joint: Joint) -> str:
    """Where a joint is: the point of a hinge, a guide, a contact."""
    if joint.kind == "guide":
        return _("guide {guide}").format(guide=joint.name)
    if joint.kind == "mesh":
        return _("the teeth of {gear}").format(gear=joint.name)
    if joint.kind == "rolling":
        return _("the contact of {wheel}").format(wheel=joint.name)
    return joint.name
