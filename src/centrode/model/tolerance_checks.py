"""What tolerances name has to be there: dimensions with a number, joints, sizes that the standard grades cover."""

from __future__ import annotations

from collections.abc import Iterator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import Description
from centrode.model.limits_and_fits import tolerance_class
from centrode.model.links import part_tables
from centrode.model.number_paths import spot_of_path, words_of_path
from centrode.model.reading import FRAME, Place, Problem, nearest, value_text
from centrode.model.tolerances import Limits, Tolerances, is_size

HALF = "/"
"""Between a pin and the link whose play it is."""


def tolerance_problems(mechanism: Description) -> Iterator[Problem]:
    """Problems of the tolerances of a description whose points are placed."""
    settings = mechanism.tolerances
    if settings is None:
        return
    for path in settings.dimensions:
        yield from _problems_of_path(mechanism, settings, path)
    yield from _problems_of_joints(mechanism, settings)
    known = [path for path in settings.dimensions if settings.dimensions[path] is not None]
    seen: set[frozenset[str]] = set()
    for number, correlation in enumerate(settings.correlations):
        at: Place = ("tolerances", "correlations", number)
        for path in correlation.paths:
            if path not in known:
                what = _("{path} has no tolerance of its own").format(path=value_text(path))
                yield Problem(what, nearest(path, known), at)
        pairs = {frozenset(pair) for pair in _pairs(correlation.paths)}
        if pairs & seen:
            what = _("two numbers of this correlation have one already")
            yield Problem(what, _("keep one of them"), at)
        seen |= pairs


def _pairs(paths: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    for number, path in enumerate(paths):
        yield from ((path, other) for other in paths[number + 1 :])


def _problems_of_path(mechanism: Description, settings: Tolerances, path: str) -> Iterator[Problem]:
    at: Place = ("tolerances", path)
    try:
        refuse_counted(mechanism, path)
        value = dimension_at(mechanism, path)
        lower, _upper = limits_of_number(settings.dimensions[path], value)
    except InputError as error:
        yield Problem(error.what, error.repair, at)
        return
    if is_size(path, mechanism.space) and value > 0.0 and not value + lower > 0.0:
        what = _("the lower limit takes all of the length")
        yield Problem(what, _("give a smaller tolerance"), at)


def refuse_counted(mechanism: Description, path: str) -> None:
    """Raise InputError where a path names teeth, or a ratio of counted teeth, which no workshop makes too large."""
    room, _dot, rest = path.partition(".")
    name, _dot, last = rest.rpartition(".")
    counted = any(gear.id == name and gear.pair is not None for gear in mechanism.gears)
    if room == "gears" and (last == "teeth" or (last == "ratio" and counted)):
        what = _("teeth are counted: their number and its ratio do not deviate")
        raise InputError("", what, _("give tolerances to lengths; errors of teeth are not computed"))


def dimension_at(mechanism: Description, path: str) -> float:
    """Number [SI] of a dimension; raises InputError where there is none."""
    tables = part_tables(mechanism)
    words = words_of_path(mechanism, path)
    if words[0] == "guides" and words[2:] == ["direction"]:
        return mechanism.guide(words[1]).direction_angle
    if words[0] == "guides" and words[2:] == ["radius"] and mechanism.space == "sphere":
        return mechanism.guide(words[1]).arc
    container, key = spot_of_path(tables, words, path)
    value = container.get(key) if isinstance(container, dict) else container[key]
    if isinstance(value, bool) or not isinstance(value, int | float):
        what = _("{path} is not a number here").format(path=path)
        raise InputError("", what, _("give it a value first"))
    return float(value)


def limits_of_number(given: Limits | str, value: float) -> Limits:
    """Lower and upper deviation [SI] of a number; of a class those of its size. Raises InputError beyond the table."""
    return tolerance_class(given).deviations(value) if isinstance(given, str) else given


def _problems_of_joints(mechanism: Description, settings: Tolerances) -> Iterator[Problem]:
    guides = {guide.id: guide for guide in mechanism.guides}
    for name, clearance in settings.clearances.items():
        at: Place = ("tolerances", "clearances", name)
        pin, _slash, link = name.partition(HALF)
        if name not in guides and pin not in mechanism.points:
            what = _("there is no pin or guide {name}").format(name=value_text(name))
            yield Problem(what, nearest(name, [*mechanism.points, *guides]), at)
            continue
        if name in guides:
            if clearance.length is not None and guides[name].link is None:
                what = _("the slider in guide {name} may turn: it has no length in it")
                yield Problem(what.format(name=value_text(name)), _("remove length"), at)
            continue
        bodies = bodies_at_pin(mechanism, pin)
        if len(bodies) < 2:
            what = _("there is no joint at point {name}").format(name=value_text(pin))
            yield Problem(what, _("name a point where two links are hinged"), at)
        elif link and link not in bodies[1:]:
            what = _("the pin {pin} is that of {host}: there is no play {name} on it")
            yield Problem(
                what.format(pin=value_text(pin), host=value_text(bodies[0]), name=value_text(link)),
                nearest(link, bodies[1:]),
                at,
            )
        if clearance.length is not None:
            yield Problem(_("a pin has play alone"), _("remove length"), at)


def bodies_at_pin(mechanism: Description, pin: str) -> list[str]:
    """The bodies hinged at a point, first the one that carries the pin.

    That is the frame, or the slider that a guide leads by the pin, or the first link that names it.
    """
    frame = [FRAME] if pin in mechanism.frame.points else []
    links = [name for name, link in mechanism.links.items() if pin in link.coordinates]
    sliders = [guide.link for guide in mechanism.guides if guide.point == pin and guide.link in links]
    return list(dict.fromkeys([*frame, *filter(None, sliders), *links]))
