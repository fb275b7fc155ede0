"""Mechanisms in files: TOML in, TOML out, and nothing lost between."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache, reduce
from operator import getitem
from pathlib import Path
from typing import Any, TypeVar

import tomli_w

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import Cam, vary_cam
from centrode.model.description import Description
from centrode.model.description_files import DescriptionFiles
from centrode.model.follower_cam import PlateCam
from centrode.model.links import part_tables
from centrode.model.load_paths import ROOMS, kind_of_place, place_of_number, with_number
from centrode.model.mechanism import Mechanism
from centrode.model.number_paths import spot_of_path, words_of_path
from centrode.model.reading import two_points
from centrode.model.toml import in_short_lines, with_unit
from centrode.model.values import BareAngles, Radians

AnyDescription = TypeVar("AnyDescription", Mechanism, Cam, PlateCam)

# A mechanism as the tables of its file, with only what differs from the defaults.


def document(mechanism: Description) -> dict[str, Any]:
    """Tables, lists, texts and SI numbers that read back as the same mechanism."""
    tables = part_tables(mechanism)
    for name, link in mechanism.links.items():
        if link.points == two_points(name):
            del tables["links"][name]["points"]
    return tables


_HEADING = re.compile(r"^(\[\[?)", re.MULTILINE)


def read_mechanism(path: str | Path) -> Mechanism:
    """The mechanism described in a TOML file; raises InputError that says where it is wrong.

    Examples
    --------
    >>> import centrode as ct
    >>> from pathlib import Path
    >>> _ = Path("bars.toml").write_text(ct.mechanism_text(ct.example("crank-rocker")))
    >>> ct.read_mechanism("bars.toml").title
    'Crank-rocker four-bar linkage'
    """
    return MECHANISMS.read(path)


def parse_mechanism(text: str, where: str = "", folder: Path | None = None) -> Mechanism:
    """The mechanism described in a text of TOML.

    Parameters
    ----------
    text : str
    where : str
        What messages call the text, such as the name of its file.
    folder : Path
        Where the tables of drives lie; the current folder by default.

    Raises
    ------
    InputError

    Examples
    --------
    >>> import centrode as ct
    >>> mechanism = ct.example("crank-rocker")
    >>> ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    True
    """
    return MECHANISMS.parse(text, where, folder)


def mechanism_from(
    mapping: Mapping[str, Any],
    where: str = "",
    folder: Path | None = None,
    bare_angles: BareAngles = "radians",
) -> Mechanism:
    """The mechanism described by plain dicts and lists as a file's; raises InputError that starts with `where`."""
    return MECHANISMS.from_tables(mapping, where, folder, bare_angles)


def mechanism_text(mechanism: Mechanism) -> str:
    """The mechanism as TOML in SI, without defaults; `parse_mechanism` gives exactly it back.

    Where the mechanism displays degrees, angles are texts with their unit ("0.5 rad").

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.mechanism_text(ct.example("crank-rocker"))[:40])
    title = "Crank-rocker four-bar linkage"
    """
    return MECHANISMS.text(mechanism)


class _MechanismFiles(DescriptionFiles[Mechanism]):
    """Mechanisms as files: their tables one below the other, each with its heading."""

    def text(self, described: Mechanism) -> str:
        """The mechanism as TOML in SI, without defaults."""
        tables = document(described)
        if described.display.refuses_bare_angles:
            for *parents, key in _places_of_angles(_ByForm(tables)):
                container = reduce(getitem, parents, tables)
                container[key] = with_unit(Radians(container[key]))
        return in_short_lines("\n".join(_sections(tables)))


MECHANISMS = _MechanismFiles("linkage", lambda _tables, _where: Mechanism)
"""Mechanisms in files."""


class _ByForm:
    """Tables that count as the same when they differ in numbers only."""

    def __init__(self, tables: dict[str, Any]) -> None:
        self.tables = tables
        self.form = _form(tables)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByForm) and self.form == other.form

    def __hash__(self) -> int:
        return hash(self.form)


def _form(value: Any) -> Any:
    """Keys, texts and switches of tables and lists; a number is only that."""
    if isinstance(value, dict):
        return ("table", *((key, _form(entry)) for key, entry in value.items()))
    if isinstance(value, list):
        return ("list", *map(_form, value))
    return float if isinstance(value, float) else (type(value), value)


# Results carry the text of their mechanism: thousands of mechanisms of one form are read once, not each again.
@lru_cache(maxsize=16)
def _places_of_angles(description: _ByForm) -> tuple[tuple[Any, ...], ...]:
    """Keys and indices that lead to each angle, found by reading: they depend on the space and on what is driven."""
    return tuple(_angles_in(document(mechanism_from(description.tables, bare_angles="marked")), ()))


def _angles_in(value: Any, place: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, Radians):
        yield place
    elif isinstance(value, dict | list):
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _angles_in(entry, (*place, key))


def _sections(tables: Mapping[str, Any]) -> Iterator[str]:
    """Top keys, then each table in its order; each entry of a list of tables below a heading of its own."""
    plain = {
        key: value for key, value in tables.items() if not isinstance(value, dict) and not _is_tables(value)
    }
    if plain:
        yield tomli_w.dumps(plain)
    for key, value in tables.items():
        if isinstance(value, dict):
            yield tomli_w.dumps({key: value})
        elif _is_tables(value):
            # headings inside an entry belong to the entry
            yield from (f"[[{key}]]\n" + _HEADING.sub(rf"\1{key}.", tomli_w.dumps(entry)) for entry in value)


def _is_tables(value: object) -> bool:
    return isinstance(value, list | tuple) and bool(value) and all(isinstance(entry, dict) for entry in value)


# Values of a mechanism by their paths: links.AC.length, frame.points.D.x, guides.C.through.y,
# drives.OA.speed; those of loads, machine and simulation are in load_paths.

_last_read: tuple[Mechanism, dict[str, Any]] | None = None


def _tables_to_read(mechanism: Mechanism) -> dict[str, Any]:
    """The tables of a mechanism, not to be changed: those of the last one are kept, as many paths are read in turn."""
    global _last_read
    # one look and one stroke: another thread may exchange it between the two
    last = _last_read
    if last is None or last[0] is not mechanism:
        _last_read = last = mechanism, document(mechanism)
    return last[1]


def value_at(mechanism: Mechanism, path: str) -> float:
    """Number [SI] of a mechanism at a path; raises InputError where there is none.

    `guides.C.direction` is an angle however it is given; `links.K.points.C.x` is a local coordinate of a
    link whose points have coordinates. On the sphere, coordinates are `longitude` and `latitude`.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.value_at(ct.example("crank-rocker"), "links.AB.length")
    3.5
    """
    if _is_dynamic(path):
        place = place_of_number(mechanism, document(mechanism), path)
        return _number_at(place.container, place.key, path)
    words = words_of_path(mechanism, path)
    if words[0] == "guides" and words[2:] == ["direction"]:
        return mechanism.guide(words[1]).direction_angle
    if words[0] == "guides" and words[2:] == ["radius"] and mechanism.space == "sphere":
        return mechanism.guide(words[1]).arc
    if words[0] == "rolling" and words[2:] == ["along", "direction"]:
        return _direction_of_track(mechanism, words[1], path)
    return _number_at(*spot_of_path(_tables_to_read(mechanism), words, path), path)


def _is_dynamic(path: str) -> bool:
    """Whether a path names a number of loads, contacts, controllers, the machine, the simulation or gravity."""
    return path.partition(".")[0] in ROOMS


def _number_at(container: Any, key: Any, path: str) -> float:
    value = container.get(key) if isinstance(container, dict) else container[key]
    if isinstance(value, str):
        value = _plain_number(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        what = _("{path} is not a number here").format(path=path)
        raise InputError("", what, _("give it a value first"))
    return float(value)


def _plain_number(text: str) -> float | None:
    """The number that a formula is, where it is one alone ("1")."""
    try:
        return float(text)
    except ValueError:
        return None


def with_value(description: AnyDescription, path: str, value: float | str) -> AnyDescription:
    """The mechanism, or the cam, with another number, or text with a unit, at a path.

    What was `placed` stays where it is, unless it is what the path names (then it counts as given from
    now on); `replace_placed` places anew. Raises InputError where there is no such path, or where the
    value does not fit.

    Examples
    --------
    >>> import centrode as ct
    >>> longer = ct.with_value(ct.example("crank-rocker"), "links.AB.length", "3.6 m")
    >>> longer.links["AB"].length
    3.6
    """
    if isinstance(description, Mechanism):
        return with_values(description, {path: value})
    return vary_cam(description, {path: value})


def with_values(mechanism: Mechanism, values: Mapping[str, float | str]) -> Mechanism:
    """The same with several numbers at once: only all of them together have to fit."""
    tables = document(mechanism)
    for path, value in values.items():
        if _is_dynamic(path):
            place = place_of_number(mechanism, tables, path)
            place.container[place.key] = with_number(place, value)
            continue
        container, key = spot_of_path(tables, words_of_path(mechanism, path), path)
        container[key] = value
    return mechanism_from(tables)


def kind_at(mechanism: Mechanism, path: str) -> str:
    """Kind of quantity that a path names ("length", "angle", ...); raises InputError where there is no such path."""
    if _is_dynamic(path):
        return kind_of_place(mechanism, place_of_number(mechanism, document(mechanism), path), path)
    words = words_of_path(mechanism, path)
    spot_of_path(document(mechanism), words, path)
    key, on_sphere = words[-1], mechanism.space == "sphere"
    if words[0] == "drives":
        coordinate = mechanism.motion_parameter.drive(words[1])
        return {"start": coordinate.kind, "speed": coordinate.speed_kind}.get(key, key)
    if words[0] == "links" and key in ("radius", "centre_radius"):
        return "length"
    if key in ("length", "radius"):
        return "arc" if on_sphere else "length"
    coordinates = {"x": "length", "y": "length", "longitude": "angle", "latitude": "angle"}
    return {**coordinates, "direction": "angle"}.get(key, key)


def _direction_of_track(mechanism: Mechanism, identity: str, path: str) -> float:
    track = next(wheel.along for wheel in mechanism.rolling if wheel.id == identity)
    if track.direction is None:
        what = _("{path} is not a number here").format(path=path)
        raise InputError("", what, _("the wheel rolls on a circle: give its radius or its centre"))
    return math.atan2(*reversed(track.unit)) if isinstance(track.direction, tuple) else track.direction
