"""Optional libraries: where one is not installed, the failure names it and says how to install it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from centrode.errors import InputError
from centrode.locale import _, ngettext

Asked = ParamSpec("Asked")
Found = TypeVar("Found")


def telling_what_is_missing(load: Callable[Asked, Found]) -> Callable[Asked, Found]:
    """The same function, which raises InputError where a library is not installed."""

    @functools.wraps(load)
    def loaded(*args: Asked.args, **kwargs: Asked.kwargs) -> Found:
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

    return loaded


def how_to_install(*extras: str) -> str:
    """The repair that installs extras in the folder of the source files; the quotes suit every shell."""
    repair = ngettext(
        'install the extra {extras}: pip install -e ".[{extras}]" in the folder with the source files',
        'install the extras {extras}: pip install -e ".[{extras}]" in the folder with the source files',
        len(extras),
    )
    return repair.format(extras=",".join(extras))
