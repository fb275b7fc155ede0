"""Sheets A1 with frame and main inscription, as figures and as DXF and PDF files of true size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure

from centrode.render.drafting.drawing_page import (
    A1,
    DrawingPage,
    SheetField,
    blacken,
    new_drawing_page,
    with_primes,
)
from centrode.render.drafting.dxf import write_drawing_dxf
from centrode.render.drafting.geometric_drawings import draw_geometric_plate, write_facts
from centrode.render.drafting.plates import (
    draw_group_plate,
    draw_lever_plate,
    draw_plan_plate,
    draw_positions_plate,
    ratio_text,
)
from centrode.render.drafting.recorder import LAYERS, drawing_of_figure
from centrode.render.drafting.scaled_diagrams import EnergyMassFields, draw_diagram, draw_energy_mass
from centrode.render.drafting.title_block import (
    HIGH,
    WIDE,
    Inscription,
    draw_frame,
    drawing_field,
)
from centrode.render.drawing.style import house_style
from centrode.render.figures.files import respell, spell_decimals
from centrode.render.spelling import DASH, FigureSpelling
from centrode.sheets.drawing_sheets import (
    DiagramSheet,
    EnergySheet,
    ForceSheet,
    GeometricDrawing,
    MotionSheet,
    ProfileSheet,
    VectorSheet,
)
from centrode.sheets.force_pages import GroupPage

if TYPE_CHECKING:
    from centrode.render.drafting.scales import DrawingScale
    from centrode.sheets.drawing_sheets import DrawingSet, DrawingSheet

FORMATS = ("pdf", "dxf")
"""Kinds of files."""
DIAGRAMS = 362.0
"""Width of the column of diagrams [mm]: a turn at 0.02 rad/mm with room for numbers."""
PLANS = 232.0
"""Height of the row of plans of vectors [mm]."""
ROWS = 2
"""Rows of plans of vectors on a sheet of their own."""
ASIDE = 2.0
"""Between a field and the main inscription [mm]."""
CHOICE = 205.0
"""Height of the choice of a cam's least radius, beside the main inscription [mm]."""
ABOVE = 8.0
"""Between the profile of a cam and the list of its sizes [mm]."""
CORNER = 16.0
"""Height that the repeated designation takes off the upper left corner of the field [mm]."""


def drawing_figures(made: DrawingSet, scale: DrawingScale | None = None) -> list[Figure]:
    """The sheets as figures of true size.

    Parameters
    ----------
    scale : of the mechanism in its positions, or of a cam alone; the largest standard one that fits if None

    Raises
    ------
    InputError
        The scale is too large for the sheet.
    """
    figures = []
    names = tuple(FigureSpelling(None).text(sheet.name) for sheet in made.sheets)
    for number, sheet in enumerate(made.sheets, start=1):
        with house_style():
            page = new_drawing_page(A1)
            # a cam beside its linkage keeps the scale that fits
            shown = _draw(page, sheet, scale if number == 1 else None)
            blacken(page.figure)
            draw_frame(page, Inscription(made.block, names, number, shown))
            respell(page.figure, with_primes)
            spell_decimals(page.figure)
        figures.append(page.figure)
    return figures


def _draw(page: DrawingPage, sheet: DrawingSheet, scale: DrawingScale | None) -> str:
    """Draw what a sheet shows; returns the scale for its main inscription."""
    match sheet:
        case MotionSheet():
            return _draw_motion(page, sheet, scale)
        case DiagramSheet():
            return _draw_diagrams(page, sheet)
        case VectorSheet():
            return _draw_vectors(page, sheet)
        case EnergySheet():
            return _draw_energies(page, sheet)
        case ForceSheet():
            return _draw_forces(page, sheet)
        case ProfileSheet():
            return _draw_profile(page, sheet, scale)
        case _:
            assert_never(sheet)


def _field() -> SheetField:
    return drawing_field(A1).part(1.0, 1.0, 1.0, 1.0)


def _draw_motion(page: DrawingPage, sheet: MotionSheet, scale: DrawingScale | None) -> str:
    """Positions at the upper left, diagrams of the output at the right, plans of vectors at the lower left."""
    field = _field()
    beside = field.part(right=DIAGRAMS)
    low = PLANS if sheet.plans else 0.0
    shown = draw_positions_plate(page, beside.part(bottom=low, top=CORNER), sheet.positions, scale)
    column = field.part(left=float(field.size[0]) - DIAGRAMS, bottom=HIGH + ASIDE)
    for number, diagram in enumerate(reversed(sheet.diagrams)):
        draw_diagram(page, column.share(1, 0, len(sheet.diagrams), number), diagram)
    row = field.part(right=max(DIAGRAMS, WIDE + ASIDE), top=float(field.size[1]) - low)
    for number, plan in enumerate(sheet.plans):
        draw_plan_plate(page, row.share(len(sheet.plans), number), plan)
    return ratio_text(shown)


def _draw_diagrams(page: DrawingPage, sheet: DiagramSheet) -> str:
    """Diagrams below each other, above the main inscription."""
    field = _field().part(bottom=HIGH + ASIDE, top=CORNER)
    for number, diagram in enumerate(reversed(sheet.diagrams)):
        draw_diagram(page, field.share(1, 0, len(sheet.diagrams), number), diagram)
    return DASH


def _draw_vectors(page: DrawingPage, sheet: VectorSheet) -> str:
    """Plans of one instant side by side, of several below each other, and in a second column from the third on."""
    field = _field().part(bottom=HIGH + ASIDE, top=CORNER)
    count = len(sheet.plans)
    across = 2 if count <= ROWS * 2 else 4
    up = -(-count // across)
    for number, plan in enumerate(sheet.plans):
        draw_plan_plate(page, field.share(across, number % across, up, up - 1 - number // across), plan)
    return DASH


def _draw_energies(page: DrawingPage, sheet: EnergySheet) -> str:
    """Work and energy-mass diagram side by side above; below them moments and works, and the inertia."""
    field = _field()
    left, right = field.part(right=float(field.size[0]) - DIAGRAMS), field.part(left=DIAGRAMS)
    upper = 0.5 * float(field.size[1])
    below = left.part(top=upper)
    for number, diagram in enumerate(reversed(sheet.diagrams)):
        draw_diagram(page, below.share(1, 0, len(sheet.diagrams), number), diagram)
    beside = right.part(right=WIDE + ASIDE, left=8.0)
    fields = EnergyMassFields(
        left.part(bottom=float(field.size[1]) - upper, top=CORNER),
        right.part(bottom=float(field.size[1]) - upper, top=CORNER),
        right.part(top=upper, bottom=HIGH + ASIDE),
        SheetField(beside.corner, np.array([beside.size[0], HIGH])),
    )
    draw_energy_mass(page, fields, sheet.energy_mass)
    return DASH


def _draw_forces(page: DrawingPage, sheet: ForceSheet) -> str:
    """Groups with their polygons and levers, two in a row."""
    field = _field().part(bottom=HIGH + ASIDE, top=CORNER)
    count = len(sheet.groups)
    across, up = (1, 1) if count == 1 else (2, -(-count // 2))
    for number, group in enumerate(sheet.groups):
        cell = field.share(across, number % across, up, up - 1 - number // across)
        if isinstance(group, GroupPage):
            draw_group_plate(page, cell, group)
        else:
            draw_lever_plate(page, cell, group)
    return DASH


def _draw_profile(page: DrawingPage, sheet: ProfileSheet, scale: DrawingScale | None) -> str:
    """Diagrams below each other at the left, the profile at the upper right, below it the choice of its radius."""
    field = _field()
    column = field.part(right=float(field.size[0]) - DIAGRAMS, top=CORNER)
    for number, diagram in enumerate(reversed(sheet.diagrams)):
        draw_diagram(page, column.share(1, 0, len(sheet.diagrams), number), diagram)
    right = field.part(left=DIAGRAMS)
    spelling = FigureSpelling(sheet.display)
    shown = draw_geometric_plate(page, right.part(bottom=CHOICE), sheet.profile, spelling, scale)
    low = right.part(top=float(right.size[1]) - CHOICE)
    beside = low.part(right=WIDE + ASIDE)
    if isinstance(sheet.choice, GeometricDrawing):
        draw_geometric_plate(page, beside, sheet.choice, spelling)
    else:
        draw_diagram(page, beside, sheet.choice)
    facts = [(spelling.text(label), spelling.text(value)) for label, value in sheet.facts]
    write_facts(
        page, low.part(left=float(low.size[0]) - WIDE + ASIDE, bottom=HIGH + ASIDE, right=ASIDE), facts
    )
    return ratio_text(shown)


# Files

METADATA = {"Creator": "centrode", "Producer": None, "CreationDate": None}
"""Nothing that differs from one run to the next."""


def write_drawing_set(
    made: DrawingSet, folder: Path, formats: Sequence[str] = FORMATS, scale: DrawingScale | None = None
) -> list[Path]:
    """Write every sheet to an existing folder, sheet-1.pdf, sheet-1.dxf and so on; the same sheets give the same bytes.

    Parameters
    ----------
    formats : "pdf", "dxf"
    scale : as of `drawing_figures`

    Raises
    ------
    InputError
        The scale is too large; ezdxf is missing for DXF.
    """
    return list(_written(drawing_figures(made, scale), folder, formats))


def _written(figures: Sequence[Figure], folder: Path, formats: Sequence[str]) -> Iterator[Path]:
    for number, figure in enumerate(figures, start=1):
        for kind in formats:
            path = folder / f"sheet-{number}.{kind}"
            with house_style():
                if kind == "dxf":
                    write_drawing_dxf(drawing_of_figure(figure), path, LAYERS, 1.0)
                else:
                    with rc_context({"pdf.fonttype": 42}):
                        canvas: Any = FigureCanvasPdf(figure)
                        canvas.print_pdf(path, metadata=METADATA)
            yield path
