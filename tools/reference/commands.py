"""The page of the command line: what `--help` prints for every command."""

from __future__ import annotations

import click

from centrode.cli.main import build_app
from centrode.locale import choose_language

WIDTH = 100
HEAD = """# Commands

What `centrode COMMAND --help` prints, for every command. `--lang ru` and `--lang uk` say it in Russian and Ukrainian.
Exit codes: 0, all is done; 2, the input is wrong; 3, the mechanism cannot do what was asked (what could be computed is
written); 130, interrupted. [Results](../results.md) says what the files hold.
"""


def page() -> str:
    """The page as Markdown."""
    choose_language("en")
    app = build_app()
    parts = [HEAD, *_helps(app, "centrode")]
    return "\n".join(parts)


def _helps(command: click.Command, path: str) -> list[str]:
    """The help of a command, then of those below it."""
    context = click.Context(command, info_name=path, terminal_width=WIDTH, max_content_width=WIDTH)
    text = "\n".join(line.rstrip() for line in command.get_help(context).splitlines())
    found = [f"## {path}\n\n```text\n{text}\n```\n"]
    for name in sorted(getattr(command, "commands", {})):
        found += _helps(command.commands[name], f"{path} {name}")  # type: ignore[attr-defined]
    return found
