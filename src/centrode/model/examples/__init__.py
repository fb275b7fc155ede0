"""The built-in mechanisms: TOML files beside this one, each with its source and the facts to look at."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from centrode.errors import InputError
from centrode.locale import _

DIRECTORY = Path(__file__).parent


def example_names() -> tuple[str, ...]:
    """Names of the built-in mechanisms, sorted."""
    return tuple(sorted(path.stem for path in DIRECTORY.glob("*.toml")))


def example_text(name: str) -> str:
    """The TOML text of a built-in mechanism.

    Raises InputError if there is none of this name.
    """
    names = example_names()
    if name not in names:
        near = get_close_matches(name, names, n=1)
        repair = (
            _('did you mean "{name}"?').format(name=near[0])
            if near
            else _("list them with: centrode examples")
        )
        raise InputError("", _('there is no built-in mechanism called "{name}"').format(name=name), repair)
    return (DIRECTORY / f"{name}.toml").read_text(encoding="utf-8")
