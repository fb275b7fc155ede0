"""DXF files (AutoCAD 2010, millimetres) whose bytes depend on nothing but what is drawn."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import lazy_loader

from centrode.errors import InputError
from centrode.locale import _
from centrode.optional_packages import how_to_install

VERSION = "R2010"
MILLIMETRES = 4
FONT = "arial.ttf"
"""Of all text: the usual stroked one has no letters but Latin ones."""

_ezdxf = functools.partial(lazy_loader.load, "ezdxf")  # an extra, and slow to import


@contextmanager
def dxf_document(path: Path) -> Iterator[tuple[Any, Any]]:
    """The library and a new document of it, which is written to the path when the block ends.

    Raises
    ------
    InputError
        The extra `drawings` is not installed.
    """
    if find_spec("ezdxf") is None:
        raise InputError(
            str(path),
            _("DXF needs ezdxf, which is not installed"),
            how_to_install("drawings"),
        )
    library = _ezdxf()
    with _without_time(library):
        document = library.new(VERSION, units=MILLIMETRES)
        document.header["$MEASUREMENT"] = 1
        document.styles.get("Standard").dxf.font = FONT
        yield library, document
        _declare(document)
        document.saveas(path, encoding="utf-8")


def _declare(document: Any) -> None:
    """Declare the classes of what is drawn in alphabetical order; the library would take that of a set of texts."""
    for name in sorted({entity.dxftype() for entity in document.entitydb.values()}):
        document.classes.add_class(name)


@contextmanager
def _without_time(library: Any) -> Iterator[None]:
    """Context in which files carry no time and no chance identity."""
    options = library.options
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
