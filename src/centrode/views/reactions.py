"""Reactions in the joints: what the terminal, the files and the document show; figures have a module of their own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import degrees
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.bearings.joint_table import JointKind, TabledJoint, tabled_joints
from centrode.dynamics.bearings.reaction_series import ROUNDING, ReactionSeries, reaction_series
from centrode.dynamics.link_motions import motions_of_links
from centrode.dynamics.masses import massless_links
from centrode.errors import Status
from centrode.model.mechanism import FRAME
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Formula,
    Paragraph,
    PointArrows,
    Reference,
    Scalar,
    Section,
    Sheet,
    Table,
    illustrations,
)
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Factor,
    Joined,
    Leaf,
    Name,
    Number,
    Sentence,
    Text,
    Unit,
)
from centrode.views.columns import force_columns, status_column
from centrode.views.drive_balance import (
    REAL_MOTION,
    drive_balance,
    driving_terms,
    moment_of_links,
    printed_balance,
    terms_of_links,
)
from centrode.views.instants import instant_title
from centrode.views.limits import unreached_failure
from centrode.views.reaction_figures import pictures
from centrode.views.reaction_names import (
    body_text,
    contact_text,
    contacts_text,
    enumerate_names,
    reaction_text,
    side_text,
)

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.bearings.extremes import BearingLoad
    from centrode.dynamics.bearings.results import ReactionResults, ReactionsAtInstants
    from centrode.model.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]

VARIABLES = (
    "drive_rate",
    "balancing",
    "drive_acceleration",
    "moment_of_links",
    "inertia_moment_of_group",
    "driving_moment",
    "joint_force",
    "joint_moment",
    "centre_force",
    "guide_force",
    "guide_normal",
    "guide_moment",
    "gear_moment",
    "tooth_force",
    "tooth_radial_force",
    "rolling_force",
    "rolling_normal",
    "rolling_tangential",
    "friction_moment",
    "friction_force",
    "friction_power",
    "efficiency",
    "inertia_force",
    "inertia_moment",
    "frame_force",
    "frame_moment",
    "shaking_force",
    "shaking_moment",
    "reaction_loss",
)
"""Columns of the table of reactions, where they exist."""
STATUSES = {
    Status.OK: Sentence("ok"),
    Status.OPEN: Sentence("open"),
    Status.CUT_OFF: Sentence("cut off"),
    Status.SINGULAR: Sentence("singular"),
    Status.UNCONVERGED: Sentence("unconverged"),
    Status.SELF_LOCKING: Sentence("self-locking"),
}
NOT_DETERMINED = Sentence("not determined")
HELD = 1
"""Value of `self_locking` where loads do not drive the mechanism."""


def sheet(results: ReactionResults) -> Sheet:
    """Everything there is to say about reactions over a motion, or at single places."""
    joints = tabled_joints(results.mechanism)
    tables = {"reactions": _reactions_table(results.reactions), "joints": _joints(results.mechanism, joints)}
    datasets = {"reactions": results.reactions}
    if results.loads is not None:
        tables["bearing-loads"] = _loads_file(results.mechanism, results.loads)
    if results.bearings is not None:
        datasets["bearings"] = results.bearings
    return Sheet(
        facts=(*_facts(results), *_residuals(results.reactions)),
        scalars=dict(scalars(results)),
        tables=tables,
        datasets=datasets,
        pictures={} if results.loads is None else dict(pictures(results)),
        chapters={} if results.loads is None else {"reactions": _chapter(results, results.loads)},
        printed=(_joints(results.mechanism, joints, spoken=True), *_printed_parts(results)),
        failure=_failure(results),
        brief=_greatest_joint_force(results),
        arrows=Deferred({"reactions": partial(joint_arrows, results)}) if not results.at else {},
    )


def joint_arrows(results: ReactionResults) -> PointArrows:
    """The force in each joint on the link that the description names first there, over the motion."""
    found = results.reactions
    points = found["side_point"].to_numpy().tolist()
    first = [points.index(point) for point in dict.fromkeys(points)]
    forces = found["joint_force"].to_numpy()[:, first, :2]
    return PointArrows(Sentence("reactions in the joints"), "N", tuple(points[k] for k in first), forces)


def _failure(results: ReactionResults) -> Failure | None:
    """Samples that the mechanism does not reach, or at which friction lets nothing move."""
    reactions = results.reactions
    failure = unreached_failure(
        results.mechanism, reactions["status"], results.limits, single=bool(results.at)
    )
    locked = self_locking_samples(reactions)
    if failure is not None or not locked:
        return failure
    return Failure(
        self_locking_text(locked), Sentence("reduce the coefficients or radii, or lengthen the sliders")
    )


def self_locking_samples(reactions: xarray.Dataset) -> int:
    """At how many samples friction lets nothing move."""
    return int((reactions["reaction_status"] == Status.SELF_LOCKING).sum())


def self_locking_text(samples: int) -> Text:
    """At how many samples friction lets nothing move, as a clause."""
    return Counted(
        "self-locking: at {n} sample no drive overcomes the friction",
        "self-locking: at {n} samples no drive overcomes the friction",
        samples,
    )


def scalars(results: ReactionResults) -> Iterator[tuple[str, Scalar]]:
    """Extremes and means of each reaction by name, in SI."""
    place = results.mechanism.motion_parameter.instant.unit
    for load in results.loads or ():
        yield f"greatest_{load.key}", Scalar(load.greatest, load.unit)
        yield f"greatest_{load.key}_at", Scalar(load.at_greatest, place)
        yield f"least_{load.key}", Scalar(load.least, load.unit)
        yield f"mean_{load.key}", Scalar(load.mean, load.unit)


def _greatest_joint_force(results: ReactionResults) -> tuple[Fact, ...]:
    """The joint force that is greatest over the samples; nothing where none is determined."""
    reactions = results.reactions
    size = np.hypot.reduce(reactions["joint_force"].values, axis=-1)
    if not np.isfinite(size).any():
        return ()
    sample, side = (int(k) for k in np.unravel_index(np.nanargmax(size), size.shape))
    text = Sentence(
        "{side}: {force} at {place}",
        side=side_text(str(reactions["side"].values[side])),
        force=Number(float(size[sample, side]), "N"),
        place=_place(results.mechanism, reactions, sample),
    )
    return (Fact(Sentence("greatest joint force"), text),)


# Facts


def _facts(results: ReactionResults) -> Iterator[Fact]:
    """What acts and how fast, statuses, what is not determined, friction."""
    mechanism, reactions = results.mechanism, results.reactions
    links, massless = reactions["link"].values.tolist(), massless_links(mechanism)
    yield Fact(Sentence("drives"), enumerate_names(reactions["drive"].values.tolist()))
    yield Fact(Sentence("links with mass"), enumerate_names(links) if links else Sentence("none"))
    yield Fact(Sentence("massless links"), enumerate_names(massless) if massless else Sentence("none"))
    if "drive_rate" in reactions:
        yield Fact(Sentence("speed of the drive"), _speed(mechanism, reactions))
    if "driving_moment" in reactions:
        inertia = Number(reactions.attrs["inertia"], "kg m^2")
        yield Fact(Sentence("inertia of group I"), inertia)
    status = reactions["reaction_status"].values
    counts = tuple(
        Joined((STATUSES[Status(code)], Number(int(np.sum(status == code)))), " ")
        for code in np.unique(status).tolist()
    )
    yield Fact(Sentence("samples"), Joined((Number(len(status)), Joined(counts)), ": "))
    if reactions.attrs["undetermined"]:
        yield Fact(Sentence("not determined"), contacts_text(reactions.attrs["undetermined"]))
    if "tooth_force" in reactions:
        absent = np.isnan(reactions["tooth_force"].sel(axis="x").values).all(axis=0)
        gears = reactions["gear"].values[absent].tolist()
        if gears and np.isfinite(reactions["gear_moment"].values).any():
            text = Sentence("{gears}: the radii are not defined", gears=enumerate_names(gears))
            yield Fact(Sentence("no tooth force"), text)
    if "friction" in reactions.dims:
        yield from _friction(reactions)


def _speed(mechanism: Mechanism, reactions: xarray.Dataset) -> Text:
    """The speed of the drive, or from where to where it changes, and whose it is."""
    unit = mechanism.motion_parameter.drives[0].speed_unit
    rates = reactions["drive_rate"].values
    low, high = (Number(float(rate), unit, unit_fixed=True) for rate in (np.min(rates), np.max(rates)))
    alike = f"{low.value:.6g}" == f"{high.value:.6g}"
    speed: Text = low if alike else Sentence("{first} to {last}", first=low, last=high)
    match reactions.attrs["rate_from"]:
        case "machine":
            return Sentence("{speed}, the mean speed of the machine", speed=speed)
        case "steady":
            return Sentence("{speed}, the real speed of the machine", speed=speed)
        case "given":
            return Sentence("{speed}, as given", speed=speed)
        case _:
            return speed


def _friction(reactions: xarray.Dataset) -> Iterator[Fact]:
    """Efficiency over the samples, where loads no longer drive, what does not move, and how friction was found."""
    mean = reactions.attrs["efficiency"]
    if np.isfinite(mean):
        yield Fact(Sentence("overall efficiency"), Number(mean, digits=".4f"))
    held = int((reactions["self_locking"] == HELD).sum())
    if held:
        text = Counted("{n} sample: loads do not drive it", "{n} samples: loads do not drive it", held)
        yield Fact(Sentence("held by friction"), text)
    turning = int((reactions["friction_turns"] != 0).any("friction").sum())
    if turning:
        text = Counted("{n} sample, values just after it", "{n} samples, values just after each", turning)
        yield Fact(Sentence("friction reverses"), text)
    if reactions.attrs["standing"]:
        contacts = Joined(tuple(map(contact_text, reactions.attrs["standing"].split("; "))))
        standing = Sentence(
            "{contacts}: no motion there, friction is set to {zero}", contacts=contacts, zero=Number(0)
        )
        yield Fact(Sentence("no friction"), standing)
    solved = Counted(
        "residual {share} after at most {n} step",
        "residual {share} after at most {n} steps",
        int(reactions.attrs["friction_iterations"]),
        share=Number(reactions.attrs["friction_residual"], digits=".1e"),
    )
    yield Fact(Sentence("friction against reactions"), solved)


def _residuals(reactions: xarray.Dataset) -> tuple[Fact, ...]:
    """Three sums that are not used to find the reactions."""
    equilibrium, frame, power = (
        Number(float(reactions.attrs[name]), digits=".1e")
        for name in ("equilibrium_residual", "frame_residual", "power_residual")
    )
    closing: tuple[Fact, ...] = ()
    if "driving_residual" in reactions.attrs:
        driving = Number(float(reactions.attrs["driving_residual"]), digits=".1e")
        text = Sentence("difference {share} of its terms from links, flywheel and shafts", share=driving)
        closing = (Fact(Sentence("driving moment"), text),)
    return (
        Fact(
            Sentence("equilibrium of links"),
            Sentence("residual {share} of the greatest force", share=equilibrium),
        ),
        Fact(
            Sentence("sum over the frame"),
            Sentence("difference {share} of the greatest force from the rates of momentum", share=frame),
        ),
        Fact(
            Sentence("power balance"),
            Sentence("difference {share} of the greatest power from virtual work", share=power),
        ),
        *closing,
    )


# Tables


def _reactions_table(reactions: xarray.Dataset) -> Table:
    """All variables, one row a sample; what does not exist or is not determined is an empty field."""
    columns = (
        Column(name, values.values, unit) for name, unit, values in force_columns(reactions, VARIABLES)
    )
    return Table((*columns, status_column(reactions["reaction_status"])))


def _joints(mechanism: Mechanism, joints: Sequence[TabledJoint], *, spoken: bool = False) -> Table:
    """Links below each other, the frame last as 0, and joints beside each other: 1 and -1 where reactions act.

    Files name the frame in English; what is `spoken` has its word in the language of the reader.
    """
    bodies = [*mechanism.links, FRAME]
    labels = tuple(
        Joined((Number(k % len(bodies)), body_text(body) if spoken else Name(body)), " ")
        for k, body in enumerate(bodies, start=1)
    )
    columns = [Column("link", labels, head=Sentence("link"))]
    for joint in joints:
        signs = [joint.sign(body) for body in bodies]
        # people read whole numbers, spreadsheets take them as numbers
        values = tuple(map(Number, signs)) if spoken else np.array(signs, dtype=np.int64)
        columns.append(Column(_joint_key(joint), values, head=_joint_text(joint)))
    return Table(tuple(columns))


def _joint_key(joint: TabledJoint) -> str:
    """A joint in files: "A", "A DB", "guide H"."""
    if joint.kind is JointKind.HINGE:
        return f"{joint.name} {joint.second}" if joint.one_of_several else joint.name
    return f"{joint.kind.value} {joint.name}"


def _joint_text(joint: TabledJoint) -> Text:
    """A joint on terminals and in documents."""
    name = Name(joint.name)
    match joint.kind:
        case JointKind.HINGE:
            return Joined((name, body_text(joint.second)), " ") if joint.one_of_several else name
        case JointKind.GUIDE:
            return Sentence("guide {guide}", guide=name)
        case JointKind.GEAR:
            return Sentence("gear {gear}", gear=name)
        case JointKind.WHEEL:
            return Sentence("wheel {wheel}", wheel=name)
        case JointKind.CYLINDER:
            return Sentence("cylinder {drive}", drive=name)


def _printed_parts(results: ReactionResults) -> Iterator[Table | Section]:
    """Extremes and what friction takes, or the reactions at single places, each under its place."""
    if not results.at:
        yield _extremes(results.mechanism, results.reactions)
        yield from _losses(results.reactions)
    for sample in range(len(results.at)):
        where = _place(results.mechanism, results.reactions, sample)
        yield _instant_table(
            results.mechanism, results.reactions, sample, Sentence("at {value}", value=where)
        )
        if "driving_moment" in results.reactions:
            yield from _printed_balance(results.reactions.isel(sample=sample))


def _printed_balance(here: xarray.Dataset) -> Iterator[Section]:
    """What drives, with its numbers, where the reactions of the sample are known."""
    if np.isfinite(float(here["moment_of_links"])):
        yield printed_balance(*driving_terms(here))


def _first_columns(reactions: Iterable[ReactionSeries | BearingLoad]) -> tuple[Column, Column]:
    """Name and unit of each reaction."""
    reactions = tuple(reactions)
    texts, units = tuple(map(reaction_text, reactions)), tuple(Unit(one.unit) for one in reactions)
    return Column("reaction", texts, head=Sentence("reaction")), Column("unit", units, head=Sentence("unit"))


def _extremes(mechanism: Mechanism, reactions: xarray.Dataset) -> Table:
    """Least and greatest of each reaction over the samples, and where; forces by their magnitude."""
    series = list(reaction_series(mechanism, reactions))
    noises = _noises(series)
    rows = [_extremes_of(mechanism, reactions, one, noises[one.unit]) for one in series]
    heads = (
        ("least", Sentence("least")),
        ("at least", Sentence("at")),
        ("greatest", Sentence("greatest")),
        ("at greatest", Sentence("at")),
    )
    columns = (
        Column(name, cells, head=head)
        for (name, head), cells in zip(heads, zip(*rows, strict=True), strict=True)
    )
    return Table((*_first_columns(series), *columns))


def _extremes_of(
    mechanism: Mechanism, reactions: xarray.Dataset, one: ReactionSeries, noise: float
) -> tuple[Text, ...]:
    """Least value and its place, greatest value and its place; of values alike but for rounding the first."""
    size = one.magnitudes
    known = np.flatnonzero(np.isfinite(size))
    if not len(known):
        return NOT_DETERMINED, NOTHING, NOTHING, NOTHING
    low = int(known[np.argmax(size[known] <= np.min(size[known]) + noise)])
    high = int(known[np.argmax(size[known] >= np.max(size[known]) - noise)])
    still = abs(float(size[high] - size[low])) <= noise
    cells: list[Text] = []
    for sample in (low, high):
        place = NOTHING if still else _place(mechanism, reactions, sample)
        cells += [_number(float(size[sample]), noise), place]
    return tuple(cells)


def _losses(reactions: xarray.Dataset) -> Iterator[Table]:
    """Greatest power and work of friction at each contact, and its share of the work; nothing without friction."""
    if "friction" not in reactions.dims:
        return
    works = reactions["friction_work"].values
    shares = np.full(works.shape, np.nan)
    if np.isfinite(works).all() and works.sum() != 0.0:
        shares = 100.0 * works / works.sum()
    powers = reactions["friction_power"].values
    greatest = np.fmax.reduce(powers, axis=0)
    contacts = tuple(map(contact_text, reactions["friction"].values.tolist()))
    yield Table(
        (
            Column("friction", contacts, head=Sentence("friction at")),
            Column("power", _numbers(greatest, ".6g"), "W", Sentence("greatest power")),
            Column("work", _numbers(works, ".6g"), "J", Sentence("work")),
            Column("share", _numbers(shares, ".2f"), "%", Sentence("share"), unit_fixed=True),
        )
    )


def _numbers(values: Array, digits: str) -> tuple[Text, ...]:
    """Numbers whose unit stands in the head of their column; nothing for one that is not known."""
    return tuple(Number(value, digits=digits) if np.isfinite(value) else NOTHING for value in values.tolist())


def _instant_table(mechanism: Mechanism, reactions: xarray.Dataset, sample: int, caption: Sentence) -> Table:
    """All reactions at one sample: components and magnitude, or the one number; in the plane directions."""
    axes = reactions["axis"].values.tolist()
    series = list(reaction_series(mechanism, reactions))
    noises = _noises(series)
    status = Status(int(reactions["reaction_status"].values[sample]))
    missing = NOT_DETERMINED if status in (Status.OK, Status.CUT_OFF) else STATUSES[status]
    rows = [_at_sample(one.values[sample], len(axes), noises[one.unit], missing) for one in series]
    *components, magnitudes, directions = zip(*rows, strict=True)
    columns = [Column(axis, cells, head=Name(axis)) for axis, cells in zip(axes, components, strict=True)]
    columns.append(Column("magnitude", magnitudes, head=Sentence("magnitude")))
    if len(axes) == 2:
        columns.append(_directions(directions))
    return Table((*_first_columns(series), *columns), caption)


def _directions(cells: tuple[Text, ...]) -> Column:
    """Directions of planar forces in degrees, whatever the display says."""
    return Column("direction", cells, "deg", Sentence("direction"), unit_fixed=True)


def _at_sample(here: Array, axes: int, noise: float, missing: Text) -> tuple[Text, ...]:
    """Components, magnitude and direction of a vector, or the one number; a word where there is none."""
    aside = (NOTHING,) * axes
    if not np.all(np.isfinite(here)):
        return *aside, missing, NOTHING
    if here.ndim == 0:
        return *aside, _number(float(here), noise), NOTHING
    size = float(np.hypot.reduce(here))
    components = (_number(float(x), ROUNDING * max(size, noise)) for x in here)
    direction = NOTHING if size <= noise else _direction(float(np.arctan2(here[1], here[0])))
    return *components, _number(size, noise), direction


def _direction(angle: float) -> Number:
    return Number(round(degrees(angle), 2) + 0.0, digits=".2f")


def _noises(series: Iterable[ReactionSeries]) -> Mapping[str, float]:
    """Unit -> what is rounding in that unit, over all reactions that are shown."""
    noises: dict[str, float] = {}
    for one in series:
        greatest = float(np.max(np.abs(one.values), where=np.isfinite(one.values), initial=0.0))
        noises[one.unit] = max(noises.get(one.unit, 0.0), ROUNDING * greatest)
    return noises


def _number(value: float, noise: float) -> Number:
    return Number(0.0 if abs(value) <= noise else value)


def _place(mechanism: Mechanism, reactions: xarray.Dataset, sample: int) -> Number:
    """What states the instant of a sample: the value of the drive, else time."""
    parameter = mechanism.motion_parameter
    at = float(parameter.instants(reactions)[sample])
    if not parameter.is_uniform:
        return Number(at, parameter.instant.unit)
    return Number(at, parameter.instant.unit, ".9g", degrees_too=True)


def _loads_file(mechanism: Mechanism, loads: Sequence[BearingLoad]) -> Table:
    """Extremes and means of each reaction, by their keys, in full."""
    parameter = mechanism.motion_parameter
    place, unit = "drive_value" if parameter.is_uniform else "time", parameter.instant.unit
    directions = [np.nan if load.direction is None else load.direction for load in loads]
    return Table(
        (
            Column("reaction", tuple(Name(load.key) for load in loads)),
            Column("unit", tuple(Unit(load.unit) for load in loads)),
            Column("greatest", np.array([load.greatest for load in loads])),
            Column(f"greatest at {place}", np.array([load.at_greatest for load in loads]), unit),
            Column("direction", np.array(directions), "rad"),
            Column("least", np.array([load.least for load in loads])),
            Column(f"least at {place}", np.array([load.at_least for load in loads]), unit),
            Column("mean", np.array([load.mean for load in loads])),
            Column("rms", np.array([load.rms for load in loads])),
        )
    )


def loads_table(mechanism: Mechanism, loads: Sequence[BearingLoad], caption: Text = NOTHING) -> Table:
    """Extremes and means of each reaction as people read them: places and numbers that are rounding left out."""
    heads = (
        Column("greatest", (), head=Sentence("greatest")),
        Column("at greatest", (), head=Sentence("at")),
        _directions(()),
        Column("least", (), head=Sentence("least")),
        Column("at least", (), head=Sentence("at")),
        Column("mean", (), head=Sentence("mean")),
        Column("rms", (), head=Sentence("rms")),
    )
    rows = [_load_cells(mechanism, load) for load in loads]
    columns = (replace(head, values=tuple(row[k] for row in rows)) for k, head in enumerate(heads))
    return Table((*_first_columns(loads), *columns), caption)


def _load_cells(mechanism: Mechanism, load: BearingLoad) -> tuple[Text, ...]:
    unit = mechanism.motion_parameter.instant.unit
    noise = ROUNDING * max(abs(load.greatest), abs(load.least))
    still = load.greatest - load.least <= noise
    at_greatest, at_least = (
        NOTHING if still else Number(at, unit) for at in (load.at_greatest, load.at_least)
    )
    greatest, least, mean, rms = (
        _number(value, noise) for value in (load.greatest, load.least, load.mean, load.rms)
    )
    direction = NOTHING if load.direction is None else _direction(load.direction)
    return greatest, at_greatest, direction, least, at_least, mean, rms


# Chapter


BY_VIRTUAL_WORK = Sentence(
    "The reactions and virtual work give the same balancing moment or force within {share} of its terms."
)
DETAILS = (
    "joint-components",
    "frame-force",
    "bearing-loads",
    "journal-loads",
    "bearing-wear",
    "force-vectors",
)
"""Figures that only the full form of a document shows."""


def _chapter(results: ReactionResults, loads: Sequence[BearingLoad]) -> Chapter:
    """Kinetostatics: inertia, the table of joints, reactions at instants, the worst over the motion, checks."""
    mechanism, reactions = results.mechanism, results.reactions
    meaning = Sentence(
        "{one} marks the link on which the reaction of a joint acts, {opposite} the link on which the opposite "
        "force acts; rows correspond to the equilibrium equations of the links.",
        one=Number(1),
        opposite=Number(-1),
    )
    joints = _joints(mechanism, tabled_joints(mechanism), spoken=True)
    captions = {
        "joint-forces": Sentence("Forces in the hinges"),
        "joint-components": Sentence("Forces in the hinges by components"),
        "centre-forces": Sentence("Forces of the centre of the sphere"),
        "other-reactions": Sentence("Reactions of guides, gears and wheels"),
        "balancing": Sentence("Balancing moments and forces of the drives"),
        "drive-balance": Sentence("Moments of the links, of flywheel and shafts, and the driving moment"),
        "friction": Sentence("Losses to friction"),
        "frame-force": Sentence("Force and moment on the frame"),
        "bearing-loads": Sentence("Loads of the bearings on the bushes, in the axes of the frame"),
        "journal-loads": Sentence("Loads on the journals, in the axes of their links"),
        "bearing-wear": Sentence("Wear of journals (inside) and bushes (outside)"),
        "force-vectors": Sentence("The instant of the greatest joint force, to scale"),
    }
    extremes = loads_table(mechanism, loads, Sentence("Greatest and least reactions over the motion"))
    note = Paragraph(Sentence("Extremes are found between the samples too; means are over time."))
    losses = (Table(table.columns, Sentence("Losses to friction")) for table in _losses(reactions))
    sections = (
        Section(
            NOTHING, (*_relations(mechanism), *_real_motion(reactions), FactTable(tuple(_facts(results))))
        ),
        Section(Sentence("Table of joints"), (Paragraph(meaning), joints), detail=True),
        *(() if results.instants is None else _instants(mechanism, results.instants)),
        # where friction jams every sample nothing is determined
        Section(Sentence("Greatest reactions"), (*((extremes, note) if loads else ()), *losses)),
        Section(Sentence("Checks"), tuple(_checks(reactions))),
        # in the real motion the balance shows the moment of the links
        illustrations(
            captions, captions, (*DETAILS, "balancing") if "driving_moment" in reactions else DETAILS
        ),
    )
    return Chapter(Sentence("Reactions in the joints"), sections)


def _real_motion(reactions: xarray.Dataset) -> tuple[Block, ...]:
    """That the forces are those of the real motion; nothing where they are not."""
    return (Paragraph(REAL_MOTION),) if "driving_moment" in reactions else ()


def _relations(mechanism: Mechanism) -> tuple[Block, ...]:
    """Inertia as a force, equilibrium of every link, one list of constraints."""
    text = Sentence(
        "With inertia forces included, each link is in equilibrium (d'Alembert's principle). One system gives "
        "the reactions of all links; every constraint is a row of derivatives and its reaction a multiplier "
        "$lambda$."
    )
    system = ("upright(bold(J))^upright(T) upright(bold(lambda))", "-upright(bold(Q))")
    inertia: tuple[tuple[Leaf, ...], ...] = (
        ("arrow(Phi)_k", "-m_k arrow(a)_k"),
        ("M_(Phi k)", "-J_k epsilon_k"),
    )
    if mechanism.space == "sphere":
        turning = (
            "-upright(bold(I))_k arrow(epsilon)_k - arrow(omega)_k times upright(bold(I))_k arrow(omega)_k"
        )
        inertia = (("arrow(M)_(Phi k)", turning),)
    signs = Sentence("A force in a hinge is that of the pin on the link, in the axes of the frame.")
    return Paragraph(text), Formula((*inertia, system), "inertia"), Paragraph(signs)


def _instants(mechanism: Mechanism, instants: ReactionsAtInstants) -> Iterator[Section]:
    """At each instant inertia forces, all reactions, the balancing moment by virtual work."""
    for k in range(instants.reactions.sizes["sample"]):
        title = instant_title(mechanism, instants.motion, k)
        if not np.isfinite(instants.reactions["frame_force"].values[k]).all():
            missing = Sentence("The mechanism does not reach this position: there are no values.")
            yield Section(title, (Paragraph(missing),))
            continue
        reactions = _instant_table(mechanism, instants.reactions, k, Sentence("Reactions"))
        yield Section(
            title,
            (
                Reference(Sentence("Inertia forces and reactions follow from {inertia}.")),
                *_inertia(mechanism, instants, k),
                reactions,
                *_virtual_work(mechanism, instants, k),
            ),
        )


def _inertia(mechanism: Mechanism, instants: ReactionsAtInstants, k: int) -> Iterator[Table]:
    """Inertia of every link with mass; in the plane with the accelerations that it comes from.

    The table is in SI: products of the columns are to be found in it.
    """
    here, flat = instants.reactions.isel(sample=k), mechanism.space == "plane"
    names = tuple(map(Name, here["link"].values.tolist()))
    if not names:
        return
    columns = [Column("link", names, head=Sentence("link"))]
    if flat and mechanism.motion_parameter.is_uniform and "drive_rate" in here:
        columns += _accelerations(
            mechanism, instants.motion.isel(sample=k), float(here["drive_rate"]), _second_rate(here)
        )
    force, moment = here["inertia_force"].values, here["inertia_moment"].values
    axes = here["axis"].values.tolist()
    if np.isfinite(force).all() and force.any():
        columns += [_in_si(f"Phi_{axis}", force[:, n], "N") for n, axis in enumerate(axes)]
    if moment.ndim == 1:
        columns.append(_in_si("M_Phi", moment, "N m"))
    else:
        columns += [_in_si(f"M_(Phi {axis})", moment[:, n], "N m") for n, axis in enumerate(axes)]
    caption = Sentence("Inertia forces and moments")
    if flat:
        caption = Sentence("Accelerations of the centres of mass, inertia forces and moments")
    yield Table(tuple(columns), caption)


def _second_rate(here: xarray.Dataset) -> float:
    """Second derivative of the drive's value by time at a sample; 0 at a constant rate."""
    if "drive_acceleration" not in here:
        return 0.0
    return float(here["drive_acceleration"])


def _accelerations(mechanism: Mechanism, here: xarray.Dataset, rate: float, second: float) -> list[Column]:
    """Accelerations of the centres of mass and of the links at a rate of the drive and its derivative by time."""
    links = motions_of_links(mechanism, here)
    centres = np.array([one.acceleration * rate**2 + one.velocity * second for one in links])
    return [
        _in_si("a_x", centres.real, "m/s^2"),
        _in_si("a_y", centres.imag, "m/s^2"),
        _in_si(
            "epsilon", np.array([one.bending * rate**2 + one.turning * second for one in links]), "rad/s^2"
        ),
    ]


def _in_si(letter: str, values: Array, unit: str) -> Column:
    return Column(letter, values, unit, Expression(letter), unit_fixed=True)


def _virtual_work(mechanism: Mechanism, instants: ReactionsAtInstants, k: int) -> Iterator[Block]:
    """The balancing moment from the reduction, beside the one from the reactions; at constant rates alone."""
    reactions = instants.reactions.isel(sample=k)
    if instants.steady is not None:
        yield from _real_balance(reactions, instants.steady.isel(sample=k))
        return
    if instants.reduced is None or "drive_rate" not in reactions:
        return
    here, rate = instants.reduced.isel(sample=k), float(reactions["drive_rate"])
    slope, moment = float(here["reduced_inertia_slope"]), float(here["reduced_moment"])
    unit = str(reactions["balancing"].attrs["units"]).split(", ")[0]
    work = 0.5 * slope * rate**2 - moment
    with_numbers = Expression(
        f"frac(1, 2) dot.op {{slope}} dot.op {{rate}}^(2) {'+' if moment < 0 else '-'} {{moment}}",
        slope=Factor(Number(slope, unit_hidden=True)),
        rate=Factor(Number(rate, unit_hidden=True)),
        moment=Number(abs(moment), unit_hidden=True),
    )
    symbol = "M_upright(b)" if unit == "N m" else "F_upright(b)"
    yield Paragraph(Sentence("By virtual work, at the constant speed of the drive:"))
    yield Formula(((symbol, "1/2 J' dot(q)^2 - M", with_numbers, Number(work, unit, unit_fixed=True)),))
    balancing = float(reactions["balancing"].values.flat[0])
    if np.isfinite(balancing):
        yield Check(
            BY_VIRTUAL_WORK,
            abs(work - balancing),
            abs(0.5 * slope * rate**2) + abs(moment),
            float(reactions["reaction_loss"]),
        )


def _real_balance(here: xarray.Dataset, steady: xarray.Dataset) -> Iterator[Block]:
    """In the real motion: the links' moment by virtual work, and with the flywheel's the driving moment."""
    terms = driving_terms(here)
    size = terms_of_links(steady) + abs(terms[1] * terms[2]) + abs(terms[3])
    bound = float(here["reaction_loss"]) + float(here.attrs["driving_error"])
    yield Check(
        BY_VIRTUAL_WORK,
        abs(moment_of_links(steady) - terms[0]),
        size,
        bound,
    )
    yield from drive_balance(*terms, size, bound)


def _checks(reactions: xarray.Dataset) -> Iterator[Check]:
    """Three sums that are not used to find the reactions; allowed is what rounding can make wrong of them."""
    loss = reactions["reaction_loss"].values
    allowed = float(np.max(loss, where=np.isfinite(loss) & (loss < 1.0), initial=0.0))
    for text, name in (
        (
            Sentence(
                "The residual of the equilibrium of every link is at most {share} of the greatest force."
            ),
            "equilibrium_residual",
        ),
        (
            Sentence(
                "The sum over the frame differs from the rates of momentum by {share} of the greatest force."
            ),
            "frame_residual",
        ),
        (
            Sentence("The power of the drives differs from virtual work by {share} of the greatest power."),
            "power_residual",
        ),
    ):
        yield Check(text, float(reactions.attrs[name]), 1.0, allowed)
    if "driving_residual" in reactions.attrs:
        text = Sentence(
            "Over the cycle the moments of links, flywheel and shafts differ from the driving moment by {share} of "
            "their terms."
        )
        residual, error = (float(reactions.attrs[f"driving_{name}"]) for name in ("residual", "error"))
        yield Check(text, residual, 1.0, allowed + error)
    if reactions.attrs["undetermined"]:
        text = Sentence(
            "Redundant constraints leave undetermined: {names}. These have no values.",
            names=contacts_text(reactions.attrs["undetermined"]),
        )
        yield Check(text, 0.0, 1.0, 0.0)
