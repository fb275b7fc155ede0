"""Equations of forces by hand as formulas of a document: sums of moments, polygons as vector equations, levers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from centrode.dynamics.force_polygons.steps import (
    ClosedPolygon,
    EquationOutcome,
    ForceLine,
    ForcesAlongGuide,
    MomentsOfGroup,
    MomentsOfLink,
    MomentUnknown,
    Step,
)
from centrode.sheets.sheet import Block, Formula, Paragraph
from centrode.sheets.texts import Counted, Expression, Factor, Joined, Leaf, Name, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.dynamics.force_polygons.polygons import Lever
    from centrode.dynamics.force_polygons.statics import MomentTerm, StaticJoint

SYMBOL = re.compile(
    r"(?P<minus>−?)(?P<letter>MΦ|Mb|Fb|Mz|[RGFMΦ])(?P<index>[\d,]*)(?P<primes>′*)"
    r"(?:\((?P<place>[^()]*)\))?(?P<mark>[ᵗⁿ]?)"
)
"""The symbol of a force or moment: R34ᵗ, G2′, MΦ4, Fb(slide), F1(0)."""
LETTERS = {"MΦ": "M", "Mb": "M", "Fb": "F", "Mz": "M", "Φ": "Phi"}
BELOW = {"MΦ": "Phi", "Mb": 'upright("b")', "Fb": 'upright("b")', "Mz": "z"}
MARKS = {"ᵗ": "t", "ⁿ": "n"}
MOMENTS = ("MΦ", "Mb", "Mz", "M")


def step_equations(step: Step, sentence: Text) -> Iterator[Block]:
    """A step of a solution: its equations as formulas below a line that names them, else its sentence.

    Parameters
    ----------
    step : Step
    sentence : the step in words
    """
    match step:
        case MomentsOfLink(link, about, MomentUnknown() as unknown, terms, outcome):
            yield Paragraph(
                Sentence("Moments of link {link} about {point}:", link=Number(link), point=_joint(about))
            )
            yield _moments(about, unknown, terms, outcome)
        case MomentsOfLink(link, about, None, _terms, outcome, beside=beside):
            yield Paragraph(
                Sentence("Moments of link {link} about {point}:", link=Number(link), point=_joint(about))
            )
            yield Formula((_outcome(outcome),))
            if beside is not None:
                arm = Number(beside[1], "m", ".5g", unit_fixed=True)
                offset = Sentence("{symbol} acts at an offset of {arm}", symbol=Name(beside[0]), arm=arm)
                yield Paragraph(offset, clause=True)
        case MomentsOfGroup(links, about, unknown, terms, outcome):
            yield Paragraph(
                Sentence(
                    "Moments of the group {links} about {point}:", links=_numbers(links), point=_joint(about)
                )
            )
            yield _moments(about, unknown, terms, outcome)
        case ClosedPolygon(links, forces, lines, last):
            yield Paragraph(
                Counted(
                    "The polygon of forces on link {links} closes:",
                    "The polygon of forces on links {links} closes:",
                    len(links),
                    links=_numbers(links),
                )
            )
            closed: tuple[Leaf, ...] = (_sum([force_symbol(force, vector=True) for force in forces]), "0")
            yield Formula((closed, *(() if last is None else (_outcome(last),))))
            if lines:
                yield Formula(((_directions(lines),),))
        case ForcesAlongGuide(link, guide, forces, outcome) if forces:
            yield Paragraph(
                Sentence("Forces on link {link} along guide {guide}:", link=Number(link), guide=Name(guide))
            )
            along = Expression("sum F_({guide})", guide=Name(guide))
            yield Formula(((along, _sum([force_symbol(force) for force in forces]), "0"), _outcome(outcome)))
        case _:
            yield Paragraph(sentence, clause=True)


def lever_equation(lever: Lever, none: float) -> Formula:
    """Moments of all forces about the pole of Zhukovsky's lever, and what balances them.

    Those up to `none` are rounding.
    """
    terms = [one for one in lever.forces if abs(one.moment) > none]
    balancing = "Mb" if lever.unit == "N m" else "Fb"
    unknown = force_symbol(balancing)
    moments = [Expression("M_p ({force})", force=_of_moment(one.name)) for one in terms]
    known = _signed_sum(
        [(unknown, False), *((_size(one.moment, lever.unit), one.moment < 0) for one in terms)]
    )
    return Formula(
        (
            (Expression("sum M_p"), _sum([unknown, *moments]), known, "0"),
            (unknown, Number(lever.balancing + 0.0, lever.unit)),
        )
    )


def force_symbol(symbol: str, *, vector: bool = False) -> Leaf:
    """The symbol of a force or moment as mathematics, a force as a `vector` with an arrow."""
    found = SYMBOL.fullmatch(symbol)
    if found is None:
        return Name(symbol)
    letter, place, mark = found["letter"], found["place"], MARKS.get(found["mark"], "")
    base = LETTERS.get(letter, letter)
    base = f"arrow({base})" if vector and letter not in MOMENTS else base
    below = [BELOW[letter]] if letter in BELOW else []
    below += (
        [f"{found['index']}"]
        if found["index"].isdecimal()
        else [f'"{found["index"]}"'] * bool(found["index"])
    )
    below += ["{place}"] if place is not None else []
    notation = "-" * bool(found["minus"]) + base
    notation += f"_({', '.join(below) if place is not None else ' '.join(below)})" if below else ""
    above = " ".join(["prime"] * len(found["primes"]) + [mark] * bool(mark))
    notation += f"^({above})" if above else ""
    return Expression(notation) if place is None else Expression(notation, place=Name(place))


def _moments(
    about: StaticJoint, unknown: MomentUnknown, terms: Sequence[MomentTerm], outcome: EquationOutcome
) -> Formula:
    """The sum of moments about a joint, in symbols and in numbers, and what follows from it."""
    below = Name(about.name)
    first = force_symbol(unknown.symbol)
    with_arm: Leaf = first
    if unknown.arm is not None:
        arm = Number(unknown.arm, "m", ".5g", unit_fixed=True, unit_hidden=True)
        with_arm = Expression("{force} dot.op {arm}", force=first, arm=Factor(arm))
    symbols = [_moment_of(unknown.symbol, below), *(_moment_of(term.symbol, below) for term in terms)]
    numbers = _signed_sum(
        [(with_arm, False), *((_size(term.moment, "N m"), term.moment < 0) for term in terms)]
    )
    return Formula(
        ((Expression("sum M_({point})", point=below), _sum(symbols), numbers, "0"), _outcome(outcome))
    )


def _moment_of(symbol: str, below: Name) -> Leaf:
    """The moment of a force about a point; a moment is its own."""
    found = SYMBOL.fullmatch(symbol)
    if found is not None and found["letter"] in MOMENTS:
        return force_symbol(symbol)
    return Expression("M_({point}) ({force})", point=below, force=force_symbol(symbol, vector=True))


def _of_moment(symbol: str) -> Leaf:
    found = SYMBOL.fullmatch(symbol)
    return force_symbol(symbol, vector=found is not None and found["letter"] not in MOMENTS)


def _size(moment: float, unit: str) -> Number:
    return Number(abs(moment), unit, ".5g", unit_hidden=True)


def _sum(terms: Sequence[Leaf]) -> Leaf:
    return _signed_sum([(term, False) for term in terms])


def _signed_sum(terms: Iterable[tuple[Leaf, bool]]) -> Leaf:
    """A sum of terms, each with whether it is subtracted; the first is not."""
    notation, holes = "", {}
    for number, (term, subtracted) in enumerate(terms):
        notation += f" {'-' if subtracted else '+'} {{t{number}}}" if number else "{t0}"
        holes[f"t{number}"] = term
    return Expression(notation, **holes)


def _outcome(outcome: EquationOutcome) -> tuple[Leaf, Leaf]:
    symbol = force_symbol(outcome.symbol, vector=outcome.magnitude)
    left = Expression("abs({force})", force=symbol) if outcome.magnitude else symbol
    return left, Number(outcome.value, outcome.unit)


def _directions(lines: Sequence[ForceLine]) -> Leaf:
    """Known directions one behind the other: R05 square to guide H, R34 along DH."""
    holes: dict[str, Leaf] = {}
    parts = []
    for number, line in enumerate(lines):
        holes[f"force{number}"] = force_symbol(line.symbol, vector=True)
        if line.guide:
            holes[f"line{number}"] = _guide(line.guide)
            parts.append(f"{{force{number}}} perp {{line{number}}}")
        else:
            short = all(joint.kind == "hinge" and len(joint.name) <= 2 for joint in line.through)
            holes[f"line{number}"] = Name(("" if short else " – ").join(joint.name for joint in line.through))
            parts.append(f"{{force{number}}} parallel {{line{number}}}")
    return Expression(" , quad ".join(parts), **holes)


def _numbers(numbers: Iterable[int]) -> Text:
    return Joined(tuple(map(Number, numbers)))


def _joint(joint: StaticJoint) -> Text:
    return _guide(joint.name) if joint.kind == "guide" else Name(joint.name)


def _guide(name: str) -> Sentence:
    """A guide that something is about or square to: languages with cases do not use the nominative there."""
    return Sentence("the guide {guide}", guide=Name(name))
