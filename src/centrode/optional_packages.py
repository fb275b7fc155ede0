"""Optional libraries: where one is not installed, the failure names it and says how to install it."""

from __future__ import annotations

import functools
import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import ParamSpec, TypeVar

from centrode.errors import InputError
from centrode.locale import _, ngettext

Asked = ParamSpec("Asked")
Found = TypeVar("Found")


def telling_what_is_missing(load: Callable[Asked, Found]) -> Callable[Asked, Found]:
    """The same function, which raises InputError where a library is not installed."""

    @functools.wraps(load)
    def report_missing(*args: Asked.args, **kwargs: Asked.kwargs) -> Found:
        try:
            return load(*args, **kwargs)
        except ModuleNotFoundError as missing:
            library = (missing.name or "").partition(".")[0]
            if library == "matplotlib":
                what = _("figures need matplotlib, which is not installed")
                repair = _("{repair}, or pass --no-figures").format(repair=how_to_install("figures"))
            elif library == "xlsxwriter":
                what = _("workbooks need XlsxWriter, which is not installed")
                repair = _("{repair}, or use the CSV files").format(repair=how_to_install("tables"))
            else:
                raise
            raise InputError("", what, repair) from missing

    return report_missing


def how_to_install(*extras: str) -> str:
    """The repair that installs extras in the folder of the source files; the quotes suit every shell."""
    repair = ngettext(
        'install the extra {extras}: pip install -e ".[{extras}]" in the folder with the source files',
        'install the extras {extras}: pip install -e ".[{extras}]" in the folder with the source files',
        len(extras),
    )
    return repair.format(extras=",".join(extras))


# Libraries that another one imports wherever they are installed, whether they are used or not.


@contextmanager
def held_back(library: str) -> Iterator[None]:
    """While the block runs, a library that is not imported yet counts as not installed, until it is `admitted`."""
    if library in sys.modules:
        yield
        return
    # the import system takes None for a library that there is none of
    sys.modules[library] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        _forget_absence(library)


def admitted_module(name: str, *held: str) -> ModuleType:
    """A module, for which libraries that are held back are let in again."""
    for library in held:
        _forget_absence(library)
    return importlib.import_module(name)


def _forget_absence(library: str) -> None:
    if sys.modules.get(library, library) is None:
        del sys.modules[library]
