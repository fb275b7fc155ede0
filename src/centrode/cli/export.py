"""`centrode export`: a mechanism for another program."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import click

import centrode as ct
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.cli.arguments import mechanism_argument, start_option, stop_option
from centrode.errors import InputError
from centrode.locale import _, mark

LANGUAGES = ("c", "python", "matlab", "javascript")
"""Kinds that are source files."""
ROBOTS = ("urdf", "sdf")
"""Kinds that have a file of loops beside them."""
KINDS = ("mjcf", *ROBOTS, "fmu", "freecad", *LANGUAGES)


@click.command(help=mark("Write a mechanism for another program."))
@mechanism_argument
@click.option(
    "--format",
    "formats",
    type=click.Choice(KINDS),
    multiple=True,
    help=mark(
        "mjcf (default): a model for MuJoCo, its loops closed by constraints. urdf, sdf: models for ROS and Gazebo, "
        "with a file FILE.loops.json beside FILE. fmu: co-simulation and model exchange (FMI 3.0), for Simulink and "
        "others. freecad: a macro with a sketch and moving bars. c, python, matlab, javascript: a source file that "
        "computes the motion from the drive and from dimensions."
    ),
)
@click.option("--c", is_flag=True, help=mark("The same as --format c."))
@click.option("--python", is_flag=True, help=mark("The same as --format python."))
@click.option("--matlab", is_flag=True, help=mark("The same as --format matlab; for Octave too."))
@click.option("--javascript", is_flag=True, help=mark("The same as --format javascript."))
@click.option(
    "--vary",
    multiple=True,
    metavar=mark("PATH"),
    help=mark(
        'A dimension that a source file takes ("links.AB.length"); may be repeated. By default all lengths and the '
        "places of joints."
    ),
)
@click.option(
    "--free",
    is_flag=True,
    help=mark("mjcf: without drives; masses, springs, dampers and constant loads move the model."),
)
@click.option(
    "--driven",
    is_flag=True,
    help=mark("fmu: the drive's value, speed and acceleration are inputs; by default its moment is one."),
)
@click.option(
    "--output",
    "outputs",
    multiple=True,
    metavar=mark("NAME"),
    help=mark(
        'fmu: a variable that it gives ("position B x", "angle AB"); may be repeated. All of them by default.'
    ),
)
@click.option(
    "--compile",
    "compiled",
    is_flag=True,
    help=mark("fmu: with a binary for this machine, by its C compiler."),
)
@start_option
@stop_option
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar=mark("FILE"),
    help=mark("Write FILE instead of printing."),
)
@click.option("--force", is_flag=True, help=mark("Replace FILE where it exists."))
def export(
    mechanism: str,
    formats: tuple[str, ...],
    vary: tuple[str, ...],
    free: bool,
    driven: bool,
    outputs: tuple[str, ...],
    compiled: bool,
    start: str | None,
    stop: str | None,
    out: Path | None,
    force: bool,
    **languages: bool,
) -> None:
    """Print or write the mechanism as another program reads it."""
    kind = _kind(formats, languages)
    beside: dict[Path, str] = {}
    if free and kind != "mjcf":
        raise InputError("--free", _("only a model for MuJoCo is left to its loads"), _("add --format mjcf"))
    options: dict[str, Any] = {"vary": list(vary) or None, "start": start, "stop": stop}
    if kind != "fmu" and (driven or outputs or compiled):
        raise InputError(
            "--format", _("--driven, --output and --compile belong to an FMU"), _("add --format fmu")
        )
    description = library.load(mechanism)
    if kind == "fmu":
        options["outputs"], options["driven"] = list(outputs) or None, driven
        _write_fmu(description, mechanism, out, options, compiled=compiled, force=force)
        return
    if kind in LANGUAGES:
        with about(mechanism):
            text = _source_file(description, kind, mechanism, out, options)
    else:
        _refuse_options(kind, options)
        with about(mechanism):
            if kind == "freecad":
                text = library.freecad_macro(description)
            elif kind in ROBOTS:
                model = getattr(library, f"{kind}_model")(description)
                text = model.text
                if out is not None:
                    beside[out.with_name(f"{out.stem}.loops.json")] = model.loops
            else:
                first = ct.motion(description, at=[library.initial_place(description)])
                text = library.mjcf_text(description, first, free=free)
                _tell_omitted(library.omitted_loads(description, first))
    if out is None:
        click.echo(text, nl=False)
        return
    files = {out: text} | beside
    with ExitStack() as drafts:
        # all of them or none
        for path, content in files.items():
            draft = drafts.enter_context(output.output_file(path, force=force))
            draft.write_text(content, encoding="utf-8", newline="\n")
    click.echo(output.wrote(list(files)))


def _kind(formats: tuple[str, ...], languages: Mapping[str, bool]) -> str:
    """The one format that is requested; InputError where several are, as one file is written."""
    # in the order of the help, as click does not tell that of the command line
    named = {f"--format {kind}": kind for kind in formats}
    named |= {f"--{kind}": kind for kind in LANGUAGES if languages[kind]}
    kinds = list(dict.fromkeys(named.values()))
    if len(kinds) > 1:
        first, second = (next(option for option, kind in named.items() if kind == one) for one in kinds[:2])
        what = _("{one} and {other} are given together").format(one=first, other=second)
        raise InputError("--format", what, _("one format is written at a time: keep one of them"))
    return kinds[0] if kinds else "mjcf"


def _source_file(
    description: ct.Mechanism, kind: str, source: str, out: Path | None, options: dict[str, Any]
) -> str:
    """The source file of a language, called as the file that it goes to."""
    name = library.program_name(source if out is None else out.name)
    if out is not None and kind == "matlab" and name != out.stem:
        what = _("MATLAB finds functions by the names of their files, and {stem} is no name of a function")
        raise InputError("--out", what.format(stem=out.stem), _("call it {name}").format(name=f"{name}.m"))
    text: str = library.motion_code(description, kind, name=name, **options)
    return text


def _write_fmu(
    description: ct.Mechanism,
    source: str,
    out: Path | None,
    options: dict[str, Any],
    *,
    compiled: bool,
    force: bool,
) -> None:
    """Write an FMU, with a binary if it is to have one."""
    if out is None or out.suffix.lower() != ".fmu":
        raise InputError("--out", _("an FMU is an archive"), _("name a file FILE.fmu"))
    with about(source):
        fmu = library.fmu_program(description, name=library.program_name(out.name), **options)
        binaries = library.fmu_binaries(fmu) if compiled else {}
    with output.output_file(out, force=force) as draft:
        draft.write_bytes(fmu.archive(binaries))
    click.echo(output.wrote([out]))


def _tell_omitted(omitted: Mapping[str, str]) -> None:
    """A line that names the loads that a model does not hold, and why."""
    if omitted:
        loads = ", ".join(f"{label} ({reason})" for label, reason in omitted.items())
        output.tell(_("not in the model: {loads}").format(loads=loads))


def _refuse_options(kind: str, options: dict[str, Any]) -> None:
    for option, word in (("vary", "--vary"), ("start", "--from"), ("stop", "--to")):
        if options[option] is not None:
            what = _("{option} belongs to source files and FMUs, and {kind} is none").format(
                option=word, kind=kind
            )
            raise InputError(word, what, _("remove it"))
