"""Tables of a motion in a document: instant by instant, then in evenly spaced rows as assignments print them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.kinematics.rigid_body_checks import rigid_body_checks
from centrode.model.mechanism import FRAME
from centrode.quantities import QUANTITIES, STATUS_WORDS
from centrode.sheets.sheet import Block, Chapter, Check, Column, Paragraph, Reference, Section, Table
from centrode.sheets.texts import NOTHING, Counted, Expression, Joined, Name, Number, Sentence, Slanted, Text
from centrode.views.columns import rows_reached
from centrode.views.instants import instant_title

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.motion_results import MotionResults
    from centrode.kinematics.rigid_body_checks import RigidBodyCheck

Array: TypeAlias = NDArray[np.float64]

ROWS = 37
"""Rows of a table over the whole motion: every ten degrees of a turn."""
WIDE = 9
"""Columns of a table that still fit across a page."""
STILL = 1e-12
"""Share of the greatest number of its kind by which a number may change that stays the same."""
CLOSED = 1e-9
"""Residual over the greatest length below which a sample is closed."""
MOST = 4
"""Links, and guides, that a table of a whole motion on the sphere has."""
RATES = (("velocity", "v"), ("acceleration", "a"))
TURNING = (("angle", "phi"), ("angular_velocity", "omega"), ("angular_acceleration", "epsilon"))
FORMULAS = Reference(
    Sentence("Angular velocities follow from {rates}, angular accelerations from {accelerations}.")
)


def tables_chapter(results: MotionResults, shown: xarray.Dataset, head: Sequence[Block]) -> Chapter:
    """Range and limits (`head`), tables of the instants `shown`, tables over the motion, checks."""
    on_sphere = results.mechanism.space == "sphere"
    rows = rows_reached(results.motion["status"], ROWS)
    instants = (
        section for sample in range(shown.sizes["sample"]) for section in _at_instant(results, shown, sample)
    )
    whole = [_hinges_over_motion(results, rows)] if on_sphere else _over_motion(results, rows)
    title = (
        Sentence("The part of the motion that is reached")
        if results.unreached_samples
        else Sentence("The whole motion")
    )
    return Chapter(
        Sentence("Tables of the motion"),
        (
            Section(Sentence("Range"), (*head, *([] if on_sphere else [FORMULAS]))),
            *instants,
            Section(title, tuple(whole)),
            Section(Sentence("Checks"), tuple(_checks(results))),
            *([] if on_sphere else [Section(NOTHING, (_rows_shown(results, rows),), detail=True)]),
        ),
    )


def _at_instant(results: MotionResults, shown: xarray.Dataset, sample: int) -> Iterator[Section]:
    """Links, points and guides at one instant, and their kinematic coefficients."""
    yield Section(instant_title(results.mechanism, shown, sample), tuple(_instant(results, shown, sample)))
    here = shown.isel(sample=sample)
    reached = Status(int(here["status"])) == Status.OK
    if reached and results.mechanism.space == "plane" and "velocity_coefficient" in here:
        points = _coefficients_of_points(here.sel(point=list(results.mechanism.moving_points)))
        yield Section(NOTHING, (_coefficients_of_links(here), points), detail=True)


def _instant(results: MotionResults, shown: xarray.Dataset, sample: int) -> Iterator[Block]:
    """Links, points and guides at one instant."""
    status = Status(int(shown["status"][sample]))
    if status != Status.OK:
        text = Sentence(
            "At {place} the sample is {status}: the velocities are not defined.",
            place=instant_title(results.mechanism, shown, sample),
            status=Sentence(STATUS_WORDS[status]),
        )
        yield Paragraph(text)
        return
    here, points = shown.isel(sample=sample), results.mechanism.moving_points
    if results.mechanism.space == "sphere":
        yield from _hinges(here)
        yield _rotations(here)
        yield _points_on_sphere(here.sel(point=list(points)))
        if "polar_angle" in here:
            yield _spherical_coordinates(here.sel(point=list(points)))
        return
    yield _links(here)
    yield _points(here.sel(point=list(points)))
    if here.sizes["guide"]:
        caption = Sentence("Displacements along the guides")
        yield _with_rates(here, "guide", ("slide", "slide_velocity", "slide_acceleration"), "s", caption)


def _column(head: Text, values: xarray.DataArray | Array, unit: str, size: float) -> Column:
    """Numbers [SI]; what is rounding beside the greatest of its kind is zero."""
    numbers = np.asarray(values, dtype=np.float64)
    return Column("", np.where(np.abs(numbers) <= STILL * size, 0.0, numbers), unit, head)


def _greatest(values: xarray.DataArray | Array) -> float:
    return float(np.nanmax(np.abs(np.asarray(values, dtype=np.float64)), initial=0.0))


def _names(labels: xarray.DataArray, head: Sentence) -> Column:
    return Column("", tuple(map(Name, labels.values.tolist())), head=head)


def _unit(values: xarray.DataArray) -> str:
    return str(values.attrs["units"])


# Instants in the plane


def _links(here: xarray.Dataset) -> Table:
    numbers = tuple(Number(k, digits="d") for k in range(1, here.sizes["link"] + 1))
    columns = [
        _column(Expression(letter), here[name], _unit(here[name]), _greatest(here[name]))
        for name, letter in TURNING
    ]
    caption = Sentence("Links: angle, angular velocity, angular acceleration")
    number = Column("", numbers, head=Sentence("number"))
    return Table((number, _names(here["link"], Sentence("link")), *columns), caption)


def _points(here: xarray.Dataset) -> Table:
    """Places, then velocities and accelerations by components and size."""
    columns = [_names(here["point"], Sentence("point"))]
    for name, letter in (("position", ""), *RATES):
        values, size, unit = here[name].values, _greatest(here[name]), _unit(here[name])
        for k, axis in enumerate("xy"):
            head = Expression(f"{letter}_{axis}" if letter else axis)
            columns.append(_column(head, values[:, k], unit, size))
        if letter:
            columns.append(_column(Expression(letter), np.hypot(*values.T), unit, size))
    caption = Sentence("Points: position, velocity and acceleration by components and magnitude")
    return Table(tuple(columns), caption)


def _with_rates(
    here: xarray.Dataset, kind: str, variables: tuple[str, str, str], letter: str, caption: Sentence
) -> Table:
    """A coordinate of each link or guide with its first and second derivative by time."""
    letters = (letter, f"dot({letter})", f"dot.double({letter})")
    columns = [
        _column(Expression(head), here[name], _unit(here[name]), _greatest(here[name]))
        for head, name in zip(letters, variables, strict=True)
    ]
    labels = {"guide": Sentence("guide"), "hinge": Sentence("links")}
    return Table((_names(here[kind], labels.get(kind, Sentence("link"))), *columns), caption)


def _coefficients_of_links(here: xarray.Dataset) -> Table:
    columns = [_names(here["link"], Sentence("link"))]
    for order, (kind, _letter) in enumerate(RATES, start=1):
        values = here[f"angular_{kind}_coefficient"]
        columns.append(_column(Expression("phi" + order * "'"), values, _unit(values), _greatest(values)))
    caption = Sentence(
        "Kinematic coefficients of the links: derivatives of their angles with respect to "
        "the generalised coordinate"
    )
    return Table(tuple(columns), caption)


def _coefficients_of_points(here: xarray.Dataset) -> Table:
    columns = [_names(here["point"], Sentence("point"))]
    for order, (kind, _letter) in enumerate(RATES, start=1):
        values = here[f"{kind}_coefficient"]
        for axis in "xy":
            head = Expression(axis + order * "'")
            columns.append(_column(head, values.sel(axis=axis), _unit(values), _greatest(values)))
    caption = Sentence(
        "Kinematic coefficients of the points: derivatives of their coordinates with respect to "
        "the generalised coordinate"
    )
    return Table(tuple(columns), caption)


# Instants on the sphere


def _hinges(here: xarray.Dataset) -> Iterator[Table]:
    """Angles of the links in their hinges and ways along circles, with rates."""
    if here.sizes["joint"]:
        variables = ("joint_angle", "joint_velocity", "joint_acceleration")
        caption = Sentence("Angles of the links, from their reference arcs")
        yield _with_rates(here, "joint", variables, "psi", caption)
    if "hinge_angle" in here:
        variables = ("hinge_angle", "hinge_velocity", "hinge_acceleration")
        yield _with_rates(here, "hinge", variables, "delta", Sentence("Angles between links at their hinges"))
    if here.sizes["guide"]:
        slides = ("slide", "slide_velocity", "slide_acceleration")
        yield _with_rates(here, "guide", slides, "s", Sentence("Displacements along the circles"))


def _rotations(here: xarray.Dataset) -> Table:
    """Angular velocities and accelerations as vectors in the axes of the frame, with their sizes."""
    columns = [_names(here["link"], Sentence("link"))]
    for name, letter in TURNING[1:]:
        values = here[name].values
        size, unit = _greatest(values), _unit(here[name])
        for k, axis in enumerate(here["axis"].values.tolist()):
            columns.append(_column(Expression(f"{letter}_{axis}"), values[:, k], unit, size))
        columns.append(_column(Expression(letter), np.linalg.norm(values, axis=1), unit, size))
    return Table(tuple(columns), Sentence("Angular velocities and accelerations in the axes of the frame"))


def _spherical_coordinates(here: xarray.Dataset) -> Table:
    """Polar angles and azimuths of the points."""
    angles = (("polar_angle", "theta"), ("azimuth", "phi"))
    columns = [
        _column(Expression(letter), here[name].values, _unit(here[name]), _greatest(here[name]))
        for name, letter in angles
    ]
    caption = Sentence("Spherical coordinates of the points: polar angle from z, azimuth from x towards y")
    return Table((_names(here["point"], Sentence("point")), *columns), caption)


def _points_on_sphere(here: xarray.Dataset) -> Table:
    columns = [_names(here["point"], Sentence("point"))]
    for name, letter in (("position", ""), *RATES):
        values, size, unit = here[name].values, _greatest(here[name]), _unit(here[name])
        for k, axis in enumerate(here["axis"].values.tolist()):
            head = Expression(f"{letter}_{axis}" if letter else axis)
            columns.append(_column(head, values[:, k], unit, size))
    caption = Sentence("Positions, velocities and accelerations of the points on the unit sphere")
    return Table(tuple(columns), caption)


# The whole motion


class _Course(NamedTuple):
    """One quantity over the whole motion."""

    letter: Expression
    unit: str
    values: Array


def _over_motion(results: MotionResults, rows: tuple[int, ...]) -> Iterator[Block]:
    """Angles and rates of the links, then places and rates of the points that are asked for."""
    data = results.motion
    links = data["link"].values.tolist()
    groups = [
        [
            _course(data, name, Expression(f"{letter}_({{k}})", k=Number(k, digits="d")), link=link)
            for k, link in enumerate(links, start=1)
        ]
        for name, letter in TURNING
    ]
    numbered = [Joined((Number(k, digits="d"), Name(name)), " ") for k, name in enumerate(links, start=1)]
    caption = Sentence(
        "Links: angles $phi$, angular velocities $omega$, angular accelerations $epsilon$ ({links})",
        links=Joined(numbered),
    )
    yield from _tables(results, rows, groups, caption)
    groups = [
        [
            _course(data, name, _component(letter, point, axis), point=point, axis=axis)
            for name, letter in (("position", ""), *RATES)
            for axis in "xy"
        ]
        for point in results.points
    ]
    yield from _tables(results, rows, groups, Sentence("Points: positions, velocities, accelerations"))


def _component(letter: str, point: str, axis: str) -> Expression:
    notation = f"{letter}_({{point}} {axis})" if letter else f"{axis}_({{point}})"
    return Expression(notation, point=Slanted(point))


def _course(data: xarray.Dataset, name: str, letter: Expression, **where: str) -> _Course:
    return _Course(letter, QUANTITIES[name].unit, np.asarray(data[name].sel(where), dtype=np.float64))


def _tables(
    results: MotionResults, rows: tuple[int, ...], groups: Sequence[Sequence[_Course]], caption: Sentence
) -> Iterator[Block]:
    """What moves as tables, what belongs together side by side; what stays the same as a sentence."""
    moving: list[list[Column]] = []
    still: list[Text] = []
    for group in groups:
        sizes: dict[str, float] = {}
        for one in group:
            sizes[one.unit] = max(sizes.get(one.unit, 0.0), _greatest(one.values))
        moving.append([])
        for one in group:
            rounding = STILL * sizes[one.unit]
            known = one.values[np.isfinite(one.values)]
            if known.size and float(np.ptp(known)) <= rounding:
                value = 0.0 if abs(known[0]) <= rounding else float(known[0])
                still.append(Joined((one.letter, Number(value, one.unit, digits="")), " = "))
            else:
                moving[-1].append(_column(one.letter, one.values, one.unit, sizes[one.unit]))
    for number, columns in enumerate(_pages(_front(results, rows), moving)):
        more = Sentence("{caption} (continued)", caption=caption) if number else caption
        yield Table(tuple(columns), more, rows)
    if still:
        yield Paragraph(Sentence("Constant over the motion: {quantities}.", quantities=Joined(still)))


def _front(results: MotionResults, rows: tuple[int, ...]) -> list[Column]:
    """Time, values of drives that are no angles of links, and the status where not all rows are in order."""
    data, mechanism = results.motion, results.mechanism
    columns = [_time(data)]
    for k, drive in enumerate(mechanism.drives):
        coordinate = mechanism.motion_parameter.drive(drive.id)
        if drive.link is not None and drive.relative_to == FRAME and not coordinate.is_chosen:
            continue  # its angle stands among those of the links
        columns.append(Column("", data["drive_value"].values[:, k], coordinate.unit, Name(coordinate.label)))
    status = data["status"].values
    if (status[list(rows)] != Status.OK).any():
        words = tuple(Sentence(STATUS_WORDS[Status(code)]) for code in status.tolist())
        columns.append(Column("", words, head=Sentence("status")))
    return columns


def _time(data: xarray.Dataset) -> Column:
    return Column("", data["time"].values, "s", Expression("t"))


def _pages(front: Sequence[Column], groups: Sequence[Sequence[Column]]) -> Iterator[list[Column]]:
    """Groups of columns in as few tables as a page is wide for, each with the front; long groups are cut."""
    room = max(1, WIDE - len(front))
    parts: list[list[Column]] = []
    for group in groups:
        count = -(-len(group) // room)
        for number in range(count):
            piece = group[number * len(group) // count : (number + 1) * len(group) // count]
            if parts and len(parts[-1]) + len(piece) <= room:
                parts[-1] += piece
            else:
                parts.append(list(piece))
    for part in parts:
        yield [*front, *part]


def _hinges_over_motion(results: MotionResults, rows: tuple[int, ...]) -> Table:
    """Angles in the hinges and ways along circles with their rates, at even steps."""
    data, parameter = results.motion, results.mechanism.motion_parameter
    columns = [_time(data)]
    if parameter.is_uniform:
        head = Name(parameter.drives[0].label)
        columns = [Column("", np.asarray(parameter.instants(data)), parameter.instant.unit, head)]
    for kind, value, rate, letter in (
        ("joint", "joint_angle", "joint_velocity", "psi"),
        ("hinge", "hinge_angle", "hinge_velocity", "delta"),
        ("guide", "slide", "slide_velocity", "s"),
    ):
        for name in data[kind].values.tolist()[:MOST] if value in data else ():
            one = data.sel({kind: name})
            for variable, notation in ((value, letter), (rate, f"dot({letter})")):
                below = Expression(f"{notation}_({{name}})", name=Name(name))
                columns.append(Column("", one[variable].values, _unit(one[variable]), below))
    return Table(tuple(columns), Sentence("The motion at equal steps"), rows)


# Checks


def _checks(results: MotionResults) -> Iterator[Block]:
    """Residuals, and identities of rigid bodies."""
    flat = results.mechanism.space == "plane"
    if flat:
        residual = float(results.motion.attrs["worst_residual"])
        closes = Sentence(
            "All constraints hold at every sample that is reached; the worst residual is {value} "
            "of the greatest length ({constraint}).",
            value=Number(residual, digits=".1e"),
            constraint=Name(results.worst_constraint),
        )
        if not residual:
            closes = Sentence("All constraints hold exactly at every sample that is reached.")
        yield Check(closes, residual, 1.0, CLOSED)
    for check in rigid_body_checks(results.mechanism, results.motion):
        yield Check(_identity(check), check.difference, check.size, check.bound)


def _rows_shown(results: MotionResults, rows: tuple[int, ...]) -> Paragraph:
    """How many of the samples the tables show."""
    return Paragraph(
        Counted(
            "The tables show {rows} row of {samples} samples; {sign} marks unknown values.",
            "The tables show {rows} rows of {samples} samples; {sign} marks unknown values.",
            len(rows),
            rows=Number(len(rows), digits="d"),
            samples=Number(results.motion.sizes["sample"], digits="d"),
            sign=Number(np.nan),
        )
    )


def _identity(check: RigidBodyCheck) -> Sentence:
    """An identity of rigid bodies, and how far the motion is from it."""
    off = {
        "off": Number(check.difference / check.size if check.size else 0.0, digits=".1e"),
        "allowed": Number(check.bound, digits=".1e"),
    }
    match check.identity:
        case "velocity":
            return Sentence(
                "Euler's theorem: for all points of each link the velocity is the sum of that of another point "
                "and of the rotation about it; the greatest difference is {off} of the greatest velocity, "
                "{allowed} is allowed.",
                **off,
            )
        case "acceleration":
            return Sentence(
                "The same for accelerations, with their normal and tangential parts: the greatest difference is {off} "
                "of the greatest acceleration, {allowed} is allowed.",
                **off,
            )
        case "arcs":
            return Sentence(
                "The arcs of all links stay constant: their chords deviate by {share} of the sphere's radius."
            )
        case "rotation":
            return Sentence(
                "The velocity of every point of a link agrees with the link's rotation, $arrow(v) = arrow(omega) "
                "times arrow(r)$, within {share}."
            )
