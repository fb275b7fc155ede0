"""A mechanism by the name of a file or of a built-in example."""

from __future__ import annotations

from pathlib import Path

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples import example_names, example_text
from centrode.model.files import parse_mechanism, read_mechanism
from centrode.model.mechanism import Mechanism
from centrode.model.problems import likely, shown


def example(name: str) -> Mechanism:
    """The built-in mechanism of a name; InputError if there is none."""
    return parse_mechanism(example_text(name), f"{name}.toml")


def load(file_or_example: str | Path) -> Mechanism:
    """The mechanism in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description.
    """
    path = Path(file_or_example)
    name = str(file_or_example)
    if path.suffix == ".toml" or path.name != name or path.exists():
        return read_mechanism(path)
    if name in example_names():
        return example(name)
    near = likely(name, example_names())
    raise InputError(
        shown(name)[1:-1],
        _("no such file, and no built-in mechanism of this name"),
        near or _("give a TOML file, or a name that centrode examples lists"),
    )
