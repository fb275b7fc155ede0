"""A result of any topic: in words, in tables, in figures, as files of a folder, and read from a file again.

A result is what a topic computes, its dataset, which names its topic and holds its description as text, or a value
that a plain function of the topic returns and that knows its mechanism or its cam.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from centrode import render
from centrode.errors import InputError
from centrode.files.drafts import draft_folder
from centrode.locale import _, mark
from centrode.topics.registry import TOPICS
from centrode.topics.sheets import sheet_with_parts, topic_of
from centrode.topics.topic import Lazily

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from centrode.model.cam_files import AnyCam
    from centrode.model.gear_pairs import GearPair
    from centrode.model.gear_trains import GearTrain
    from centrode.model.mechanism import Display, Mechanism
    from centrode.sheets.sheet import Sheet, Table


PARSERS = {
    "mechanism": Lazily("centrode.model.files", "parse_mechanism"),
    "cam": Lazily("centrode.model.cam_files", "parse_cam"),
}
"""What reads the description of a dataset."""
WITH_DRIVES = Lazily("centrode.kinematics.sample_index", "with_drive_coordinates")
WHOLE = mark("show a dataset as it was computed, with its attributes")
RESTORED = {topic.name: topic for topic in TOPICS if topic.restore is not None}
"""Topics whose results are made from their datasets."""
VALUES = {(topic.value.module, topic.value.name): topic for topic in TOPICS if topic.value is not None}
"""Module and name of the class of a value -> its topic."""


@dataclass(frozen=True, repr=False)
class Result:
    """A dataset of a topic that prints its summary.

    Attributes
    ----------
    dataset : Dataset
        With the attributes `topic` and `mechanism`, or `cam`.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.Result(ct.transmission_angles(ct.example("crank-rocker"), 73)))
    group  least transmission angle, deg  greatest transmission angle, deg  greatest pressure angle, deg
    AB-DB                        54.3147                           90.0000                       35.6853
    """

    dataset: xarray.Dataset

    def __repr__(self) -> str:
        return summary(self)


def is_result(dataset: Any) -> bool:
    """Whether a dataset names its topic and holds its description."""
    attributes = getattr(dataset, "attrs", None)
    if not isinstance(attributes, dict) or attributes.get("topic") not in RESTORED:
        return False
    return isinstance(attributes.get(_key_of_description(attributes["topic"])), str)


def _key_of_description(topic: str) -> str:
    """The attribute in which a dataset of a topic holds its description."""
    return "cam" if RESTORED[topic].subject == "cam" else "mechanism"


def restored_result(result: Any) -> Any:
    """The result of a dataset or a value, where what it does not hold is computed; any other result as it is.

    Raises InputError for a dataset that does not name its topic, or lacks a part, and for a value without description.
    """
    dataset = result.dataset if isinstance(result, Result) else result
    if not isinstance(getattr(dataset, "attrs", None), dict):
        return _completed_value(dataset)
    if not is_result(dataset):
        raise InputError("dataset", _("it names no topic, or no description"), _(WHOLE))
    topic = RESTORED[dataset.attrs["topic"]]
    assert topic.restore is not None
    try:
        return topic.restore(_parsed_description(dataset), dataset)
    except (KeyError, AttributeError) as absent:
        raise _incomplete(absent) from absent


def _completed_value(value: Any) -> Any:
    """The result of a value that a plain function returns; anything else as it is."""
    kind = type(value)
    topic = VALUES.get((kind.__module__, kind.__qualname__))
    if topic is None or topic.complete is None:
        return value
    description = getattr(value, "mechanism", None) or getattr(value, "cam", None)
    if description is None:
        what = _("it knows no description")
        raise InputError(kind.__name__, what, _("show what was computed from a mechanism or a cam"))
    return topic.complete(description, value)


def _parsed_description(dataset: xarray.Dataset) -> Mechanism | AnyCam:
    """The mechanism or cam that a dataset of a result holds as text."""
    key = _key_of_description(dataset.attrs["topic"])
    return cast("Mechanism | AnyCam", PARSERS[key](dataset.attrs[key]))


def _incomplete(absent: Exception) -> InputError:
    """The refusal of a dataset that lacks a variable or a dimension."""
    return InputError("dataset", _("it lacks a part: {what}").format(what=absent), _(WHOLE))


def sheet_of(result: Any) -> Sheet:
    """What there is to say about a result and its parts, as data; InputError for what is no result of a topic."""
    dataset, result = result, restored_result(result)
    topic = topic_of(result)
    try:
        return sheet_with_parts(topic, result)
    except KeyError as absent:
        if result is dataset:  # of a result that was computed nothing is missing
            raise
        raise _incomplete(absent) from absent


def display_of(result: Any) -> Display:
    """The units of the description that a result knows."""
    return description_of(result).display


def description_of(result: Any) -> Mechanism | AnyCam | GearPair | GearTrain:
    """The mechanism, the cam, the pair or the train of gears that a result knows."""
    dataset = result.dataset if isinstance(result, Result) else result
    if is_result(dataset):
        return _parsed_description(dataset)
    known = (
        getattr(result, name, None) for name in ("mechanism", "cam", "gear_pair", "gear_train", "described")
    )
    return cast("Mechanism | AnyCam | GearPair | GearTrain", next(one for one in known if one is not None))


def summary(result: Any) -> str:
    """The facts of a result as lines of text, with the tables that a terminal prints.

    They are in the language that is spoken and the units of the result's description.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.summary(ct.limits(ct.example("crank-rocker"))))
    drive          OA
    held drives    none
    initial value  0 rad (0 deg)
    from           unlimited
    to             unlimited
    change points  none
    """
    return render.sheet_text(sheet_of(result), display_of(result))


def page(result: Any, kind: str) -> str:
    """What a terminal prints of a result, under the title of its description, as a document.

    Parameters
    ----------
    kind : "txt", "tex" or "md"
        Plain text, a LaTeX document (amsmath), or Markdown.
    """
    description = description_of(result)
    return render.page_text(sheet_of(result), _(description.title), kind, description.display)


def tables(result: Any) -> Mapping[str, Table]:
    """The tables of a result by name; columns are arrays in SI.

    Examples
    --------
    >>> import centrode as ct
    >>> list(ct.tables(ct.transmission_angles(ct.example("crank-rocker"), 37)))
    ['transmission']
    """
    return sheet_of(result).tables


def figures(result: Any) -> dict[str, Figure]:
    """The figures of a result by name; needs matplotlib.

    Examples
    --------
    >>> import centrode as ct
    >>> list(ct.figures(ct.transmission_angles(ct.example("crank-rocker"), 37)))
    ['transmission']
    """
    return render.figures_of(sheet_of(result).pictures, display_of(result))


def write(result: Any, folder: str | Path) -> None:
    """Write tables, datasets, figures and the summary of a result into a folder, which appears whole or not at all.

    A result without single numbers has no summary. Raises InputError where the folder cannot be written.

    Examples
    --------
    >>> import centrode as ct
    >>> from pathlib import Path
    >>> ct.write(ct.integrate(ct.example("crank-rocker"), steps=20), "integration")
    >>> (Path("integration") / "integration.csv").exists()
    True
    """
    sheet, display = sheet_of(result), display_of(result)
    with draft_folder(Path(folder)) as draft:
        render.write_tables(sheet, draft, display)
        render.write_pictures(sheet.pictures, draft, display)
        if sheet.scalars:
            render.write_summary(sheet.scalars, draft / "summary.json")


def open(path: str | Path) -> xarray.Dataset:
    """A dataset of a result from the netCDF file that a command or `ct.write` wrote.

    Raises InputError for a file that cannot be read, and for one that is not a result of centrode.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.write(ct.transmission_angles(ct.example("crank-rocker"), 37), "angles")
    >>> ct.open("angles/transmission.nc").attrs["topic"]
    'angles'
    """
    dataset = render.read_dataset(Path(path))
    if not is_result(dataset):
        what = _("it is not a result: it names no topic, or no description")
        raise InputError(str(path), what, _("name a netCDF file that a command has written"))
    return cast("xarray.Dataset", WITH_DRIVES(dataset))
