"""The chapter of the flywheel: works and energies over a cycle, the inertia that is needed, the wheel's size."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _, ngettext
from centrode.present.forces.machine_figures import machine_figures
from centrode.render.document.blocks import Block, Chapter, Check, Formula, Paragraph, Section, Table
from centrode.render.document.formulas import factor, in_si, with_unit
from centrode.report.chapters.forces.absent import without_machine
from centrode.report.chapters.forces.places import few
from centrode.report.chapters.forces.results import has_forces, machine_of
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.telling import facts, measured, pictures
from centrode.study.forces.machines import flywheel_rows

if TYPE_CHECKING:
    from centrode.dynamics.steady_motion.flywheel import Flywheel
    from centrode.dynamics.steady_motion.sizes import Wheel
    from centrode.report.study import ReportStudy

Lines = list[tuple[str, ...]]
COURSE = (
    ("turned", "phi"),
    ("moment_of_loads", "M_upright(c)"),
    ("work_of_loads", "A_upright(c)"),
    ("work_of_drive", "A_upright(d)"),
    ("inertia_of_links", 'J_upright("II")'),
    ("energy_of_links", 'T_upright("II")'),
    ("energy_change", "Delta T_upright(I)"),
)


def flywheel_chapter(study: ReportStudy) -> Chapter | None:
    """Energies of the machine over a cycle, and the flywheel that keeps its speed as even as asked."""
    if not has_forces(study) or study.mechanism.machine is None:
        return None
    return without_machine(study, "flywheel", _("Flywheel")) or _made(study)


def _made(study: ReportStudy) -> Chapter:
    machine = machine_of(study)
    found = machine.flywheel
    sections = [
        Section("", (*_meaning(found), Formula(tuple(_works(study, found))))),
        Section(_("Over the cycle"), (_course(study),)),
        Section(_("Inertia and flywheel"), _needed(study, found)),
        Section(_("Summary"), (facts(study.numbers, flywheel_rows(study.mechanism, found)),)),
        Section(_("Figures"), tuple(_figures(study))),
    ]
    return Chapter("flywheel", _("Flywheel"), tuple(sections))


def _meaning(found: Flywheel) -> tuple[Block, ...]:
    """What counts as what; the cycle."""
    cycle = ngettext(
        "A cycle has {n} turn of the drive; angles turned $phi$, works and moments count in the sense of the drive.",
        "A cycle has {n} turns of the drive; angles turned $phi$, works and moments count in the sense of the drive.",
        found.turns,
    )
    groups = _(
        "Group I is what turns with the drive at a constant ratio, shafts and flywheel; group II the links, whose"
        ' inertia $J_upright("II")$ changes with the position.'
    )
    return Paragraph(cycle.format(n=found.turns)), Paragraph(groups)


def _works(study: ReportStudy, found: Flywheel) -> Lines:
    """Work of the loads, the mean moment that makes up for it, energies, their extremes."""
    numbers, driven = study.numbers, study.mechanism.machine
    idle = abs(found.work_of_loads) <= found.error
    work = 0.0 if idle else found.work_of_loads
    moment = 0.0 if idle else found.driving_moment
    turn = "2 pi" if found.turns == 1 else f"2 pi dot.op {found.turns}"
    lines: Lines = [("A_upright(c)", "integral.cont M_upright(c) thin d phi", with_unit(numbers, work, "J"))]
    fraction = f"-frac({numbers.math(work)}, {turn})"
    mean = "overline(M)_upright(d)" if driven is not None and driven.driving else "M_upright(d)"
    lines.append((mean, f"-frac(A_upright(c), {turn})", fraction, with_unit(numbers, moment, "N m")))
    lines.append(('T_upright("II")', '1/2 J_upright("II") omega_upright(m)^2'))
    lines.append(
        (
            "Delta T_upright(I)",
            'integral_0^phi (M_upright(d) + M_upright(c)) thin d phi - T_upright("II")',
        )
    )
    for name, value, at in (
        ("max", found.energy_greatest, found.greatest_at),
        ("min", found.energy_least, found.least_at),
    ):
        place = with_unit(numbers, at, "rad")
        left = f"Delta T_(upright(I), {name})"
        lines.append((left, f"{with_unit(numbers, value, 'J')} quad (phi = {place})"))
    return lines


def _course(study: ReportStudy) -> Table:
    """Moments, works and energies at even steps."""
    steady = machine_of(study).steady
    columns = [
        Column(f"${symbol}$", str(steady[name].attrs["units"]), steady[name].to_numpy())
        for name, symbol in COURSE
    ]
    caption = _("Moments, works and energies over the cycle")
    return over_samples(study.numbers, columns, few(steady.sizes["sample"]), caption)


def _needed(study: ReportStudy, found: Flywheel) -> tuple[Block, ...]:
    """From the range of energies to the wheel; without a fluctuation only what the shafts give."""
    numbers = in_si(study.numbers)
    if found.fluctuation is None or found.inertia is None or found.inertia_first_order is None:
        text = _("No coefficient of fluctuation is given: the speed is the one with the shafts alone.")
        return Paragraph(text), *_energy_check(study, found)
    reach = found.energy_greatest - found.energy_least
    speed, delta = factor(numbers, found.mean_speed), factor(numbers, found.fluctuation)
    first = (
        "J_upright(I)",
        "frac(Delta T_(upright(I), max) - Delta T_(upright(I), min), omega_upright(m)^2 delta)",
        f"frac({numbers.math(reach)}, {speed}^(2) dot.op {delta})",
        with_unit(numbers, found.inertia_first_order, "kg m^2"),
    )
    exact = ("J_upright(I)", with_unit(numbers, found.inertia, "kg m^2"))
    told = _(
        "This takes the energy of the links at the mean speed. From the energy equation itself, without that"
        " approximation:"
    )
    blocks: list[Block] = [Formula((first,)), Paragraph(told), Formula((exact,)), *_wheel(study, found)]
    return (*blocks, *_energy_check(study, found), *_fluctuation_check(found))


def _wheel(study: ReportStudy, found: Flywheel) -> list[Block]:
    """The flywheel's own inertia, and the sizes of a rim and a disc."""
    numbers, machine = study.numbers, study.mechanism.machine
    if not found.added or found.inertia is None or machine is None:
        return [Paragraph(_("The shafts have enough inertia: no flywheel is needed."))]
    ratio = machine.flywheel.ratio
    above = f"{numbers.math(found.inertia)} - {numbers.math(found.present)}"
    letters = "J_upright(I) - J_upright(s)"
    if ratio != 1.0:
        letters, above = (
            f"frac({one}, {other})"
            for one, other in ((letters, "i^2"), (above, f"{factor(numbers, ratio)}^(2)"))
        )
    lines: Lines = [("J_upright(f)", letters, above, with_unit(numbers, found.added, "kg m^2"))]
    meaning = _(
        "$J_upright(s)$ is the inertia of the shafts that are there, $J_upright(f)$ that of the flywheel."
    )
    blocks: list[Block] = [Paragraph(meaning), Formula(tuple(lines))]
    for title, wheel in ((_("A rim:"), found.rim), (_("A disc:"), found.disc)):
        if wheel is not None:
            blocks += [Paragraph(title), Formula(tuple(_sizes(study, wheel, machine.flywheel.density)))]
    return blocks


def _sizes(study: ReportStudy, wheel: Wheel, density: float) -> Lines:
    """Outer diameter, bore, width and mass, and the inertia that they have."""
    numbers = in_si(study.numbers)
    lines: Lines = [
        ("rho", with_unit(numbers, density, "kg/m^3")),
        ("D", with_unit(numbers, wheel.outer, "m")),
    ]
    if wheel.inner:
        lines.append(("d", with_unit(numbers, wheel.inner, "m")))
    lines.append(("b", with_unit(numbers, wheel.width, "m")))
    hole = " - d^%d" if wheel.inner else ""
    four, two = (f"(D^{power}{hole % power if hole else ''})" if hole else f"D^{power}" for power in (4, 2))
    lines.append(("m", f"frac(pi, 4) rho b {two}", with_unit(numbers, wheel.mass, "kg")))
    lines.append(("J_upright(f)", f"frac(pi, 32) rho b {four}", with_unit(numbers, wheel.inertia, "kg m^2")))
    return lines


def _energy_check(study: ReportStudy, found: Flywheel) -> list[Check]:
    """Kinetic energy at the real speed less the works has to stay what it is over the cycle."""
    steady = machine_of(study).steady
    kinetic = 0.5 * (steady.attrs["inertia"] + steady["inertia_of_links"]) * steady["drive_speed"] ** 2
    energy = (kinetic - steady["work"]).to_numpy()
    size = float(kinetic.max())
    allowed = 2.0 * found.error / size + 64.0 * float(np.finfo(float).eps)
    text = _(
        "Kinetic energy at the real speed less the works stays the same over the cycle to {share} of it."
    )
    return [measured(text, float(np.ptp(energy)), size, allowed)]


def _fluctuation_check(found: Flywheel) -> list[Check]:
    """The fluctuation that the energy equation gives with the inertia found, where a wheel is needed."""
    if not found.added or found.fluctuation is None or found.inertia is None:
        return []
    off = abs(found.obtained - found.fluctuation)
    # an error of the works moves speeds by its share of the energy, extremes of the mesh by the square root of rounding
    share = 2.0 * found.error / (found.inertia * found.mean_speed**2)
    allowed = share / found.fluctuation + float(np.sqrt(np.finfo(float).eps))
    text = _("The speed that this inertia gives fluctuates as asked to {share} of the coefficient.")
    return [measured(text, off, found.fluctuation, allowed)]


def _figures(study: ReportStudy) -> list[Block]:
    captions = {
        "moments": _("Moments on the drive and inertia of the links"),
        "works": _("Works over the cycle"),
        "energies": _("Energies over the cycle"),
        "wittenbauer": _("Wittenbauer's diagram: work over the inertia of the links, with both tangents"),
    }
    drawn = study.once("machine figures", lambda: machine_figures(study.mechanism, machine_of(study).steady))
    return [*pictures(drawn, captions)]
