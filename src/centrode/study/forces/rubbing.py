"""What is said of friction by coefficients: what it takes at each contact, the efficiency, where it holds or jams."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.locale import _, ngettext
from centrode.model.labels import reaction_name

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
Table: TypeAlias = tuple[list[str], list[list[str]]]
HELD = 1


def friction_rows(found: xarray.Dataset) -> Rows:
    """Efficiency over the samples, where loads no longer drive, what does not move, and how friction was found."""
    if "friction" not in found.dims:
        return []
    rows = []
    mean = found.attrs["efficiency"]
    if np.isfinite(mean):
        rows.append((_("overall efficiency"), f"{mean:.4f}"))
    held = int((found["self_locking"] == HELD).sum())
    if held:
        text = ngettext("{n} sample: loads do not drive it", "{n} samples: loads do not drive it", held)
        rows.append((_("held by friction"), text.format(n=held)))
    turning = int((found["friction_turns"] != 0).any("friction").sum())
    if turning:
        text = ngettext(
            "{n} sample, told as just after it", "{n} samples, each told as just after it", turning
        )
        rows.append((_("friction turns round"), text.format(n=turning)))
    if found.attrs["standing"]:
        text = _("{contacts}: nothing moves there, friction is taken as 0")
        contacts = ", ".join(map(reaction_name, found.attrs["standing"].split("; ")))
        rows.append((_("no friction"), text.format(contacts=contacts)))
    text = _("off by {share:.1e} after at most {n} steps")
    residual, steps = found.attrs["friction_residual"], found.attrs["friction_iterations"]
    rows.append((_("friction against reactions"), text.format(share=residual, n=steps)))
    return rows


def friction_losses(found: xarray.Dataset) -> Table | None:
    """Header and rows: greatest power and work of friction at each contact, and its share; None without friction."""
    if "friction" not in found.dims:
        return None
    header = [_("friction at"), _("greatest power, W"), _("work, J"), _("share, %")]
    works = found["friction_work"].to_numpy()
    known = np.isfinite(works).all() and works.sum() != 0.0
    rows = []
    for k, label in enumerate(found["friction"].to_numpy().tolist()):
        power = found["friction_power"].to_numpy()[:, k]
        greatest = f"{np.nanmax(power):.6g}" if np.isfinite(power).any() else ""
        work = f"{works[k]:.6g}" if np.isfinite(works[k]) else ""
        rows.append(
            [reaction_name(label), greatest, work, f"{100.0 * works[k] / works.sum():.2f}" if known else ""]
        )
    return header, rows
