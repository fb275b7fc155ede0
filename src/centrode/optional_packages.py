"""Optional libraries: where one is not installed, the failure names it and says how to install it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from centrode.errors import InputError
from centrode.locale import _

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
                repair = _('install it with pip install "centrode[figures]", or pass --no-figures')
            elif library == "xlsxwriter":
                what = _("workbooks need XlsxWriter, which is not installed")
                repair = _('install it with pip install "centrode[tables]", or take the CSV files')
            else:
                raise
            raise InputError("", what, repair) from missing

    return loaded
