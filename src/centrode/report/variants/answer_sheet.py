"""The sheet of answers: one row a variant, for the teacher."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.errors import CentrodeError
from centrode.kinematics.preparation import ready
from centrode.locale import _, chosen_language, ngettext
from centrode.model.files import kind_at
from centrode.model.units import KINDS
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    ParagraphBlock,
    Report,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.numbers import NOTHING, Numbers
from centrode.render.document.rows import told
from centrode.render.terminal import plain_text
from centrode.report.chapters.forces.results import reactions_at_instants
from centrode.report.study import Moment, moments_of
from centrode.study.rotation import rotation_of
from centrode.study.variant_results import STATUS_WORDS
from centrode.version import __version__
from centrode.views import motion

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism
    from centrode.report.study import ReportStudy
    from centrode.study.variant_results import VariantRow
    from centrode.study.variant_tables import Variant

WIDE = 8
"""Columns of numbers beside the variant that still fit across a page."""
ROUNDING = 1e-12
"""What is below this share of the greatest of its kind is zero."""
LINKS = (("phi", "rad"), ("omega", "rad/s"), ("epsilon", "rad/s^2"))
POINTS = (("v", "m/s"), ("a", "m/s^2"))


def answer_sheet(
    topology: Mechanism,
    variants: Sequence[Variant],
    rows: Sequence[VariantRow],
    answers: Mapping[str, Answers],
    digits: int,
) -> Report:
    """Data, rotatability and the numbers at the instants of all variants, in the language that is spoken."""
    numbers = Numbers(topology.display, digits)
    sheet = _Sheet(topology, numbers, rows, answers)
    count = ngettext("{n} variant", "{n} variants", len(rows)).format(n=len(rows))
    chapters = [
        ChapterBlocks(
            "variants", _("Data of the variants"), (SectionBlocks("", tuple(sheet.data(variants))),)
        ),
        ChapterBlocks(
            "turning", _("Rotatability"), (SectionBlocks("", (sheet.turning(), *sheet.missing())),)
        ),
    ]
    for number, title in enumerate(sheet.titles()):
        sections = tuple(sheet.instant(number))
        if sections:
            chapters.append(ChapterBlocks(f"instant-{number + 1}", title, sections))
    title = _("Answers: {topology}").format(topology=_(topology.title) or _("Mechanism"))
    made = _("Computed by centrode {version}").format(version=__version__)
    return Report(title, f"{count}. {made}", chosen_language(), tuple(chapters))


class _Sheet:
    """Tables with a row for each variant."""

    def __init__(
        self,
        topology: Mechanism,
        numbers: Numbers,
        rows: Sequence[VariantRow],
        answers: Mapping[str, Answers],
    ) -> None:
        self.topology, self.numbers, self.rows, self.answers = topology, numbers, rows, answers

    def data(self, variants: Sequence[Variant]) -> list[TableBlock]:
        """What the table gave; numbers that are the same throughout, as those of a link and its drive, stand once."""
        columns: dict[tuple[float, ...], tuple[str, str]] = {}
        for path in dict.fromkeys(path for variant in variants for path in variant.values):
            values = tuple(variant.values.get(path, nan) for variant in variants)
            columns.setdefault(values, (path, KINDS[kind_at(self.topology, path)].unit))
        heads = [(shown(path), unit) for path, unit in columns.values()]
        return self._tables([variant.name for variant in variants], heads, list(columns))

    def turning(self) -> TableBlock:
        """Whether each turns fully, where it locks and why."""
        words = {True: _("yes"), False: _("no"), None: NOTHING}
        cells = []
        for row in self.rows:
            known = self.answers.get(row.variant)
            limit = NOTHING if row.limit is None else self.numbers.measured(row.limit, row.unit)
            cause = row.cause if known is None else known["cause"]
            status = _(STATUS_WORDS[row.status])
            cells.append(
                (
                    shown(row.variant),
                    words[row.turns_fully],
                    limit,
                    self._group(row),
                    told(cause, self.numbers),
                    status,
                )
            )
        head = (_("variant"), _("turns fully"), _("limit"), _("group"), _("cause"), _("status"))
        return TableBlock(head, tuple(cells), "", (False, False, True, False, False, False))

    def _group(self, row: VariantRow) -> str:
        """The group that locks, in the reader's language where the variant has answers."""
        known = self.answers.get(row.variant)
        return shown(row.group if known is None else known["group"])

    def missing(self) -> list[ParagraphBlock]:
        """Variants without answers."""
        names = [row.variant for row in self.rows if row.variant not in self.answers]
        if not names:
            return []
        text = _("No answers, for the causes above: {names}.")
        return [ParagraphBlock(text.format(names=shown(", ".join(names))))]

    def titles(self) -> list[str]:
        """Titles of the instants: what all variants call them, else their number."""
        count = max((len(known["instants"]) for known in self.answers.values()), default=0)
        found = []
        for number in range(count):
            titles = {known["instants"][number]["title"] for known in self._with(number)}
            title = (
                next(iter(titles)) if len(titles) == 1 else _("Instant {number}").format(number=number + 1)
            )
            found.append(title)
        return found

    def _with(self, number: int) -> list[Answers]:
        return [known for known in self.answers.values() if len(known["instants"]) > number]

    def instant(self, number: int) -> list[SectionBlocks]:
        """Links, points and drives at one instant."""
        flat = self.topology.space == "plane"
        link_head = _("Links") if flat else _("Angles of the links, from their reference arcs")
        units = POINTS if flat else (("v", "1/s"), ("a", "1/s^2"))
        drives = {
            coordinate.name: coordinate.force_unit for coordinate in self.topology.motion_parameter.drives
        }
        sections = []
        for title, key, kinds in ((link_head, "links", LINKS), (_("Points"), "points", units)):
            blocks: list[Block] = []
            for order, (letter, unit) in enumerate(kinds):
                blocks += self._numbers(number, key, order, letter, unit)
            sections.append(SectionBlocks(title, tuple(blocks)))
        given: list[Block] = []
        for name, unit in drives.items():
            given += self._numbers(number, "drives", None, "M" if unit == "N m" else "F", unit, name)
        sections.append(SectionBlocks(_("What the drives must give"), tuple(given)))
        return [section for section in sections if section.blocks]

    def _numbers(
        self, number: int, key: str, order: int | None, letter: str, unit: str, only: str | None = None
    ) -> list[TableBlock]:
        """A quantity of all links or points, columns, for all variants, rows."""
        instants = {
            row.variant: known["instants"][number][key]
            for row in self.rows
            if (known := self.answers.get(row.variant)) is not None and len(known["instants"]) > number
        }
        names = list(dict.fromkeys(name for one in instants.values() for name in one))
        names = [name for name in names if only is None or name == only]
        columns = []
        for name in names:
            values = (one.get(name, nan) for one in instants.values())
            columns.append(
                tuple(
                    value if order is None or not isinstance(value, list) else value[order]
                    for value in values
                )
            )
        heads = [(f"${letter}$ {shown(name)}", unit) for name in names]
        sizes = np.abs(np.array(columns, dtype=float))
        least = ROUNDING * float(np.max(sizes, where=np.isfinite(sizes), initial=0.0))
        return self._tables(list(instants), heads, columns, least)

    def _tables(
        self,
        variants: Sequence[str],
        heads: Sequence[tuple[str, str]],
        columns: Sequence[Sequence[float]],
        least: float = 0.0,
    ) -> list[TableBlock]:
        """As many tables as keep to the width of a page; what is below `least` is zero."""
        found = []
        names = tuple(map(shown, variants))
        for first in range(0, len(heads), WIDE):
            texts = [names]
            shown_heads = [_("variant")]
            some = slice(first, first + WIDE)
            for (head, unit), values in zip(heads[some], columns[some], strict=True):
                texts.append(self.numbers.column(values, unit, least))
                shown_heads.append(self.numbers.head(head, unit))
            rows = tuple(zip(*texts, strict=True))
            found.append(TableBlock(tuple(shown_heads), rows, "", (False, *(True,) * (len(shown_heads) - 1))))
        return found


# What a teacher checks of a variant: its numbers, whether it turns, and the motion and forces at the
# instants.
#
# Answers are plain numbers in SI, kept as JSON beside the variant's report: the sheet of all is made from
# these files, so
# that a run that was cut short goes on where it was.

Answers = dict[str, Any]
OF_LINKS = ("angle", "angular_velocity", "angular_acceleration")
ON_SPHERE = ("joint_angle", "joint_velocity", "joint_acceleration")
OF_POINTS = ("velocity", "acceleration")


def answers_of(study: ReportStudy) -> Answers:
    """The answers of a mechanism, in the words of the language that is spoken."""
    rotation = rotation_of(ready(study.mechanism))
    check = study.check
    return {
        "turns_fully": rotation.turns_fully,
        "limit": rotation.limit,
        "unit": rotation.unit,
        "group": rotation.group,
        "cause": rotation.cause,
        "mobility": check.mobility,
        "formula": check.formula,
        "failure": _failure(study),
        "instants": [_at(study, moment) for moment in moments_of(study)],
    }


def _failure(study: ReportStudy) -> str:
    """Why the motion is not whole; empty where it is."""
    failure = motion.sheet(study.study).failure
    return "" if failure is None else plain_text(failure.what, study.mechanism.display)


def _at(study: ReportStudy, moment: Moment) -> Answers:
    """One instant: angles and rates of the links, speeds of the points, what the drives give."""
    found: Answers = {
        "title": moment.title,
        "reached": moment.reached,
        "links": {},
        "points": {},
        "drives": {},
    }
    if not moment.reached:
        return found
    here = moment.data.isel(sample=moment.sample)
    flat = study.is_planar
    dimension, names = ("link", OF_LINKS) if flat else ("joint", ON_SPHERE)
    for label in here[dimension].to_numpy().tolist():
        found["links"][label] = [_number(here[name].sel({dimension: label})) for name in names]
    for point in study.mechanism.moving_points:
        vectors = (here[name].sel(point=point).to_numpy() for name in OF_POINTS)
        found["points"][point] = [float(np.linalg.norm(vector)) for vector in vectors]
    found["drives"] = _drives(study, moment)
    return found


def _drives(study: ReportStudy, moment: Moment) -> dict[str, float]:
    """What each drive has to give, where masses or loads are there and reactions can be found."""
    reactions = study.study.reactions
    if reactions is None:
        return {}
    try:
        here = reactions_at_instants(study).isel(sample=moment.sample)
    except CentrodeError:
        return {}
    values = here["balancing"].to_numpy().tolist()
    found = dict(zip(here["drive"].to_numpy().tolist(), values, strict=True))
    return {name: value for name, value in found.items() if np.isfinite(value)}


def _number(value: xr.DataArray) -> float:
    return float(value)
