"""Letters of different alphabets that look alike: names that a reader takes for one, and the program for two."""

from __future__ import annotations

import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence

from centrode.locale import _, ngettext

_CYRILLIC = "АВСЕНКМОРТХУІЈЅасеорхуіјѕ"
_LATIN_OF_CYRILLIC = "ABCEHKMOPTXYIJSaceopxyijs"
_GREEK = "ΑΒΕΖΗΙΚΜΝΟΡΤΥΧον"
_LATIN_OF_GREEK = "ABEZHIKMNOPTYXov"
_LATIN = str.maketrans(_CYRILLIC + _GREEK, _LATIN_OF_CYRILLIC + _LATIN_OF_GREEK)


def in_latin(name: str) -> str:
    """A name with Latin letters in place of those that look like them: the same for names that look alike."""
    return name.translate(_LATIN)


def look_alike(name: str, names: Iterable[str]) -> str | None:
    """The first of `names` that looks like a name, but is written with other letters."""
    looks = in_latin(name)
    return next((other for other in names if other != name and in_latin(other) == looks), None)


def look_alike_pairs(names: Iterable[str]) -> list[tuple[str, str]]:
    """Names that look like others, each with such another: first the one of the rarer alphabet."""
    names = list(names)
    by_looks: dict[str, list[str]] = defaultdict(list)
    for name in names:
        by_looks[in_latin(name)].append(name)
    frequency = Counter(_alphabet(letter) for name in names for letter in name if letter.isalpha())
    pairs = []
    for alike in by_looks.values():
        common = max(alike, key=lambda name: sum(frequency[_alphabet(letter)] for letter in name))
        pairs += [(name, common) for name in alike if name != common]
    return pairs


def letters_note(name: str, pairs: Sequence[tuple[str, str]]) -> str:
    """The sentence that says in which letters a name differs from others: those of pairs of look-alikes."""
    letters, others = _letters(pairs)
    return _(
        "{name} is written with {letters}, the other names with {others}: type it with one keyboard layout"
    ).format(name=name, letters=letters, others=others)


def likeness_note(name: str, other: str) -> str:
    """The sentence that says in which letters a name differs from one that looks like it, whichever is mistyped."""
    letters, others = _letters([(name, other)])
    return _(
        "{name} is written with {letters}, {other}, which looks the same, with {others}: "
        "type both with one keyboard layout"
    ).format(name=name, other=other, letters=letters, others=others)


def _letters(pairs: Sequence[tuple[str, str]]) -> tuple[str, str]:
    """The letters in which names differ from others, with their alphabet, and the alphabet of the others."""
    apart = dict(
        (letter, other)
        for odd, common in pairs
        for letter, other in zip(odd, common, strict=True)
        if letter != other
    )
    written = {
        "CYRILLIC": ngettext("the Cyrillic letter {letters}", "the Cyrillic letters {letters}", len(apart)),
        "GREEK": ngettext("the Greek letter {letters}", "the Greek letters {letters}", len(apart)),
        "LATIN": ngettext("the Latin letter {letters}", "the Latin letters {letters}", len(apart)),
    }
    others = {"CYRILLIC": _("Cyrillic ones"), "GREEK": _("Greek ones"), "LATIN": _("Latin ones")}
    first, second = next(iter(apart.items()))
    return written[_alphabet(first)].format(letters=", ".join(apart)), others[_alphabet(second)]


def _alphabet(letter: str) -> str:
    return unicodedata.name(letter, "").partition(" ")[0]
