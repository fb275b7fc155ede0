"""The instants of a report: places on the motion that tables, formulas with numbers and diagrams are made for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from centrode.errors import Status
from centrode.kinematics.motion import initial_place, motion
from centrode.locale import _
from centrode.quantities import status_word
from centrode.render.document.numbers import Numbers
from centrode.report.study import ReportStudy


@dataclass(frozen=True)
class Moment:
    """One instant.

    Attributes
    ----------
    data, sample : the motion that has it, and where
    at : what `motion` is asked for it: a value of the drive, with a law or several drives a time
    title : "OA = 90°"
    status : of the sample
    """

    data: xr.Dataset
    sample: int
    at: float
    title: str

    @property
    def status(self) -> Status:
        """What the sample is worth."""
        return Status(int(self.data["status"][self.sample]))

    @property
    def reached(self) -> bool:
        """Whether everything is known there."""
        return self.status == Status.OK

    @property
    def missing(self) -> str:
        """Why there is nothing to tell of it."""
        sentence = _("At {place} the sample is {status}: there are no velocities to be told.")
        return sentence.format(place=self.title, status=status_word(self.status))


def moments_of(study: ReportStudy) -> tuple[Moment, ...]:
    """The instants asked for; else the initial position, or the first sample that is reached."""
    return study.once("moments", lambda: tuple(_moments(study)))


def _moments(study: ReportStudy) -> list[Moment]:
    mechanism = study.mechanism
    wished = dict.fromkeys(study.wishes.instants)
    parameter = mechanism.motion_parameter
    if not wished:
        places = [initial_place(mechanism)]
    elif not parameter.states_instants:
        # a law may pass a value more than once, so the nearest samples have to do
        values = parameter.values(study.motion)
        nearest = dict.fromkeys(int(np.argmin(np.abs(values - value))) for value in wished)
        places = [float(study.motion["time"][sample]) for sample in nearest]
    else:
        places = list(wished)
    data = motion(mechanism, at=places)
    return [Moment(data, k, at, _title(study, data, k)) for k, at in enumerate(places)]


def _title(study: ReportStudy, data: xr.Dataset, sample: int) -> str:
    numbers = study.numbers
    values = data["drive_value"].to_numpy()[sample]
    told = [
        f"{drive.id} = {drive_value_text(float(value), study.mechanism.motion_parameter.drive(drive.id).unit, numbers)}"
        for drive, value in zip(study.mechanism.drives, values, strict=True)
    ]
    if not study.mechanism.motion_parameter.is_uniform:
        told.insert(0, f"t = {numbers.measured(float(data['time'][sample]), 's')}")
    return ", ".join(told)


def drive_value_text(value: float, unit: str, numbers: Numbers) -> str:
    """A value of a drive with its unit; radians also in degrees, as a person thinks of them."""
    text = numbers.measured(value, unit)
    if unit == "rad" and str(numbers.display.angle) == "rad" and value:
        return f"{text} ({numbers.plain(float(np.degrees(value)))}°)"
    return text
