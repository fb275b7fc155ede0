"""What one wants: the request of a synthesis, in files and as tables.

A file has a table [synthesis] and either names a built-in topology there or describes the mechanism whose numbers are
sought in its other tables.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import AfterValidator, BeforeValidator, PlainValidator, model_validator

from centrode.errors import InputError
from centrode.locale import _, mark, ngettext
from centrode.model.description_files import DescriptionFiles
from centrode.model.files import mechanism_from
from centrode.model.mechanism import Mechanism
from centrode.model.reading import (
    KEY,
    DescriptionPart,
    FrozenMap,
    Problem,
    choice,
    named_entries,
    nearest,
    value_text,
)
from centrode.model.settings import Display, GearReportWishes, whole_number
from centrode.model.toml import SYNTHESIS, description_kind, refuse_other_kind
from centrode.model.values import (
    READING,
    BareAngles,
    Flag,
    Name,
    Rows,
    TableColumns,
    Text,
    numbers,
    positive,
    quantity,
    read_rows,
    si,
)

Kind: TypeAlias = Literal["path", "function", "motion", "strokes"]
KINDS: tuple[Kind, ...] = ("path", "function", "motion", "strokes")
FOUR_BARS = ("crank-rocker", "double-rocker", "drag-link")
"""Topologies of the four-bar linkage O-A-B-D: the lengths say which type it becomes."""
STROKE_TOPOLOGIES = (
    "slider-crank-offset",
    "crank-rocker",
    "shaper",
    "whitworth-quick-return",
    "six-bar-press",
)
SPHERICAL = ("spherical-four-bar", "spherical-crank-rocker")
"""Topologies of the spherical four-bar linkage O-A-B-D."""
TOPOLOGIES = tuple(dict.fromkeys((*FOUR_BARS, *SPHERICAL, *STROKE_TOPOLOGIES)))
MOST_FREE = 40
MOST_TARGETS = 2000
MOST_POSES = 5
"""Poses that a four-bar linkage can pass through exactly."""
MOST_ANSWERS = 8

Interval: TypeAlias = tuple[float, float]


def _interval(value: object, kind: str) -> Interval:
    low, high = numbers(value, (kind, kind), _("[least, greatest]"))
    if not low <= high:
        what = _("{key} goes from {low:g} to {high:g}: the first has to be the smaller one")
        raise Problem(what.format(key=KEY, low=low, high=high), _("exchange them"))
    return low, high


def _interval_of(kind: str) -> PlainValidator:
    return PlainValidator(lambda value: _interval(value, kind))


def _read_free(value: object) -> Mapping[str, object]:
    def path(key: object) -> str:
        if not isinstance(key, str) or len(key) > 200:
            raise Problem(_("a path is a text, such as links.DB.length"))
        return key

    return named_entries(_flat(value), path, MOST_FREE)


def _flat(value: object, above: str = "") -> object:
    """Tables in tables as one table of dotted paths: TOML reads links.DB.length as three of them."""
    if not isinstance(value, Mapping):
        return value
    found: dict[str, object] = {}
    for key, entry in value.items():
        path = f"{above}.{key}" if above else str(key)
        if isinstance(entry, Mapping):
            inner = _flat(entry, path)
            assert isinstance(inner, Mapping)
            found |= inner
        else:
            found[path] = entry
    return found


def _transmission(value: object, kind: str) -> float:
    number = positive(value, kind)
    if number >= math.pi / 2:
        what = _("{key} must be smaller than 90 deg, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what)
    return number


def _ratio(value: object) -> float:
    number = si(value, "ratio")
    if not number >= 1.0:
        what = _("{key} must be at least 1, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what)
    return number


class PivotBox(DescriptionPart):
    """Where fixed hinges may stand: x and y [m] in the plane, longitude and latitude [rad] on the sphere."""

    x: Annotated[Interval, _interval_of("length")] | None = None
    y: Annotated[Interval, _interval_of("length")] | None = None
    longitude: Annotated[Interval, _interval_of("angle")] | None = None
    latitude: Annotated[Interval, _interval_of("angle")] | None = None


class Constraints(DescriptionPart):
    """What every answer has to keep.

    Attributes
    ----------
    crank : link that turns fully
    transmission : least transmission angle [rad]
    order : targets are passed in their order, on one branch and one circuit
    length_ratio : of the longest to the shortest link, at most
    pivots : PivotBox
    size : width and height [m] of a box that holds the whole mechanism in every position
    """

    crank: Name | None = None
    transmission: Annotated[float, quantity("angle", _transmission)] | None = None
    order: Flag = True
    length_ratio: Annotated[float, PlainValidator(_ratio)] | None = None
    pivots: PivotBox = PivotBox()
    size: Annotated[tuple[float, ...], PlainValidator(lambda value: _size(value))] | None = None


def _size(value: object) -> tuple[float, ...]:
    width, height = numbers(value, ("length", "length"), _("[width, height]"))
    if min(width, height) <= 0:
        raise Problem(_("a box has a positive width and height"))
    return width, height


class DwellRequest(DescriptionPart):
    """How an output rests.

    Attributes
    ----------
    value : where it rests [SI]; None: anywhere
    range : values of the drive [rad] between which it does
    """

    value: Annotated[float, PlainValidator(lambda value: _dwell_value(value))] | None = None
    range: Annotated[Interval, PlainValidator(lambda value: _dwell_range(value))]


def _dwell_value(value: object) -> float:
    kind = "angle" if isinstance(value, str) and value.strip().endswith(("deg", "rad")) else "length"
    return si(value, kind)


def _dwell_range(value: object) -> Interval:
    low, high = _interval(value, "angle")
    if not 0 < high - low < 2 * math.pi:
        raise Problem(_("a dwell lies between two angles less than a turn apart"))
    return low, high


class Synthesis(DescriptionPart):
    """What is wanted of a mechanism.

    Attributes
    ----------
    kind : "path", "function", "motion" or "strokes"
    topology : a built-in mechanism; None where the file describes one
    point : traced point of a path
    link : that is led through poses
    of : what a function gives, as "angle.DB"
    targets : rows [SI]; of a path x, y and the drive's angle, of a motion x, y, angle of the link and of the drive, of
        a function the angles of crank and rocker
    formula : y(x) of a function, over x
    swings : of crank and rocker [rad] over the range of a function
    timing : whether crank angles are free, given, or given but for their zero
    place : whether the mechanism may stand anywhere, or only where `free` leaves it; the latter is the default of the
        links of a file
    closed : whether a path is closed; None: as its points look
    exact : of a function: how many precision points, None for the least greatest error
    hinges : given fixed hinges [m] of three poses
    free : path -> least and greatest value [SI]
    guide, stroke, time_ratio, transmission, swing : of strokes
    dwell : of strokes of a mechanism of a file: where and between which values of the drive the output rests
    length : of the frame of a function, of the rocker of a crank-rocker, of the frame or the crank of a quick
        return [m]
    trade_off : of paths: "size" or "transmission", against which answers trade their error
    answers : at most so many
    seed : of random starts
    """

    kind: Annotated[Kind, choice(*KINDS)]
    topology: Text | None = None
    point: Name = "P"
    link: Name = "AB"
    of: Text = "angle.DB"
    targets: object = None
    formula: Text | None = None
    x: Annotated[Interval, _interval_of("ratio")] | None = None
    swings: Annotated[tuple[float, float], PlainValidator(lambda v: _swings(v))] | None = None
    timing: Annotated[Literal["free", "given", "phase"], choice("free", "given", "phase")] = "free"
    place: Annotated[Literal["free", "given"], choice("free", "given")] = "free"
    closed: Flag | None = None
    exact: Annotated[int, whole_number(3, 5)] | None = None
    hinges: Annotated[tuple[tuple[float, float], ...], BeforeValidator(lambda v: _hinges(v))] | None = None
    free: Annotated[Mapping[str, Any], BeforeValidator(_read_free), AfterValidator(FrozenMap[str, Any])] = (
        FrozenMap({})
    )
    constraints: Constraints = Constraints()
    guide: Name | None = None
    stroke: Annotated[float, quantity("length", positive)] | None = None
    time_ratio: Annotated[float, PlainValidator(_ratio)] | None = None
    transmission: Annotated[float, quantity("angle", _transmission)] | None = None
    swing: Annotated[float, quantity("angle", positive)] | None = None
    dwell: DwellRequest | None = None
    length: Annotated[float, quantity("length", positive)] | None = None
    trade_off: Annotated[Literal["size", "transmission"], choice("size", "transmission")] | None = None
    answers: Annotated[int, whole_number(1, MOST_ANSWERS)] = MOST_ANSWERS
    seed: Annotated[int, whole_number(0, 2**31)] = 0

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        _check_keys(self)
        if self.kind == "strokes":
            _check_strokes(self)
            return self
        if self.kind == "function" and self.formula is not None:
            if self.targets is not None:
                raise Problem(
                    _("a function has a formula or targets, not both"), _("remove one of them"), ("formula",)
                )
            for key in ("x", "swings"):
                if getattr(self, key) is None:
                    raise Problem(_('"{key}" is missing').format(key=key), _("a formula needs x and swings"))
            return self
        if self.targets is None:
            raise Problem(
                _('"targets" is missing'), _("name a CSV file, or give rows of numbers"), ("targets",)
            )
        object.__setattr__(self, "targets", self._read_targets())
        return self

    @property
    def has_free_place(self) -> bool:
        """Whether the mechanism may stand anywhere: links of a file stand where they are, unless the file says so."""
        return self.place == "free" and (self.topology is not None or "place" in self.model_fields_set)

    @property
    def rows(self) -> Rows:
        """The targets, read; none of a formula and of strokes."""
        return self.targets if isinstance(self.targets, tuple) else ()

    def _read_targets(self) -> Rows:
        sphere = {
            "path": TableColumns(("angle", "angle", "angle"), "[longitude, latitude, angle of the drive]", 2),
            "motion": TableColumns(
                ("angle",) * 4, "[longitude, latitude, angle of the link from east, angle of the drive]", 3
            ),
        }
        columns = {
            "path": TableColumns(("length", "length", "angle"), "[x, y, angle of the drive]", 2),
            "motion": TableColumns(
                ("length", "length", "angle", "angle"), "[x, y, angle of the link, angle of the drive]", 3
            ),
            "function": TableColumns(
                ("angle", "length" if self.of.startswith(("slide", "position")) else "angle"),
                "[angle of the crank, angle of the rocker]",
                2,
            ),
            **(sphere if self.topology in SPHERICAL else {}),
        }[self.kind]
        try:
            rows = read_rows(self.targets, columns, READING.get().folder)
        except Problem as problem:
            raise Problem(problem.what, problem.repair, ("targets",)) from None
        _check_targets(self.kind, rows)
        timed = len(rows[0]) == len(columns.kinds) if self.kind != "function" else True
        if self.timing != "free" and not timed:
            what = _("timing needs an angle of the drive in every row")
            raise Problem(what, _('add a column, or write timing = "free"'), ("targets",))
        if self.kind != "function" and self.timing != "free" and self.constraints.order:
            _check_order([row[-1] for row in rows])
        return rows


def _swings(value: object) -> tuple[float, float]:
    first, second = numbers(value, ("angle", "angle"), _("[swing of the crank, swing of the rocker]"))
    for swing in (first, second):
        if not 0 < abs(swing) < 2 * math.pi:
            raise Problem(_("a swing lies between 0 and 360 deg"))
    return first, second


def _hinges(value: object) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise Problem(_("expected two points [[x, y], [x, y]], got {value}").format(value=value_text(value)))
    first, second = (numbers(point, ("length", "length"), "[x, y]") for point in value)
    return (first[0], first[1]), (second[0], second[1])


COMMON = ("kind", "topology", "constraints", "answers", "seed")
KEYS: Mapping[Kind, tuple[str, ...]] = {
    "path": ("point", "targets", "timing", "place", "closed", "free", "trade_off"),
    "motion": ("point", "link", "targets", "timing", "place", "hinges", "free", "trade_off"),
    "function": ("of", "targets", "formula", "x", "swings", "exact", "length", "free"),
    "strokes": (
        "of", "guide", "stroke", "time_ratio", "transmission", "swing", "length", "dwell", "targets", "free"
    ),
}  # fmt: skip
"""Keys of [synthesis] that mean something to a kind."""


def _check_keys(wanted: Synthesis) -> None:
    """Refuse keys that would not be heeded."""
    for key in sorted(wanted.model_fields_set):
        foreign = key not in (*COMMON, *KEYS[wanted.kind])
        # closed forms and Freudenstein's equation have no ranges
        unused = key == "free" and wanted.topology is not None and wanted.kind in ("function", "strokes")
        if foreign or unused:
            what = _('"{key}" means nothing to kind = "{kind}"').format(key=key, kind=wanted.kind)
            raise Problem(what, _("remove it"), (key,))
    _check_keys_of_file(wanted)
    crank = wanted.constraints.crank
    if crank not in (None, "OA") and wanted.topology in (*FOUR_BARS, *SPHERICAL):
        what = _("the crank of this topology is {name}").format(name="OA")
        raise Problem(what, _('write crank = "OA", or remove it'), ("constraints", "crank"))
    if wanted.closed and wanted.timing != "free":
        what = _("where angles of the drive are given, they say how the path is passed")
        raise Problem(what, _("remove closed"), ("closed",))
    pivots = wanted.constraints.pivots
    if wanted.topology not in SPHERICAL and (pivots.longitude is not None or pivots.latitude is not None):
        what = _("in the plane fixed hinges have no longitude and latitude")
        raise Problem(what, _("give x and y"), ("constraints", "pivots"))
    if wanted.hinges is not None and isinstance(wanted.targets, list | tuple) and len(wanted.targets) != 3:
        what = _("given hinges need three poses, got {count}").format(count=len(wanted.targets))
        raise Problem(what, _("give three, or remove hinges"), ("hinges",))
    if (
        wanted.exact is not None
        and isinstance(wanted.targets, list | tuple)
        and len(wanted.targets) != wanted.exact
    ):
        what = ngettext(
            "{n} exact point, and a table of {count}",
            "{n} exact points, and a table of {count}",
            wanted.exact,
        )
        what = what.format(n=wanted.exact, count=len(wanted.targets))
        raise Problem(what, _("a table of three to five rows is met exactly: remove exact"), ("exact",))
    if wanted.trade_off is not None and wanted.topology not in FOUR_BARS:
        what = _("a trade-off is found of four-bar linkages in the plane")
        raise Problem(what, _("remove it"), ("trade_off",))


OF_TOPOLOGIES: Mapping[Kind, tuple[str, ...]] = {
    "path": (),
    "motion": ("hinges",),
    "function": ("exact", "length", "formula", "x", "swings"),
    "strokes": ("transmission", "length", "targets"),
}
"""Keys that mean nothing to a mechanism of a file."""
INSTEAD = {
    "hinges": mark("give ranges of the frame's points below [synthesis.free], or bound them by pivots"),
    "exact": mark("remove it: all targets are met as nearly as possible"),
    "length": mark("write it into the mechanism, or bound it below [synthesis.free]"),
    "formula": mark("give targets: values of the drive, and of the output"),
    "x": mark("give targets: values of the drive, and of the output"),
    "swings": mark("give targets: values of the drive, and of the output"),
    "transmission": mark("write it below [synthesis.constraints]"),
    "targets": mark("remove it"),
}


def _check_keys_of_file(wanted: Synthesis) -> None:
    """Refuse keys that belong to built-in topologies where the file describes the mechanism."""
    if wanted.topology is not None:
        return
    for key in OF_TOPOLOGIES[wanted.kind]:
        if key in wanted.model_fields_set:
            what = _('"{key}" belongs to built-in topologies, not to a mechanism of a file').format(key=key)
            raise Problem(what, _(INSTEAD[key]), (key,))


FEWEST = {"path": 3, "function": 3, "motion": 2}


def _check_targets(kind: str, rows: Rows) -> None:
    at = ("targets",)
    least = FEWEST[kind]
    if len(rows) < least:
        what = ngettext(
            "{n} row is too few: at least {least} are needed",
            "{n} rows are too few: at least {least} are needed",
            len(rows),
        )
        raise Problem(what.format(n=len(rows), least=least), "", at)
    if len(rows) > MOST_TARGETS:
        what = _("{count} rows are too many: at most {most} are taken")
        raise Problem(what.format(count=len(rows), most=MOST_TARGETS), _("thin them out"), at)
    for number, row in enumerate(rows, 1):
        if not all(map(math.isfinite, row)):
            raise Problem(_("row {number} is not finite").format(number=number), "", at)
    if kind != "function":
        spread = max(math.hypot(row[0] - rows[0][0], row[1] - rows[0][1]) for row in rows)
        if not spread > 0 and (kind == "path" or len({row[2] for row in rows}) == 1):
            raise Problem(_("all targets are the same"), _("give different ones"), at)
    if kind == "motion":
        for first in range(len(rows)):
            for second in range(first):
                if rows[first][:3] == rows[second][:3]:
                    what = _("poses {first} and {second} are the same")
                    raise Problem(what.format(first=second + 1, second=first + 1), _("remove one"), at)
    if kind == "function":
        angles = [row[0] for row in rows]
        for value in angles:
            if angles.count(value) > 1:
                what = _("an angle of the crank has two values")
                raise Problem(what, _("remove one of them"), at)


def _check_order(angles: Sequence[float]) -> None:
    """Refuse angles of the drive that neither rise nor fall from target to target over at most a turn."""
    for sense in (1.0, -1.0):
        steps = [(sense * (after - before)) % (2 * math.pi) for before, after in pairwise(angles)]
        if sum(steps) <= 2 * math.pi + 1e-9 and all(step > 0 for step in steps[:-1]):
            return
    what = _("the angles of the drive neither rise nor fall from row to row over one turn")
    raise Problem(what, _("sort the rows, or write order = false"), ("targets",))


def _check_strokes(wanted: Synthesis) -> None:
    if wanted.topology is None:
        # the mechanism of the file: which of stroke, time ratio and dwell are given is its matter
        return
    if wanted.dwell is not None:
        what = _("a dwell is that of a mechanism of a file")
        raise Problem(what, _("describe its links, and remove topology"), ("dwell",))
    if wanted.topology not in STROKE_TOPOLOGIES:
        what = _("strokes are synthesised for {names}").format(names=", ".join(STROKE_TOPOLOGIES))
        raise Problem(what, nearest(str(wanted.topology or ""), STROKE_TOPOLOGIES), ("topology",))
    if wanted.targets is not None:
        raise Problem(_("strokes have no targets"), _("remove it"), ("targets",))
    if wanted.topology == "crank-rocker":
        if wanted.swing is None:
            raise Problem(_('"{key}" is missing').format(key="swing"))
    elif wanted.stroke is None:
        raise Problem(_('"{key}" is missing').format(key="stroke"))


class SynthesisTask(DescriptionPart):
    """A request with the mechanism whose numbers are sought, where it is not a built-in topology.

    Attributes
    ----------
    title : str
    display : Display
    report : GearReportWishes
    synthesis : Synthesis
    mechanism : Mechanism or None

    Examples
    --------
    >>> import centrode as ct
    >>> lever = {"kind": "strokes", "topology": "crank-rocker", "swing": "40 deg", "time_ratio": 1.2}
    >>> ct.SynthesisTask(title="Lever", synthesis=lever).synthesis.time_ratio
    1.2
    """

    title: Text = ""
    display: Display = Display()
    report: GearReportWishes = GearReportWishes()
    synthesis: Synthesis
    mechanism: Mechanism | None = None

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...


def read_synthesis(path: str | Path) -> SynthesisTask:
    r"""The request in a TOML file; raises InputError that says where it is wrong.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import centrode as ct
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "lever.toml"
    >>> written = file.write_text('[synthesis]\nkind = "strokes"\ntopology = "shaper"\nstroke = "0.4 m"')
    >>> ct.read_synthesis(file).synthesis.stroke
    0.4
    """
    return SYNTHESES.read(path)


class _SynthesisFiles(DescriptionFiles[SynthesisTask]):
    """Requests of a synthesis as files, with the mechanism whose numbers are sought beside what is wanted."""

    def from_tables(
        self,
        mapping: Mapping[str, Any],
        where: str = "",
        folder: Path | None = None,
        bare_angles: BareAngles = "radians",
    ) -> SynthesisTask:
        """The request that plain dicts and lists as a file's give; raises InputError that starts with `where`."""
        if SYNTHESIS not in mapping:
            if description_kind(mapping) != "linkage":
                refuse_other_kind(mapping, self.kind, where)
            repair = _("write what is wanted below [synthesis]")
            raise InputError(where, _("there is no table [synthesis]"), repair)
        others = {key: value for key, value in mapping.items() if key != SYNTHESIS}
        named = isinstance(mapping[SYNTHESIS], Mapping) and mapping[SYNTHESIS].get("topology") is not None
        kept = {key: mapping[key] for key in ("title", "display", "report", SYNTHESIS) if key in mapping}
        mechanism = None
        if "links" in others:
            if named:
                what = _("the file describes links, and names a topology")
                raise InputError(where, what, _("remove topology, or the links"))
            mechanism = mechanism_from(others, where, folder, bare_angles)
            if isinstance(wishes := kept.get("report"), Mapping):
                # instants and the like are those of a mechanism's own report
                kept["report"] = {k: v for k, v in wishes.items() if k in GearReportWishes.model_fields}
        elif not named:
            what = _("the structure that is sought is not given")
            repair = _('name a topology, as topology = "crank-rocker", or describe links')
            raise InputError(where, what, repair)
        elif unknown := [key for key in others if key not in kept]:
            what = _("unknown key {key}").format(key=value_text(unknown[0]))
            raise InputError(where, what, nearest(unknown[0], ("title", "display", "report", SYNTHESIS)))
        task = super().from_tables(kept, where, folder, bare_angles)
        return task.model_copy(update={"mechanism": mechanism})


SYNTHESES = _SynthesisFiles(SYNTHESIS, lambda _tables, _where: SynthesisTask)
"""Requests of a synthesis in files."""
