"""Presentations of results: tables, drawings and figures. They read results and compute nothing.

Everything is loaded when first used, so that a run without figures imports no matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import lazy_loader

from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.present.coefficient_tables import write_coefficients_csv
    from centrode.present.drawing import draw_mechanism
    from centrode.present.equation_latex import equations_latex, equations_markdown
    from centrode.present.equation_text import equations_rows, equations_text
    from centrode.present.figures import motion_figures
    from centrode.present.machine_figures import machine_figures
    from centrode.present.reading import scene_of
    from centrode.present.reduction_figures import reduction_figures
    from centrode.present.reduction_tables import write_reduction_csv
    from centrode.present.region_tables import write_region_csv
    from centrode.present.regions import region_figure
    from centrode.present.saving import save_figures
    from centrode.present.sweep_tables import sweep_csv
    from centrode.present.tables import motion_table, write_motion_csv, write_motion_netcdf

__all__ = [
    "draw_mechanism",
    "equations_latex",
    "equations_markdown",
    "equations_rows",
    "equations_text",
    "machine_figures",
    "motion_figures",
    "motion_table",
    "reduction_figures",
    "region_figure",
    "save_figures",
    "scene_of",
    "sweep_csv",
    "write_coefficients_csv",
    "write_motion_csv",
    "write_motion_netcdf",
    "write_reduction_csv",
    "write_region_csv",
]

_attached, __dir__, _names = lazy_loader.attach(
    __name__,
    submod_attrs={
        "drawing": ["draw_mechanism"],
        "coefficient_tables": ["write_coefficients_csv"],
        "equation_latex": ["equations_latex", "equations_markdown"],
        "equation_text": ["equations_rows", "equations_text"],
        "figures": ["motion_figures"],
        "machine_figures": ["machine_figures"],
        "reading": ["scene_of"],
        "reduction_figures": ["reduction_figures"],
        "reduction_tables": ["write_reduction_csv"],
        "region_tables": ["write_region_csv"],
        "regions": ["region_figure"],
        "saving": ["save_figures"],
        "sweep_tables": ["sweep_csv"],
        "tables": ["motion_table", "write_motion_csv", "write_motion_netcdf"],
    },
)


def __getattr__(name: str) -> Any:
    """Load a presentation when it is first asked for; a missing matplotlib is told with its repair."""
    try:
        return _attached(name)
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] != "matplotlib":
            raise
        raise InputError(
            "",
            _("figures need matplotlib, which is not installed"),
            _('install it with pip install "centrode[figures]", or pass --no-figures'),
        ) from missing
