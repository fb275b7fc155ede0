"""The pages of the command line: what `--help` prints for every command, the commands of one task on a page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import click

from centrode.cli.main import build_app
from centrode.locale import choose_language

WIDTH = 100
PAGES: Mapping[str, tuple[str, tuple[str, ...]]] = MappingProxyType(
    {
        "commands-first": (
            "Commands for files and documents",
            ("run", "report", "page", "animate", "draw", "export", "check", "describe", "examples", "schema"),
        ),
        "commands-kinematics": (
            "Commands of kinematics",
            (
                "equations", "integrate", "rotatability", "limits", "region",
                "centres", "centrodes", "diagrams", "plan", "angles",
            ),
        ),
        "commands-forces": (
            "Commands of forces and motion under load",
            ("reduce", "reactions", "polygons", "flywheel", "simulate", "equilibrium", "modes", "balance"),
        ),
        "commands-cams-and-many": (
            "Commands of cams, synthesis and many mechanisms",
            ("cam", "synthesise", "improve", "variants", "sweep"),
        ),
    }
)  # fmt: skip
"""Pages of commands: file -> title, commands. A command that none of them names stands at the end of the last."""
HEAD = """# Commands

What `centrode COMMAND --help` prints, for every command; `--lang ru` and `--lang uk` print it in Russian and
Ukrainian. Exit codes: 0, all is done; 2, the input is wrong; 3, the mechanism cannot do what was requested (what could
be computed is written); 130, interrupted. [Results](../results.md) explains the files, [errors and their
repair](../errors.md) the messages.
"""


def page() -> str:
    """The page of the program itself, with links to those of its commands."""
    app = _app()
    rows = [
        f"| [{PAGES[name][0]}]({name}.md) | {', '.join(f'[{one}]({name}.md#centrode-{one})' for one in commands)} |"
        for name, commands in _dealt(app).items()
    ]
    return "\n".join([HEAD, "| page | commands |", "|---|---|", *rows, "", _help(app, "centrode")])


def page_of(name: str) -> str:
    """The page of a task: the help of its commands."""
    app = _app()
    parts = (part for one in _dealt(app)[name] for part in _helps(app.commands[one], f"centrode {one}"))
    return "\n".join([f"# {PAGES[name][0]}\n", *parts])


def _app() -> click.Group:
    """The program in English."""
    choose_language("en")
    app = build_app()
    assert isinstance(app, click.Group)
    return app


def _dealt(app: click.Group) -> dict[str, tuple[str, ...]]:
    """The commands of each page; new ones behind all."""
    pages = {name: commands for name, (_title, commands) in PAGES.items()}
    last = next(reversed(pages))
    pages[last] += tuple(sorted(set(app.commands).difference(*pages.values())))
    return pages


def _helps(command: click.Command, path: str) -> Iterator[str]:
    """The help of a command, then of those below it."""
    yield _help(command, path)
    for name, child in sorted(getattr(command, "commands", {}).items()):
        yield from _helps(child, f"{path} {name}")


def _help(command: click.Command, path: str) -> str:
    context = click.Context(command, info_name=path, terminal_width=WIDTH, max_content_width=WIDTH)
    text = "\n".join(line.rstrip() for line in command.get_help(context).splitlines())
    return f"## {path}\n\n```text\n{text}\n```\n"
