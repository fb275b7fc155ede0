"""The pages of the public face: its names in reading order, each with what its docstring says."""

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


MOST_LINES = 360
"""Of entries on a page: with its head it stays below what tests allow."""


def pages() -> dict[str, str]:
    """The pages as Markdown by name: all names with the page of each, then the entries group by group."""
    rows, texts = [], {}
    for title, names in _groups():
        parts = list(_parts(names))
        for number, part in enumerate(parts, start=1):
            page = f"python-{_slug(title)}" + (f"-{number}" if len(parts) > 1 else "")
            heading = title + (f" ({number})" if len(parts) > 1 else "")
            links = ", ".join(f"[`ct.{name}`]({page}.md#{name.lower()})" for name in part)
            rows.append(f"| [{heading}]({page}.md) | {links} |")
            texts[page] = "\n".join([f"# {heading}\n", *map(_entry, part)])
    return {"python": "\n".join([HEAD, "| about | names |", "|---|---|", *rows]) + "\n", **texts}


def _parts(names: list[str]) -> Iterator[list[str]]:
    """Names of a group, dealt to as few pages as hold their entries."""
    part: list[str] = []
    lines = 0
    for name in names:
        more = _entry(name).count("\n") + 1
        if part and lines + more > MOST_LINES:
            yield part
            part, lines = [], 0
        part.append(name)
        lines += more
    yield part


def _slug(title: str) -> str:
    """The name of a group in the name of a file: its first noun."""
    return re.sub(r"\W+", "-", re.sub(r"^(The|Any) ", "", title).partition(",")[0].lower()).strip("-")


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
    return f"## {name}\n\n```text\nct.{name}{_parameters(public)}\n\n{inspect.getdoc(public)}\n```\n"


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
