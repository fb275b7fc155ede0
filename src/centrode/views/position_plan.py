"""The plan of positions: what the terminal, the file, the page and the document show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.sheets.pages import PositionsPage
from centrode.sheets.sheet import Chapter, Column, Fact, FactTable, Illustration, Section, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text
from centrode.views.columns import motion_table
from centrode.views.instants import place_number

if TYPE_CHECKING:
    from centrode.analysis.position_plan import PositionPlan

TITLE = Sentence("Plan of positions")


def sheet(plan: PositionPlan) -> Sheet:
    """Where the positions begin and by what, the motion at them, the page and the chapter."""
    facts = tuple(_facts(plan))
    return Sheet(
        facts=facts,
        tables={"positions": motion_table(plan.positions, plan.mechanism.moving_points)},
        pictures={"plan": _page(plan)},
        chapters={"positions": _chapter(plan, facts)},
    )


def _facts(plan: PositionPlan) -> list[Fact]:
    """Number of positions, where they begin and by what, and where else the link stands still."""
    parameter = plan.mechanism.motion_parameter
    values = parameter.instants(plan.positions)

    def shown(value: float) -> Number:
        return place_number(value, parameter.instant.unit)

    reached = int((plan.positions["status"].values == Status.OK).sum())
    first = Sentence("position {number}", number=Number(0, digits="d"))
    facts = [Fact(Sentence("positions"), _count_of_reached(len(values), reached))]
    if plan.link:
        at_rest = Sentence(
            "extreme position of {link} at {value}", link=Name(plan.link), value=shown(plan.zero)
        )
        facts.append(Fact(first, at_rest))
        facts.append(
            Fact(Sentence("extreme positions"), Joined([shown(value) for value in plan.extremes], "; "))
        )
    else:
        facts.append(Fact(first, shown(plan.zero)))
    along = parameter.instants(plan.path)
    step = (along[-1] - along[0]) / len(values) if plan.closed else values[1] - values[0]
    facts.append(Fact(Sentence("step"), shown(float(step))))
    ends = Sentence("{first} to {last}", first=shown(float(values[0])), last=shown(float(values[-1])))
    return [*facts, Fact(Sentence("range"), Sentence("a full turn") if plan.closed else ends)]


def _count_of_reached(positions: int, reached: int) -> Text:
    count = Number(positions, digits="d")
    if reached == positions:
        return Sentence("{count}, all reached", count=count)
    if not reached:
        return Sentence("{count}, none reached", count=count)
    return Sentence("{count}, {reached} of them reached", count=count, reached=Number(reached, digits="d"))


def _page(plan: PositionPlan) -> PositionsPage:
    note: Text = NOTHING
    if plan.link:
        note = Sentence("{number}: {link} at rest", number=Number(0, digits="d"), link=Name(plan.link))
    return PositionsPage(TITLE, plan.mechanism, plan.positions, plan.path, _numbered_points(plan), note)


def _numbered_points(plan: PositionPlan) -> tuple[str, ...]:
    """The points whose paths carry numbers: of the driven link, and of the link that stops."""
    mechanism = plan.mechanism
    guides = {guide.id: guide.point for guide in mechanism.guides}
    drive = mechanism.drives[0]
    sources = [drive.link or "", drive.guide or "", *(drive.distance or ())[1:], plan.link]
    moving = set(mechanism.moving_points)
    found = []
    for name in sources:
        points = [guides[name]] if name in guides else []
        if name in mechanism.links:
            points = list(mechanism.links[name].coordinates)
        if name in moving:
            points = [name]
        found += [point for point in points if point in moving][-1:]
    return tuple(dict.fromkeys(found))


def _chapter(plan: PositionPlan, facts: tuple[Fact, ...]) -> Chapter:
    """How the positions were chosen, the plan drawn, and the positions of the points as a table."""
    return Chapter(TITLE, (Section(NOTHING, (FactTable(facts), Illustration("plan"), _table(plan))),))


def _table(plan: PositionPlan) -> Table:
    """The places of the points in the positions, which are numbered from zero."""
    data = plan.positions
    drive = plan.mechanism.motion_parameter.drives[0]
    count = data.sizes["sample"]
    ok = data["status"].values == Status.OK
    columns = [
        Column(
            "position",
            tuple(Number(number, digits="d") for number in range(count)),
            head=Sentence("position"),
        ),
        Column(f"drive_{drive.name}", data["drive_value"].values[:, 0], drive.unit, Name(drive.label)),
    ]
    for point in plan.points or _numbered_points(plan):
        place = np.where(ok[:, None], data["position"].sel(point=point).values, np.nan)
        columns += [
            Column(f"{axis}_{point}", place[:, number], "m", Symbol(axis, point))
            for number, axis in enumerate("xy")
        ]
    return Table(tuple(columns), Sentence("Points in the positions"))
