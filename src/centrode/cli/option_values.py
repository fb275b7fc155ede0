"""What the texts of options mean as arguments of computations: (mechanism, text or texts, "--name") -> value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.dynamics.balancing.balance import To
    from centrode.model.mechanism import Mechanism

# Options of the form NAME=VALUE.


def pairs(texts: Iterable[str], where: str, sample: str = "EC=30 deg") -> dict[str, str]:
    """Name -> value of texts NAME=VALUE; raises InputError for another form, and for a name given twice.

    `sample` is what a refusal shows as right.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not name or not value:
            raise InputError(
                where,
                _("expected NAME=VALUE, got {text}").format(text=f'"{text}"'),
                _("write {sample}").format(sample=f'"{sample}"'),
            )
        if name in found:
            raise InputError(where, _("{name} is given twice").format(name=name), _("keep one of them"))
        found[name] = value
    return found


def read_speeds(_mechanism: Mechanism, texts: Iterable[str], where: str) -> dict[str, Any]:
    """Path -> speed of texts PATH=SPEED; that of a point has its components between commas."""
    found: dict[str, Any] = dict(pairs(texts, where, "links.OA=10 rad/s"))
    points = {path: text.split(",") for path, text in found.items() if path.startswith("points.")}
    return found | {path: [part.strip() for part in parts] for path, parts in points.items()}


def ranges(texts: Iterable[str], where: str, sample: str = "EC=-30 deg:90 deg") -> dict[str, tuple[str, str]]:
    """Name -> first and last value of texts NAME=FIRST:LAST; `sample` is what a refusal shows as right."""
    found = {}
    for name, value in pairs(texts, where, sample).items():
        first, sign, last = (part.strip() for part in value.partition(":"))
        if not sign or not first or not last:
            raise InputError(
                where,
                _("expected NAME=FIRST:LAST, got {text}").format(text=f'"{name}={value}"'),
                _("write {sample}").format(sample=f'"{sample}"'),
            )
        found[name] = (first, last)
    return found


def read_bounds(
    _mechanism: Mechanism, texts: Iterable[str], where: str
) -> dict[str, tuple[str | None, str | None]]:
    """Name -> least and greatest value of texts NAME=FIRST:LAST, of which one may be left out (None)."""
    sample = "stroke(slide_H)=1.5 m:"
    found: dict[str, tuple[str | None, str | None]] = {}
    for name, value in pairs(texts, where, sample).items():
        first, sign, last = (part.strip() for part in value.partition(":"))
        if not sign or not (first or last):
            what = _("expected NAME=FIRST:LAST, got {text}").format(text=f'"{name}={value}"')
            raise InputError(where, what, _("write {sample}").format(sample=f'"{sample}"'))
        found[name] = (first or None, last or None)
    return found


SCALE = "length=0.02"
"""A scale as it is written."""


def read_pairs(_mechanism: Mechanism, texts: Iterable[str], where: str) -> dict[str, str]:
    """Name -> value of texts NAME=VALUE."""
    return pairs(texts, where)


def read_ranges(_mechanism: Mechanism, texts: Iterable[str], where: str) -> dict[str, tuple[str, str]]:
    """Name -> first and last value of texts NAME=FIRST:LAST."""
    return ranges(texts, where)


def read_instant(mechanism: Mechanism, text: str, where: str) -> float:
    """A value of the drive [rad or m], or a time [s] where the drive is a law."""
    return mechanism.motion_parameter.instant.read(text, where)


def read_pairs_of_bodies(
    _mechanism: Mechanism | None, texts: Iterable[str], where: str
) -> list[tuple[str, str]]:
    """Pairs of bodies of texts LINK,LINK."""
    found = []
    for text in texts:
        first, comma, second = (part.strip() for part in text.partition(","))
        if not comma or not first or not second or "," in second:
            what = _("expected LINK,LINK, got {text}").format(text=f'"{text}"')
            raise InputError(where, what, _('write "AC,frame"'))
        found.append((first, second))
    return found


def read_instants(mechanism: Mechanism, texts: Iterable[str], where: str) -> list[float]:
    """Values of the drive [rad or m], or times [s] where the drive is a law."""
    return [mechanism.motion_parameter.instant.read(text, where) for text in texts]


def read_varied(_mechanism: Mechanism, texts: Iterable[str], where: str) -> dict[str, tuple[str, str] | None]:
    """Paths of numbers of texts PATH or PATH=LOW:HIGH, with their bounds where they have some."""
    texts = tuple(texts)
    bounds = ranges([text for text in texts if "=" in text], where)
    paths = [text.partition("=")[0].strip() for text in texts]
    for number, path in enumerate(paths):
        if path in paths[:number]:
            raise InputError(where, _("{name} is given twice").format(name=path), _("keep one of them"))
    return {path: bounds.get(path) for path in paths}


def read_scales(_mechanism: Mechanism, texts: Iterable[str], where: str) -> dict[str, float]:
    """Name -> number [SI by mm] of texts NAME=VALUE."""
    return {name: _plain_number(value, where) for name, value in pairs(texts, where, SCALE).items()}


def _plain_number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        what = _("expected a number, got {text}").format(text=f'"{text}"')
        raise InputError(where, what, _("write {sample}").format(sample=f'"{SCALE}"')) from None


# What the options of `centrode balance` mean as arguments of `ct.balance`.


def balance_arguments(given: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of `ct.balance` that the options say; InputError where they contradict each other."""
    arguments: dict[str, Any] = {
        "on": given["on"] or None,
        "to": _aim(given),
        "moment": given["moment"],
        "speed": "steady" if given["steady"] else "mean",
        "radius": _by_link(given["radius"], "--radius", "OA=50 mm"),
        "most": _by_link(given["most"], "--most", "OA=3 kg"),
        "thickness": given["thickness"],
    }
    if given["fraction"] is not None:
        arguments["fraction"] = given["fraction"]
    if given["density"] is not None:
        if given["thickness"] is None:
            raise InputError(
                "--density", _("this option is used with --thickness only"), _("give that option too")
            )
        arguments["density"] = given["density"]
    if given["weights"] is not None:
        if arguments["to"] != "least":
            raise InputError(
                "--weights", _("these options are used with --least-maximum only"), _("give that option too")
            )
        arguments["weights"] = [part.strip() for part in given["weights"].split(",")]
    if given["about"] is not None:
        arguments["about"] = _place(given["about"])
    return arguments


def _aim(given: Mapping[str, Any]) -> To:
    """What the balance is for; InputError where several aims are given."""
    aims = {
        "--full": given["full"],
        "--least-maximum": given["least_maximum"],
        "--fraction": given["fraction"] is not None,
    }
    named = [option for option, said in aims.items() if said]
    if len(named) > 1:
        what = _("{one} and {other} are given together").format(one=named[0], other=named[1])
        raise InputError(named[1], what, _("keep one of them"))
    if not named:
        return "full"
    kinds: dict[str, To] = {"--full": "full", "--least-maximum": "least", "--fraction": "fraction"}
    return kinds[named[0]]


def _by_link(texts: tuple[str, ...], where: str, sample: str) -> str | dict[str, str] | None:
    """One value for all, or values by link."""
    if not texts:
        return None
    if len(texts) == 1 and "=" not in texts[0]:
        return texts[0]
    return pairs(texts, where, sample)


def _place(text: str) -> str | tuple[float, float]:
    """A name, or two coordinates."""
    first, sign, second = text.partition(",")
    if not sign:
        return text
    try:
        return float(first), float(second)
    except ValueError:
        what = _("expected a point of the frame or two numbers, got {text}").format(text=f'"{text}"')
        raise InputError("--about", what, _("write {sample}").format(sample='"0.2,0.1"')) from None
