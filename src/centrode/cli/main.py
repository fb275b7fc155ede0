"""The command line: one group of commands, and how every failure ends.

Exit codes: 0 done; 2 wrong input or usage; 3 the mechanism cannot do what was asked; 70 a fault of centrode;
130 interrupted (Ctrl-C, SIGTERM); 141 the reader of the output went away.
"""

from __future__ import annotations

import _thread
import gc
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

import click

import centrode as ct
from centrode.cli import output
from centrode.cli.animate import animate
from centrode.cli.app import app as workbench
from centrode.cli.cam import cam
from centrode.cli.chains import chains
from centrode.cli.draw import draw
from centrode.cli.examples import examples
from centrode.cli.export import export
from centrode.cli.gears import gears
from centrode.cli.imports import import_drawing
from centrode.cli.page import page
from centrode.cli.report import report
from centrode.cli.schema import schema
from centrode.cli.sheets import sheets
from centrode.cli.sweep import sweep
from centrode.cli.synthesise import synthesise
from centrode.cli.topic_command import topic_command
from centrode.cli.trains import trains
from centrode.cli.translation import language_option, translate_command, wished_language, with_language
from centrode.cli.variants import variants
from centrode.errors import CentrodeError
from centrode.files.inputs import guard_inputs
from centrode.interruption import INTERRUPTED, end_at_interruption, raise_at_interruption
from centrode.locale import _, choose_language_of_process, mark
from centrode.optional_packages import held_back
from centrode.topics import order
from centrode.topics.order import in_order
from centrode.topics.registry import TOPICS

COLLECTION = (50_000, 50, 100)
"""Objects after which cycles among them are looked for, in each generation; Python's 700 cost a command a twentieth."""
OWN: tuple[click.Command, ...] = (
    report,
    page,
    workbench,
    animate,
    variants,
    cam,
    gears,
    trains,
    synthesise,
    sweep,
    draw,
    sheets,
    export,
    import_drawing,
    chains,
    examples,
    schema,
)
COMMANDS: tuple[click.Command, ...] = tuple(
    in_order(
        {
            **{str(command.name): command for command in OWN},
            **{
                topic.name: topic_command(topic, topic.command)
                for topic in TOPICS
                if topic.command is not None and topic.subject == "mechanism"
            },
        },
        order.COMMANDS,
    ).values()
)
"""Those of the topics among the others, in the order that `centrode --help` lists them."""

FAULT, READER_GONE = 70, 141


class ReadingOrder(click.Group):
    """A group that lists its commands in the order they were given."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of the commands, unsorted."""
        return list(self.commands)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is named; who names a file in its place is told where the command goes."""
        if args[0] not in self.commands and (args[0].endswith(".toml") or os.path.isfile(args[0])):
            ctx.fail(_("a command goes before the file: centrode check {file}").format(file=args[0]))
        return super().resolve_command(ctx, args)


def build_app() -> click.Command:
    """The command line in the language chosen at the moment."""
    app = ReadingOrder(
        "centrode",
        help=mark("Compute mechanisms: from the description of a linkage to its checked motion."),
        epilog=mark("A first step: centrode run slider-between-cranks --out result"),
        params=[language_option()],
        no_args_is_help=True,
    )
    click.version_option(ct.__version__, prog_name="centrode")(app)
    for command in COMMANDS:
        app.add_command(with_language(command))
    return translate_command(app)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; every failure ends in a message, none in a traceback."""
    # where another program calls this, the process and its libraries are not ours
    ours = arguments is None
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    for stream in (sys.stdout, sys.stderr):
        # A terminal without Cyrillic shows question marks instead of failing.
        reconfigure: Callable[..., Any] | None = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="replace")
    try:
        raise_at_interruption()
        choose_language_of_process(wished_language(arguments))
        # xarray imports dask and pint at its first array, which takes a short command a fifth of its time; workers
        # admit the one, units of a text the other
        with (
            _no_interruption_lost(ours),
            _termination_as_interruption(),
            _rare_collection(),
            _only_what_is_needed(ours),
        ):
            result = _run(build_app(), list(arguments))
            if sys.stdout is not None:
                sys.stdout.flush()
    except BaseException as failure:
        return _ending(failure)
    finally:
        if ours:
            end_at_interruption()
        _drop_unwritable_output()
    return result if isinstance(result, int) else 0


@contextmanager
def _termination_as_interruption() -> Iterator[None]:
    """While the block runs, SIGTERM interrupts it as Ctrl-C does, so that no draft is left."""
    # Other threads cannot set a handler; a handler that is set, or a signal that is ignored, belongs to who runs this.
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


@contextmanager
def _no_interruption_lost(ours: bool) -> Iterator[None]:
    """Interrupt once more where Ctrl-C comes to a place that Python goes on behind, such as the end of an import."""
    if not ours:
        yield
        return
    before = sys.unraisablehook

    def interrupt_again(ignored: sys.UnraisableHookArgs) -> None:
        if issubclass(ignored.exc_type, KeyboardInterrupt):
            # from another thread, once this function has returned: what is raised in it is lost as well
            threading.Timer(0.01, _thread.interrupt_main).start()
        else:
            before(ignored)

    sys.unraisablehook = interrupt_again
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextmanager
def _only_what_is_needed(ours: bool) -> Iterator[None]:
    """Hold back what xarray imports wherever it is installed; nothing in a process that is not ours."""
    if not ours:
        yield
        return
    with held_back("dask"), held_back("pint"):
        yield


@contextmanager
def _rare_collection() -> Iterator[None]:
    """Look for cycles of objects rarely: a command makes many objects that stay, and few that end in cycles."""
    before = gc.get_threshold()
    gc.set_threshold(*COLLECTION)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _run(app: click.Command, arguments: list[str]) -> object:
    """What `app.main` does, less its own idea of how a program ends."""
    try:
        with guard_inputs(), app.make_context("centrode", arguments) as context:
            return app.invoke(context)
    except click.exceptions.Exit as done:
        return done.exit_code


def _ending(failure: BaseException) -> int:
    """Say in one message how the program ends, and return its exit code."""
    if os.environ.get("CENTRODE_DEBUG") == "1":
        with suppress(OSError):
            traceback.print_exception(failure)
    match failure:
        case click.ClickException():
            with suppress(OSError):
                failure.show()
            return failure.exit_code
        case CentrodeError():
            _say(str(failure))
            return failure.exit_code
        case click.Abort() | KeyboardInterrupt():
            output.tell(_("interrupted"))
            return INTERRUPTED
        case BrokenPipeError():
            return READER_GONE
        case OSError():
            _say(_("the operating system refused: {reason}").format(reason=failure))
            return CentrodeError.exit_code
        case SystemExit():
            return failure.code if isinstance(failure.code, int) else 1
    fault = "".join(traceback.format_exception_only(failure)).strip()
    _say(
        _(
            "this is an error in centrode: {fault}; please report it with the command and its files "
            "(CENTRODE_DEBUG=1 prints the details)"
        ).format(fault=fault)
    )
    return FAULT


def _drop_unwritable_output() -> None:
    """What is left in a buffer that nothing takes must not fail once more when Python closes the stream."""
    for stream in (sys.stdout, sys.stderr):
        if stream is None:
            continue
        try:
            stream.flush()
        except OSError:
            with suppress(OSError):  # of a stream that is no file
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _say(message: str) -> None:
    """Print an error; control characters that came with names or files are shown, not obeyed."""
    safe = "".join(
        letter if letter.isprintable() or letter == "\n" else ascii(letter)[1:-1] for letter in message
    )
    output.tell(_("Error: {message}").format(message=safe))
