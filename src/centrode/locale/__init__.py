"""The languages centrode speaks: gettext catalogues and the choice among them."""

from __future__ import annotations

import gettext
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from operator import index
from pathlib import Path
from typing import SupportsIndex

from centrode.errors import InputError

DOMAIN = "centrode"
LANGUAGES = ("en", "ru", "uk")
DIRECTORY = Path(__file__).parent
MANY = 5
"""A number that takes the form of many in every language spoken."""

AS_WRITTEN: Mapping[str, str] = {}
"""No sentence is said otherwise than it is written."""

_catalogue: gettext.NullTranslations = gettext.NullTranslations()
_versions: Mapping[str, str] = AS_WRITTEN


def _(message: str) -> str:
    """The sentence in the chosen language; the English text is its name."""
    return _catalogue.gettext(_versions.get(message, message)) if message else ""


@contextmanager
def speaking(language: str, versions: Mapping[str, str] = AS_WRITTEN) -> Iterator[None]:
    """Speak another language for a while: what results keep is English, whoever computes them.

    `versions` has other sentences in place of some, for readers at whose hand is something else than a terminal.
    """
    global _catalogue, _versions
    before = _catalogue, _versions
    choose_language(language)
    _versions = versions
    try:
        yield
    finally:
        _catalogue, _versions = before


def ngettext(singular: str, plural: str, number: object) -> str:
    """The sentence in the grammatical number that `number` asks for in the chosen language.

    What is no whole number, as somebody may give it in Python, takes the plural.
    """
    # whole numbers of numpy are none of Python's, and gettext takes only these; a truth value counts nothing
    whole = index(number) if isinstance(number, SupportsIndex) and not isinstance(number, bool) else MANY
    return _catalogue.ngettext(_versions.get(singular, singular), _versions.get(plural, plural), whole)


def chosen_language() -> str:
    """The language that is spoken now."""
    told = _catalogue.info().get("language", "en")
    return told if told in LANGUAGES else "en"


def decimal_mark() -> str:
    """What stands before decimals in the chosen language."""
    return "." if chosen_language() == "en" else ","


def coordinate_separator() -> str:
    """What parts coordinates: a comma, but a semicolon where a comma stands before decimals."""
    return ", " if decimal_mark() == "." else "; "


def mark(message: str) -> str:
    """Mark a sentence for the catalogues where it is written down, to be translated where it is shown."""
    return message


def language_of(environment: Mapping[str, str]) -> str:
    """Language that the environment asks for (LANGUAGE, LC_ALL, LC_MESSAGES, LANG in gettext's order), else English."""
    for name in ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"):
        for wish in environment.get(name, "").split(":"):
            code = re.split(r"[._@-]", wish)[0].lower()
            if code in LANGUAGES:
                return code
            if code in ("c", "posix"):
                return "en"
    return "en"


def choose_language(language: str | None = None) -> str:
    """Speak `language` ("en", "ru" or "uk") from now on; None follows the environment. Returns the choice.

    Raises InputError for a language without a catalogue.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.choose_language("uk")
    'uk'
    >>> print(ct.summary(ct.limits(ct.example("crank-rocker"))).splitlines()[-1])
    точки розгалуження  немає
    >>> ct.choose_language("en")
    'en'
    """
    global _catalogue
    if language is not None and language not in LANGUAGES:
        raise InputError(
            "",
            _("language {language!r} is not one of {known}").format(
                language=language, known=", ".join(LANGUAGES)
            ),
        )
    chosen = language or language_of(os.environ)
    _catalogue = _catalogue_of(chosen)
    return chosen


@cache
def _catalogue_of(language: str) -> gettext.NullTranslations:
    # gettext looks for the file each time, though it keeps what it has read
    return gettext.translation(DOMAIN, DIRECTORY, languages=[language], fallback=True)


def choose_language_of_process(language: str | None = None) -> str:
    """`choose_language`, and the same for libraries that ask the standard library for translations (click does).

    For programs only: it sets LANGUAGE in the environment, the one place where gettext's own functions look.
    """
    chosen = choose_language(language)
    os.environ["LANGUAGE"] = chosen
    gettext.bindtextdomain(DOMAIN, DIRECTORY)
    gettext.textdomain(DOMAIN)
    return chosen
