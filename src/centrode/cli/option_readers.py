"""What the texts of options mean as arguments of computations: (mechanism, text or texts, "--name") -> value."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import centrode as ct
from centrode.analysis.instant_centres.results import read_pair
from centrode.cli.pairs import pairs, ranges
from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism


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
    return ct.range_value(mechanism, text, where)


def read_pairs_of_bodies(mechanism: Mechanism, texts: Iterable[str], where: str) -> list[tuple[str, str]]:
    """Pairs of bodies of texts LINK,LINK."""
    return [read_pair(mechanism, text, where) for text in texts]


def read_instants(mechanism: Mechanism, texts: Iterable[str], where: str) -> list[float]:
    """Values of the drive [rad or m], or times [s] where the drive is a law."""
    return [ct.range_value(mechanism, text, where) for text in texts]


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
