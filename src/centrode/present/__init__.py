"""Presentations of results: tables, drawings and figures. They read results and compute nothing.

Everything is loaded when first used, so that a run without figures imports no matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import lazy_loader

from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.present.animations.animate import animate
    from centrode.present.animations.given import (
        animate_centrodes,
        animate_follower,
        animate_motion,
        animate_walking,
    )
    from centrode.present.animations.paces import Animation, Pace
    from centrode.present.animations.shown import Shown
    from centrode.present.cams.bodies import cam_body_figures
    from centrode.present.cams.choice import choice_figures, trade_off_figure
    from centrode.present.cams.choice_tables import write_choice
    from centrode.present.cams.contact import contact_figure
    from centrode.present.cams.drawing import (
        cam_curves_figure,
        cam_figures,
        cam_path_figure,
        cam_routes_figure,
    )
    from centrode.present.cams.forces import cam_forces_figure
    from centrode.present.cams.motion_drawing import cam_motion_figure, laws_figure
    from centrode.present.cams.outline_dxf import write_outlines_dxf
    from centrode.present.cams.outline_files import write_cam_outlines
    from centrode.present.cams.outline_svg import write_outlines_svg
    from centrode.present.cams.plate_curves import plate_curves_figure
    from centrode.present.cams.plate_drawing import follower_cam_figure
    from centrode.present.cams.profile_drawing import profile_figure
    from centrode.present.cams.profile_tables import write_profile_csv
    from centrode.present.cams.tables import (
        write_cam_contact_csv,
        write_cam_csv,
        write_cam_forces_csv,
        write_cam_laws_csv,
        write_cam_motion_csv,
        write_cam_routes_csv,
        write_cam_tables,
    )
    from centrode.present.cams.walking_drawing import walking_figure
    from centrode.present.centres import centres_figure
    from centrode.present.centres_tables import write_centres_csv, write_centrodes_csv
    from centrode.present.centrodes import centrodes_figure
    from centrode.present.coefficient_tables import write_coefficients_csv
    from centrode.present.curvature import curvature_figure
    from centrode.present.dark import darkened
    from centrode.present.decimal_comma import spell_with_comma
    from centrode.present.drafting.dxf import write_drawing_dxf
    from centrode.present.drafting.sheet import mechanism_drawing
    from centrode.present.drafting.svg import drawing_svg, write_drawing_svg
    from centrode.present.drawing import draw_mechanism
    from centrode.present.equations.latex import equations_latex, equations_markdown
    from centrode.present.equations.text import equations_rows, equations_text
    from centrode.present.figures import motion_figures
    from centrode.present.forces.balance_figures import balance_figures
    from centrode.present.forces.balance_tables import write_balance_csv, write_harmonics_csv
    from centrode.present.forces.bearing_figures import bearing_figures
    from centrode.present.forces.bearing_tables import write_bearing_loads_csv
    from centrode.present.forces.machine_figures import machine_figures
    from centrode.present.forces.polygon_drawing import polygon_figures
    from centrode.present.forces.reaction_figures import reaction_figures
    from centrode.present.forces.reaction_tables import write_joint_table_csv, write_reactions_csv
    from centrode.present.forces.reduction_figures import reduction_figures
    from centrode.present.forces.reduction_tables import write_reduction_csv
    from centrode.present.forces.simulation_figures import simulation_figures
    from centrode.present.instant_drawing import diagram_figures
    from centrode.present.integration_tables import write_integration_csv
    from centrode.present.integrations import integration_figures
    from centrode.present.mjcf.writing import mjcf_text
    from centrode.present.plan_drawing import plan_figure
    from centrode.present.reading import scene_of
    from centrode.present.region_tables import write_region_csv
    from centrode.present.regions import region_figure
    from centrode.present.saving import save_figures
    from centrode.present.spelled_tables import TableSpelling
    from centrode.present.sweep_tables import sweep_csv
    from centrode.present.tables import motion_table, write_motion_csv, write_motion_netcdf
    from centrode.present.transmission_curves import transmission_figure
    from centrode.present.variant_folders import write_variants
    from centrode.present.workbooks import workbook_of_csv, write_motion_xlsx

__all__ = [
    "Animation",
    "Pace",
    "Shown",
    "animate",
    "animate_centrodes",
    "animate_motion",
    "balance_figures",
    "animate_follower",
    "animate_walking",
    "choice_figures",
    "contact_figure",
    "trade_off_figure",
    "write_cam_contact_csv",
    "write_choice",
    "cam_body_figures",
    "cam_curves_figure",
    "cam_figures",
    "cam_forces_figure",
    "write_cam_forces_csv",
    "cam_motion_figure",
    "laws_figure",
    "write_cam_laws_csv",
    "write_cam_motion_csv",
    "cam_path_figure",
    "cam_routes_figure",
    "centres_figure",
    "centrodes_figure",
    "curvature_figure",
    "darkened",
    "draw_mechanism",
    "equations_latex",
    "equations_markdown",
    "equations_rows",
    "equations_text",
    "machine_figures",
    "diagram_figures",
    "integration_figures",
    "drawing_svg",
    "mechanism_drawing",
    "mjcf_text",
    "write_drawing_dxf",
    "write_drawing_svg",
    "motion_figures",
    "motion_table",
    "bearing_figures",
    "reaction_figures",
    "reduction_figures",
    "plan_figure",
    "polygon_figures",
    "plate_curves_figure",
    "follower_cam_figure",
    "profile_figure",
    "region_figure",
    "save_figures",
    "scene_of",
    "simulation_figures",
    "sweep_csv",
    "write_balance_csv",
    "write_harmonics_csv",
    "write_cam_csv",
    "write_cam_routes_csv",
    "write_cam_tables",
    "write_centres_csv",
    "write_centrodes_csv",
    "transmission_figure",
    "walking_figure",
    "write_cam_outlines",
    "write_outlines_dxf",
    "write_outlines_svg",
    "write_profile_csv",
    "write_coefficients_csv",
    "write_integration_csv",
    "write_joint_table_csv",
    "write_motion_csv",
    "write_motion_netcdf",
    "write_bearing_loads_csv",
    "write_reactions_csv",
    "write_reduction_csv",
    "write_region_csv",
    "write_variants",
    "spell_with_comma",
    "TableSpelling",
    "workbook_of_csv",
    "write_motion_xlsx",
]

_attached, __dir__, _names = lazy_loader.attach(
    __name__,
    submod_attrs={
        "forces.balance_figures": ["balance_figures"],
        "forces.balance_tables": ["write_balance_csv", "write_harmonics_csv"],
        "cams.bodies": ["cam_body_figures"],
        "cams.drawing": ["cam_curves_figure", "cam_figures", "cam_path_figure", "cam_routes_figure"],
        "cams.forces": ["cam_forces_figure"],
        "cams.motion_drawing": ["cam_motion_figure", "laws_figure"],
        "cams.choice": ["choice_figures", "trade_off_figure"],
        "cams.choice_tables": ["write_choice"],
        "cams.contact": ["contact_figure"],
        "cams.tables": [
            "write_cam_contact_csv",
            "write_cam_csv",
            "write_cam_forces_csv",
            "write_cam_laws_csv",
            "write_cam_motion_csv",
            "write_cam_routes_csv",
            "write_cam_tables",
        ],
        "centres": ["centres_figure"],
        "centres_tables": ["write_centres_csv", "write_centrodes_csv"],
        "animations.animate": ["animate"],
        "animations.given": [
            "animate_centrodes",
            "animate_follower",
            "animate_motion",
            "animate_walking",
        ],
        "animations.paces": ["Animation", "Pace"],
        "animations.shown": ["Shown"],
        "centrodes": ["centrodes_figure"],
        "curvature": ["curvature_figure"],
        "dark": ["darkened"],
        "decimal_comma": ["spell_with_comma"],
        "spelled_tables": ["TableSpelling"],
        "drafting.dxf": ["write_drawing_dxf"],
        "drafting.sheet": ["mechanism_drawing"],
        "drafting.svg": ["drawing_svg", "write_drawing_svg"],
        "drawing": ["draw_mechanism"],
        "coefficient_tables": ["write_coefficients_csv"],
        "equations.latex": ["equations_latex", "equations_markdown"],
        "equations.text": ["equations_rows", "equations_text"],
        "figures": ["motion_figures"],
        "forces.machine_figures": ["machine_figures"],
        "instant_drawing": ["diagram_figures"],
        "cams.outline_dxf": ["write_outlines_dxf"],
        "cams.outline_files": ["write_cam_outlines"],
        "cams.outline_svg": ["write_outlines_svg"],
        "plan_drawing": ["plan_figure"],
        "cams.plate_curves": ["plate_curves_figure"],
        "cams.plate_drawing": ["follower_cam_figure"],
        "cams.profile_drawing": ["profile_figure"],
        "cams.profile_tables": ["write_profile_csv"],
        "integration_tables": ["write_integration_csv"],
        "integrations": ["integration_figures"],
        "forces.polygon_drawing": ["polygon_figures"],
        "forces.bearing_figures": ["bearing_figures"],
        "forces.bearing_tables": ["write_bearing_loads_csv"],
        "forces.reaction_figures": ["reaction_figures"],
        "forces.reaction_tables": ["write_joint_table_csv", "write_reactions_csv"],
        "reading": ["scene_of"],
        "forces.reduction_figures": ["reduction_figures"],
        "forces.reduction_tables": ["write_reduction_csv"],
        "region_tables": ["write_region_csv"],
        "regions": ["region_figure"],
        "mjcf.writing": ["mjcf_text"],
        "saving": ["save_figures"],
        "forces.simulation_figures": ["simulation_figures"],
        "sweep_tables": ["sweep_csv"],
        "tables": ["motion_table", "write_motion_csv", "write_motion_netcdf"],
        "transmission_curves": ["transmission_figure"],
        "variant_folders": ["write_variants"],
        "workbooks": ["workbook_of_csv", "write_motion_xlsx"],
        "cams.walking_drawing": ["walking_figure"],
    },
)


def __getattr__(name: str) -> Any:
    """Load a presentation when it is first asked for; a missing library is told with its repair."""
    try:
        return _attached(name)
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
