"""The page of the public face: its names in reading order, each with what its docstring says."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import centrode as ct

FACE = Path(ct.__file__).with_name("__init__.pyi")
GROUP = re.compile(r"^# (?P<title>.+)$|^from \S+ import \w+ as (?P<name>\w+)$", re.MULTILINE)
HEAD = """# From Python

The public names of centrode in reading order, `import centrode as ct`. What its functions return is
[a result](../results.md#a-dataset-is-a-result): `ct.summary`, `ct.tables`, `ct.figures` and `ct.write` show it.
What else the package computes stands in its modules: pages name the place, and the changelog says where each name
is that was public once.
"""


def page() -> str:
    """The page as Markdown."""
    groups = list(_groups())
    contents = [f"| {title} | {', '.join(f'`ct.{name}`' for name in names)} |" for title, names in groups]
    parts = [HEAD, "\n".join(["| about | names |", "|---|---|", *contents]) + "\n"]
    for title, names in groups:
        parts += [f"## {title}\n", *map(_entry, names)]
    return "\n".join(parts)


def _groups() -> Iterator[tuple[str, list[str]]]:
    """Titles of the stub file with the names under each; its first line is a comment on the file."""
    found: list[tuple[str, list[str]]] = []
    for line in GROUP.finditer(FACE.read_text(encoding="utf-8")):
        if line["name"] is not None:
            found[-1][1].append(line["name"])
        else:
            found.append((line["title"], []))
    return (group for group in found if group[1])


def _entry(name: str) -> str:
    """A name with its parameters and its docstring."""
    public = getattr(ct, name)
    return f"### {name}\n\n```text\nct.{name}{_parameters(public)}\n\n{inspect.getdoc(public)}\n```\n"


def _parameters(public: object) -> str:
    """The parameters of a function with their defaults; of a class nothing, as its docstring lists attributes."""
    if inspect.isclass(public) or not callable(public):
        return ""
    parts = []
    for parameter in inspect.signature(public).parameters.values():
        plain = parameter.replace(annotation=inspect.Parameter.empty)
        # a function in a signature is written with its address
        shown = (
            f"{plain.name}=..."
            if callable(plain.default) and plain.default is not plain.empty
            else str(plain)
        )
        if plain.kind is plain.KEYWORD_ONLY and "*" not in parts:
            parts.append("*")
        parts.append(shown)
    return f"({', '.join(parts)})"
