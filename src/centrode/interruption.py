"""Ctrl-C before the command line begins its work and after it has ended: the process ends, without a traceback.

Modules take a moment to import, and libraries to close. An exception there is shown by Python itself, wherever it
happens; nothing is open then that would have to be put in order. As this comes before everything else, it imports next
to nothing.
"""

from __future__ import annotations

# the module of C is there at once; that above it imports others
import _signal as signal  # type: ignore[import-not-found]
import os
import sys

INTERRUPTED = 130
"""Exit code, as shells have it of a program that Ctrl-C ends."""


def is_command_line(arguments: list[str], of_python: list[str]) -> bool:
    """Whether Python runs the command of this package, or looks for the module that `python -m centrode` names.

    Parameters
    ----------
    arguments : as a program gets them, `sys.argv`
    of_python : those with which Python was started, `sys.orig_argv`
    """
    if not arguments:
        return False
    if arguments[0] == "-m":
        # it stands there as long as a package is imported for a module of its own that is to be run: of ours, or of
        # another one, which handles Ctrl-C as it likes
        module = of_python[-len(arguments)]
        return module == "centrode" or (module.startswith("-") and module.endswith("mcentrode"))
    return os.path.splitext(os.path.basename(arguments[0]))[0] == "centrode"


def end_at_interruption() -> None:
    """Let Ctrl-C end the process at once; where it is ignored, or somebody handles it, it stays so."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        try:
            signal.signal(signal.SIGINT, _end)
        except ValueError:
            return  # a thread that is not the main one is never interrupted


def raise_at_interruption() -> None:
    """Let Ctrl-C raise KeyboardInterrupt again, as Python has it, where `end_at_interruption` was called."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _end(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)


if is_command_line(sys.argv, sys.orig_argv):
    end_at_interruption()
