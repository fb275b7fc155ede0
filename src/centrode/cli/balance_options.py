"""What the options of `centrode balance` mean as arguments of `ct.balance`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from centrode.cli.pairs import pairs
from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.dynamics.balancing.balance import To


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
            raise InputError("--density", _("it belongs to --thickness"), _("give that too"))
        arguments["density"] = given["density"]
    if given["weights"] is not None:
        if arguments["to"] != "least":
            raise InputError("--weights", _("they belong to --least-maximum"), _("say that too"))
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
