"""Command lines drawn at random from what the program itself says of its commands and their options."""

from __future__ import annotations

import random
from collections.abc import Iterator

import click

from centrode.cli.main import build_app
from tools.campaigns.commands.inputs import formula

WORDS = (
    *(
        "0",
        "1",
        "-1",
        "7",
        "0.5",
        "1e9",
        "1e-9",
        "nan",
        "inf",
        "-inf",
        "",
        " ",
        "90 deg",
        "1 s",
        "2",
        "3 kg",
        "pi",
    ),
    *(
        "A",
        "B",
        "O",
        "OA",
        "AB",
        "frame",
        "A,B",
        "OA,AB",
        "OA=1",
        "OA=90 deg",
        "OA=0:1",
        "0:1",
        "a=b=c",
        "links.OA.length",
    ),
    *(
        "velocities",
        "centres",
        "forces",
        "a4",
        "html",
        "pdf",
        "html,pdf",
        "800x600",
        "9x9",
        "100000x100000",
        "all",
    ),
    *(
        "漢😀",
        "[bold]",
        "{0}",
        "%s",
        "../up",
        "-x",
        "--",
        "t",
        "10 - 2*sign(omega)",
        "t**100",
        "1/0",
        "9**9**9",
    ),
)
WHOLE = (
    "0",
    "1",
    "2",
    "3",
    "7",
    "13",
    "-1",
    "1000000",
    "200001",
    "1000000000",
    "99999999999999999999",
    "x",
    "1.5",
    "",
)
REAL = ("0", "1", "0.1", "-1", "1e-9", "1e9", "nan", "inf", "x", "")
PLACES = (
    *(
        "result",
        "result",
        "result.svg",
        "result.csv",
        "result.html",
        "result.pdf",
        "result.gif",
        "result.zarr",
    ),
    *(
        "result.dxf",
        "result.xml",
        "new/result",
        ".",
        "x" * 300,
        "taken",
        "taken/file",
        "result.mp4",
    ),
)
KINDS = {"cam": ("cam",), "study": ("study",), "table": ("table",), "name": ("name",)}
"""What an argument takes, by its name; any other takes a mechanism, and where it is a description a cam as well."""
BOTH = ("description", "described")
LIKELY = ("driving", "repair", "steady", "full", "least", "duration", "laws")
"""Options that are drawn more often: much of what the command does hangs on them."""
SMALL = {"samples": "7", "frames": "3", "steps": "20", "duration": "1", "turns": "1"}
"""What keeps a command short that is not meant to be long."""


def commands(
    command: click.Command | None = None, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """All commands with the words that call them."""
    command = build_app() if command is None else command
    if isinstance(command, click.Group):
        for name, child in command.commands.items():
            yield from commands(child, (*path, name))
    else:
        yield path, command


def takes(command: click.Command) -> str | None:
    """What kind of file a command takes; None if none."""
    for parameter in command.params:
        if isinstance(parameter, click.Argument):
            return KINDS.get(parameter.name or "", ("linkage",))[0]
    return None


def takes_both(command: click.Command) -> bool:
    """Whether a command takes mechanisms and cams alike."""
    return any(isinstance(one, click.Argument) and one.name in BOTH for one in command.params)


def words_of(draw: random.Random, command: click.Command, file: str, names: list[str]) -> list[str]:
    """Arguments and options of a command. Most lines are such as somebody may type; others take what comes."""
    wild = draw.random() < 0.3
    words: list[str] = []
    for parameter in command.params:
        if isinstance(parameter, click.Argument):
            words.append(draw.choice(WORDS) if wild and draw.random() < 0.1 else file)
        elif isinstance(parameter, click.Option):
            words += (
                wild_option(draw, parameter, file, names) if wild else option(draw, parameter, file, names)
            )
    if wild and draw.random() < 0.1:
        words.insert(
            draw.randrange(len(words) + 1), draw.choice(("--unknown", "extra", "--help", "-h", "--lang"))
        )
    return words


def option(draw: random.Random, option: click.Option, file: str, names: list[str]) -> list[str]:
    """An option that may be left out, with a value that may be meant."""
    name = option.opts[0]
    if option.name in SMALL and draw.random() < 0.9:
        return [name, SMALL[option.name]]
    if option.name == "no_figures" and draw.random() < 0.9:
        return [name]
    often = dict.fromkeys(LIKELY, 0.3) | {"out": 0.6, "force": 0.3, "mjcf": 0.8}
    if draw.random() >= (0.95 if option.required else often.get(option.name or "", 0.04)):
        return []
    if option.is_flag:
        return [name]
    match option.type:
        case click.Choice():
            return [name, str(draw.choice(list(option.type.choices)))]
        case click.Path():
            return [name, draw.choice(("result", "result", "result", ".", file, *PLACES))]
        case _ if isinstance(option.type, type(click.INT)):
            return [name, draw.choice(("2", "3", "7", "13"))]
        case _ if isinstance(option.type, type(click.FLOAT)):
            return [name, draw.choice(("0.5", "1", "2"))]
    if option.name == "driving":
        return [name, formula(draw)]
    return [name, draw.choice((*draw.choices(names, k=3), "1", "90 deg", "0.5"))]


def wild_option(draw: random.Random, option: click.Option, file: str, names: list[str]) -> list[str]:
    """An option with a value of its kind or of another."""
    name = option.opts[0]
    if draw.random() < (0.5 if option.name in ("out", "force") else 0.8):
        return []
    if option.is_flag:
        return [name]
    if draw.random() < 0.1:
        return [name, draw.choice(WORDS)]
    match option.type:
        case click.Path():
            return [name, draw.choice((file, *PLACES))]
        case _ if isinstance(option.type, type(click.INT)):
            return [name, draw.choice(WHOLE)]
        case _ if isinstance(option.type, type(click.FLOAT)):
            return [name, draw.choice(REAL)]
    if draw.random() < 0.5:
        return [
            name,
            draw.choice((",", "=", ":", "-")).join(draw.choices(names, k=draw.choice((1, 1, 1, 2)))),
        ]
    return [name, draw.choice(WORDS)]
