"""A mechanism or a cam by the name of a file or of a built-in example."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, TypeAlias, overload

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam, parse_cam, read_cam
from centrode.model.examples import FOLDERS, example_names, example_text
from centrode.model.files import parse_mechanism, read_mechanism
from centrode.model.follower_cam import PlateCam
from centrode.model.gear_pairs import GearPair, parse_gear_pair, read_gear_pair
from centrode.model.gear_trains import GearTrain, parse_gear_train, read_gear_train
from centrode.model.mechanism import Mechanism
from centrode.model.reading import likely, read_file, value_text
from centrode.model.toml import description_kind, toml_tables

CamName: TypeAlias = Literal["cam-from-curvature", "walking-wheel-four-legs", "walking-wheel-three-legs"]
PlateName: TypeAlias = Literal["indexing-cam", "valve-cam"]
MechanismSource: TypeAlias = Mechanism | str | Path
"""A mechanism, or the name of its file or of a built-in one: what every function of a mechanism takes."""
CamSource: TypeAlias = AnyCam | str | Path
GearPairSource: TypeAlias = GearPair | str | Path
GearTrainSource: TypeAlias = GearTrain | str | Path
DescriptionSource: TypeAlias = Mechanism | AnyCam | str | Path


GearPairName: TypeAlias = Literal[
    "internal-gear-pair", "rack-gear-pair", "shifted-gear-pair", "helical-gear-pair"
]


GearTrainName: TypeAlias = Literal["single-planet-train", "stepped-planet-train", "two-ring-train"]


@overload
def example(name: GearTrainName) -> GearTrain: ...  # type: ignore[overload-overlap]
@overload
def example(name: GearPairName) -> GearPair: ...  # type: ignore[overload-overlap]
@overload
def example(name: CamName) -> Cam: ...  # type: ignore[overload-overlap]
@overload
def example(name: PlateName) -> PlateCam: ...  # type: ignore[overload-overlap]
@overload
def example(name: str) -> Mechanism: ...
def example(name: str) -> Mechanism | Cam | PlateCam | GearPair | GearTrain:
    """The built-in mechanism, cam, pair or train of gears of a name; InputError if there is none.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.example("crank-rocker").title
    'Crank-rocker four-bar linkage'
    """
    if name in example_names("cam"):
        return parse_cam(example_text(name), f"{name}.toml")
    if name in example_names("gear pair"):
        return parse_gear_pair(example_text(name), f"{name}.toml")
    if name in example_names("gear train"):
        return parse_gear_train(example_text(name), f"{name}.toml")
    return parse_mechanism(example_text(name), f"{name}.toml")


def load(file_or_example: str | Path) -> Mechanism:
    """The mechanism in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a linkage.
    """
    path = _file(file_or_example)
    if path is not None:
        return read_mechanism(path)
    name = str(file_or_example)
    return parse_mechanism(example_text(name), f"{name}.toml")


def load_cam(file_or_example: str | Path) -> AnyCam:
    """The cam in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a cam.
    """
    path = _file(file_or_example)
    if path is not None:
        return read_cam(path)
    name = str(file_or_example)
    return parse_cam(example_text(name), f"{name}.toml")


def load_gear_pair(file_or_example: str | Path) -> GearPair:
    """The pair of gears in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a pair.
    """
    path = _file(file_or_example)
    if path is not None:
        return read_gear_pair(path)
    name = str(file_or_example)
    return parse_gear_pair(example_text(name), f"{name}.toml")


def load_gear_train(file_or_example: str | Path) -> GearTrain:
    """The train of gears in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a train.
    """
    path = _file(file_or_example)
    if path is not None:
        return read_gear_train(path)
    name = str(file_or_example)
    return parse_gear_train(example_text(name), f"{name}.toml")


def load_either(file_or_example: str | Path) -> Mechanism | AnyCam:
    """The mechanism or the cam in a TOML file, or the built-in one of that name; InputError if there is neither."""
    path = _file(file_or_example)
    name = path.name if path else f"{file_or_example}.toml"
    text = read_file(path) if path else example_text(str(file_or_example))
    reads = parse_cam if description_kind(toml_tables(text, name)) == "cam" else parse_mechanism
    return reads(text, name, path.parent if path else None)


def load_drawn(file_or_example: str | Path) -> Mechanism | AnyCam | GearPair:
    """What sheets are drawn of: a mechanism, a cam or a pair of gears in a file, or the built-in one of that name."""
    path = _file(file_or_example)
    name = path.name if path else f"{file_or_example}.toml"
    text = read_file(path) if path else example_text(str(file_or_example))
    if description_kind(toml_tables(text, name)) == "gear pair":
        return parse_gear_pair(text, name, path.parent if path else None)
    return load_either(file_or_example)


def mechanism_of(source: MechanismSource) -> Mechanism:
    """The mechanism itself, or the one that `load` finds under a name; InputError for anything else."""
    source = load(source) if isinstance(source, str | Path) else source
    if not isinstance(source, Mechanism):
        raise _refusal(_("this function takes a mechanism, its file or the name of a built-in one"), source)
    return source


def cam_of(source: CamSource) -> AnyCam:
    """The cam itself, or the one that `load_cam` finds under a name; InputError for anything else."""
    source = load_cam(source) if isinstance(source, str | Path) else source
    if not isinstance(source, Cam | PlateCam):
        raise _refusal(_("this function takes a cam, its file or the name of a built-in one"), source)
    return source


def gear_pair_of(source: GearPairSource) -> GearPair:
    """The pair itself, or the one that `load_gear_pair` finds under a name; InputError for anything else."""
    source = load_gear_pair(source) if isinstance(source, str | Path) else source
    if not isinstance(source, GearPair):
        raise _refusal(
            _("this function takes a pair of gears, its file or the name of a built-in one"), source
        )
    return source


def gear_train_of(source: GearTrainSource) -> GearTrain:
    """The train itself, or the one that `load_gear_train` finds under a name; InputError for anything else."""
    source = load_gear_train(source) if isinstance(source, str | Path) else source
    if not isinstance(source, GearTrain):
        raise _refusal(
            _("this function takes a train of gears, its file or the name of a built-in one"), source
        )
    return source


def description_of(source: DescriptionSource) -> Mechanism | AnyCam:
    """The mechanism or the cam itself, or what `load_either` finds under a name; InputError for anything else."""
    source = load_either(source) if isinstance(source, str | Path) else source
    if not isinstance(source, Mechanism | Cam | PlateCam):
        raise _refusal(
            _("this function takes a mechanism or a cam, its file or the name of a built-in one"), source
        )
    return source


def _refusal(takes: str, given: object) -> InputError:
    return InputError("", takes, _("it got a value of type {kind}").format(kind=type(given).__name__))


def _file(file_or_example: str | Path) -> Path | None:
    """The file that is meant; None where it is a built-in example."""
    path = Path(file_or_example)
    name = str(file_or_example)
    if path.suffix == ".toml" or path.name != name or path.is_file():
        return path
    names = tuple(name for kind in FOLDERS for name in example_names(kind))
    if name in names:  # a folder of this name, such as one of results, does not hide it
        return None
    if path.exists():
        return path
    near = likely(name, names)
    raise InputError(
        value_text(name)[1:-1],
        _("no such file, and no built-in mechanism of this name"),
        near or _("give a TOML file, or a name that centrode examples lists"),
    )
