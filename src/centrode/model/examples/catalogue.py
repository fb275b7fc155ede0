"""A mechanism or a cam by the name of a file or of a built-in example."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias, overload

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.model.cam_files import CAMS, AnyCam
from centrode.model.description_files import DescriptionFiles
from centrode.model.examples import FOLDERS, example_names, example_text
from centrode.model.files import MECHANISMS
from centrode.model.follower_cam import PlateCam
from centrode.model.gear_pairs import GEAR_PAIRS, GearPair
from centrode.model.gear_trains import GEAR_TRAINS, GearTrain
from centrode.model.mechanism import Mechanism
from centrode.model.reading import DescriptionPart, likely, read_file, value_text
from centrode.model.toml import Described as OneKind
from centrode.model.toml import description_kind, toml_tables

_FILES: Mapping[str, DescriptionFiles[Any]] = {
    files.kind: files for files in (MECHANISMS, CAMS, GEAR_PAIRS, GEAR_TRAINS)
}

CamName: TypeAlias = Literal["cam-from-curvature", "walking-wheel-four-legs", "walking-wheel-three-legs"]
PlateName: TypeAlias = Literal["indexing-cam", "valve-cam"]
MechanismSource: TypeAlias = Mechanism | str | Path
"""A mechanism, or the name of its file or of a built-in one: what every function of a mechanism takes."""
CamSource: TypeAlias = AnyCam | str | Path
GearPairSource: TypeAlias = GearPair | str | Path
GearTrainSource: TypeAlias = GearTrain | str | Path
DescriptionSource: TypeAlias = Mechanism | AnyCam | str | Path
Described: TypeAlias = Mechanism | AnyCam | GearPair | GearTrain
"""What a file may describe."""
DescribedSource: TypeAlias = Described | str | Path


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
    kind = next((kind for kind in FOLDERS if name in example_names(kind)), MECHANISMS.kind)
    return _FILES[kind].example(name)  # type: ignore[no-any-return]


def load(file_or_example: str | Path) -> Mechanism:
    """The mechanism in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a linkage.
    """
    return _load(MECHANISMS, file_or_example)


def load_cam(file_or_example: str | Path) -> AnyCam:
    """The cam in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a cam.
    """
    return _load(CAMS, file_or_example)


def load_gear_pair(file_or_example: str | Path) -> GearPair:
    """The pair of gears in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a pair.
    """
    return _load(GEAR_PAIRS, file_or_example)


def load_gear_train(file_or_example: str | Path) -> GearTrain:
    """The train of gears in a TOML file, or the built-in one of that name; a file goes before an example.

    Raises InputError if there is neither, or the file is no description of a train.
    """
    return _load(GEAR_TRAINS, file_or_example)


def load_either(file_or_example: str | Path) -> Mechanism | AnyCam:
    """The mechanism or the cam in a TOML file, or the built-in one of that name; InputError if there is neither."""
    return _load_kinds(("linkage", "cam"), file_or_example)  # type: ignore[return-value]


def load_drawn(file_or_example: str | Path) -> Mechanism | AnyCam | GearPair:
    """What sheets are drawn of: a mechanism, a cam or a pair of gears in a file, or the built-in one of that name."""
    return _load_kinds(("linkage", "cam", "gear pair"), file_or_example)  # type: ignore[return-value]


def load_description(file_or_example: str | Path) -> Described:
    """What a TOML file describes, of any kind, or the built-in one of that name; InputError if there is neither."""
    return _load_kinds(tuple(_FILES), file_or_example)  # type: ignore[return-value]


def _load(files: DescriptionFiles[OneKind], file_or_example: str | Path) -> OneKind:
    path = _file(file_or_example)
    return files.read(path) if path is not None else files.example(str(file_or_example))


def _load_kinds(kinds: tuple[str, ...], file_or_example: str | Path) -> DescriptionPart:
    """What a file describes, or the built-in one of that name, of one of several kinds, the first if it says none."""
    path = _file(file_or_example)
    name = path.name if path else f"{file_or_example}.toml"
    text = read_file(path) if path else example_text(str(file_or_example))
    kind = description_kind(toml_tables(text, name))
    known = kind if kind is not None and kind in kinds else kinds[0]
    return _FILES[known].parse(text, name, path.parent if path else None)  # type: ignore[no-any-return]


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


def reported_description(source: DescribedSource) -> Described:
    """The description itself, or what `load_description` finds under a name; InputError for anything else."""
    described: object = load_description(source) if isinstance(source, str | Path) else source
    if isinstance(described, Mechanism | Cam | PlateCam | GearPair | GearTrain):
        return described
    what = _("this function takes a mechanism, a cam, or a pair or train of gears, its file or its name")
    raise _refusal(what, described)


def files_of(description: Described) -> DescriptionFiles[Any]:
    """What reads and writes descriptions of the kind of one."""
    if isinstance(description, Mechanism):
        return MECHANISMS
    return _FILES[description.kind]


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
    with_ending = f"{name}.toml"
    beside = Path(with_ending).is_file()
    near = _("did you mean {name}?").format(name=value_text(with_ending)) if beside else likely(name, names)
    raise InputError(
        value_text(name)[1:-1],
        _("no such file, and no built-in mechanism of this name"),
        near or _("give a TOML file, or a name that centrode examples lists"),
    )
