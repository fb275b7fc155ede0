"""Options of the form NAME=VALUE."""

from __future__ import annotations

from collections.abc import Iterable

from centrode.errors import InputError
from centrode.locale import _


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


def ranges(texts: Iterable[str], where: str) -> dict[str, tuple[str, str]]:
    """Name -> first and last value of texts NAME=FIRST:LAST."""
    found = {}
    for name, value in pairs(texts, where).items():
        first, sign, last = (part.strip() for part in value.partition(":"))
        if not sign or not first or not last:
            raise InputError(
                where,
                _("expected NAME=FIRST:LAST, got {text}").format(text=f'"{name}={value}"'),
                _('write "EC=-30 deg:90 deg"'),
            )
        found[name] = (first, last)
    return found
