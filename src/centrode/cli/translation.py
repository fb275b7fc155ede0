"""The command line in the user's language: the `--lang` option, and help texts translated where they are shown."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import click

from centrode.locale import LANGUAGES, _, mark


def wished_language(arguments: Sequence[str]) -> str | None:
    """The last known language that `--lang` names, wherever it stands; unknown ones are left for click to refuse.

    It is read ahead of click because usage errors and help are printed while click still parses.
    """
    wish = None
    for place, argument in enumerate(arguments):
        if argument == "--":
            break
        flag, _sign, value = argument.partition("=")
        if flag == "--lang":
            value = value or next(iter(arguments[place + 1 :]), "")
            wish = value if value in LANGUAGES else wish
    return wish


def language_option() -> click.Option:
    """The option `--lang`, for the group and for every command; `wished_language` has acted on it already."""
    return click.Option(
        ["--lang"],
        type=click.Choice(LANGUAGES),
        expose_value=False,
        help=mark("Language of messages; that of the environment (LANG) by default."),
    )


def with_language(command: click.Command) -> click.Command:
    """A copy of the command that takes `--lang` too, after its own options."""
    speaking = copy.copy(command)
    speaking.params = [*command.params, language_option()]
    return speaking


def translate_command(command: click.Command) -> click.Command:
    """A copy of the command, its subcommands and parameters with every text in the chosen language."""
    spoken = copy.copy(command)
    spoken.help, spoken.epilog = _said(command.help), _said(command.epilog)
    spoken.short_help = spoken.help  # whole: click cuts off two letters more than its list of commands needs
    spoken.params = [_parameter(parameter) for parameter in command.params]
    spoken.options_metavar = _said(command.options_metavar)
    if isinstance(spoken, click.Group) and isinstance(command, click.Group):
        spoken.subcommand_metavar = _(command.subcommand_metavar)
        spoken.commands = {name: translate_command(child) for name, child in command.commands.items()}
    return spoken


def _parameter(parameter: click.Parameter) -> click.Parameter:
    spoken = copy.copy(parameter)
    spoken.type = _type(parameter.type)
    spoken.metavar = _said(parameter.metavar)
    if isinstance(spoken, click.Option | click.Argument):
        spoken.help = _said(spoken.help)
    return spoken


def _type(kind: click.ParamType[Any]) -> click.ParamType[Any]:
    """Click names its types in English: "integer", "float", "text" stand in help and in refusals."""
    spoken = copy.copy(kind)
    spoken.name = _(kind.name)
    return spoken


def _said(text: str | None) -> str | None:
    return text and _(text)
