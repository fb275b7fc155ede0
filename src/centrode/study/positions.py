"""A plan of positions in words."""

from __future__ import annotations

from centrode.analysis.position_plan import PositionPlan
from centrode.errors import Status
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text


def plan_rows(mechanism: Mechanism, plan: PositionPlan) -> list[tuple[str, str]]:
    """Number of positions, where they begin and by what, and where else the link stands still."""
    parameter, data = mechanism.motion_parameter, plan.positions
    values = parameter.instants(data)

    def shown(value: float) -> str:
        return value_text(value, parameter.instant.unit, mechanism.display)

    reached = int((data["status"].to_numpy() == Status.OK).sum())
    rows = [
        (_("positions"), _("{count}, {reached} of them reached").format(count=len(values), reached=reached))
    ]
    if plan.link:
        rows.append(
            (_("position 0"), _("{link} at rest at {value}").format(link=plan.link, value=shown(plan.zero)))
        )
        rows.append((_("at rest at"), "; ".join(shown(value) for value in plan.extremes)))
    else:
        rows.append((_("position 0"), shown(plan.zero)))
    rows.append((_("step"), shown(float(values[1] - values[0]))))
    ends = _("{first} to {last}").format(first=shown(float(values[0])), last=shown(float(values[-1])))
    return [*rows, (_("range"), _("a full turn") if plan.closed else ends)]
