"""Reports: chapters of blocks made from results, and the documents that show them.

What makes them is loaded when first used; what it needs and is not installed is told with the repair.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import lazy_loader

from centrode.report.files import lacking

if TYPE_CHECKING:
    from centrode.render.document.blocks import Report
    from centrode.report.document import report
    from centrode.report.files import write_report
    from centrode.report.study import ReportOptions
    from centrode.report.variants.files import write_variant_reports
    from centrode.report.variants.gear_folders import write_gear_variants

__all__ = [
    "Report",
    "ReportOptions",
    "report",
    "write_gear_variants",
    "write_report",
    "write_variant_reports",
]

_attached, __dir__, _names = lazy_loader.attach(
    __name__,
    submod_attrs={
        "document": ["Report", "report"],
        "study": ["ReportOptions"],
        "variants.files": ["write_variant_reports"],
        "variants.gear_folders": ["write_gear_variants"],
        "files": ["write_report"],
    },
)


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for; a missing library is told with its repair."""
    try:
        return _attached(name)
    except ModuleNotFoundError as missing:
        library = (missing.name or "").partition(".")[0]
        if library == "centrode":
            raise
        raise lacking(library) from missing
