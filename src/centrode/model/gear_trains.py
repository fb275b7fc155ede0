"""The description of a train of gears that is sought by its ratio, in files and as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import PlainValidator, model_validator

from centrode.locale import _
from centrode.model.cam import whole
from centrode.model.description_files import DescriptionFiles
from centrode.model.reading import KEY, DescriptionPart, Problem, choice, nearest, value_text
from centrode.model.settings import Display, GearReportWishes
from centrode.model.values import Text, angular_speed, positive, quantity, si

KIND = "gear train"
PLANETARY = (
    "single planets", "stepped planets", "external meshes", "internal meshes", "two carriers", "closed",
)  # fmt: skip
ORDINARY = ("one pair", "two pairs")
CLOSED = "closed"
TRAIN_SCHEMES = (*PLANETARY, *ORDINARY)
"""What trains may be sought."""
FEWEST_TEETH, MOST_TEETH = 10, 250
MOST_PLANETS = 12
MOST_RATIO = 10_000.0

TrainScheme: TypeAlias = Literal[
    "single planets", "stepped planets", "external meshes", "internal meshes", "two carriers", "closed",
    "one pair", "two pairs",
]  # fmt: skip
Shaft: TypeAlias = tuple[str, ...]
SET_MEMBERS = ("sun 1", "ring 1", "carrier 1", "sun 2", "ring 2", "carrier 2")
"""Members of both planetary sets of a closed train."""


def _read_ratio(value: object) -> float:
    number = si(value, "ratio")
    if not 0 < abs(number) <= MOST_RATIO:
        what = _("{key} must not be zero, and at most {most:g} in size, got {value}")
        raise Problem(what.format(key=KEY, most=MOST_RATIO, value=value_text(value)))
    return number


def _share(least: float, most: float) -> PlainValidator:
    def read(value: object) -> float:
        number = si(value, "ratio")
        if not least <= number <= most:
            what = _("{key} must lie between {least:g} and {most:g}, got {value}")
            raise Problem(what.format(key=KEY, least=least, most=most, value=value_text(value)))
        return number

    return PlainValidator(read)


def _two_numbers(value: object) -> tuple[int, int]:
    """Two numbers of teeth."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        form = _("[number, number]")
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    for teeth in value:
        if isinstance(teeth, bool) or not isinstance(teeth, int) or not FEWEST_TEETH <= teeth <= MOST_TEETH:
            what = _("a number of teeth is a whole number from {least} to {most}, got {value}")
            raise Problem(what.format(least=FEWEST_TEETH, most=MOST_TEETH, value=value_text(teeth)))
    return value[0], value[1]


def _bounds(value: object) -> tuple[int, int]:
    least, most = _two_numbers(value)
    if least > most:
        raise Problem(_("the least number of teeth exceeds the greatest one"), _("exchange them"))
    return least, most


class MeshLosses(DescriptionPart):
    """Efficiencies of meshes on fixed axes.

    Attributes
    ----------
    external, internal : of a mesh of two external wheels, and of one in a ring
    """

    external: Annotated[float, _share(0.5, 1.0)] = 0.98
    internal: Annotated[float, _share(0.5, 1.0)] = 0.99


def _read_member(value: object) -> str:
    if value not in SET_MEMBERS:
        what = _("{value} is no member of a planetary set").format(value=value_text(value))
        raise Problem(what, nearest(value, list(SET_MEMBERS)) if isinstance(value, str) else "")
    return str(value)


def _read_joined(value: object) -> tuple[tuple[str, str], tuple[str, str]]:
    """Two pairs of members, those of set 1 first."""
    form = '[["carrier 1", "sun 2"], ["ring 1", "ring 2"]]'
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    pairs = []
    for pair in value:
        if not isinstance(pair, list | tuple) or len(pair) != 2:
            raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(pair)))
        first, second = sorted(map(_read_member, pair), key=lambda member: member[-1])
        if first[-1] == second[-1]:
            what = _("{first} and {second} belong to one set, which would turn as one body")
            raise Problem(
                what.format(first=value_text(first), second=value_text(second)),
                _("join a member of set 1 with one of set 2"),
            )
        pairs.append((first, second))
    members = [member for pair in pairs for member in pair]
    for member in members:
        if members.count(member) > 1:
            what = _("{member} is joined twice").format(member=value_text(member))
            raise Problem(what, _("join two members of each set"))
    return pairs[0], pairs[1]


class ClosedShafts(DescriptionPart):
    """The four shafts of a closed train: what two planetary sets have in common, and what drives, is driven, rests.

    Attributes
    ----------
    joined : two pairs of members, of set 1 and of set 2, that are one shaft each
    input, output, fixed : a member of the shaft that drives, of that which is driven, of that which is at rest
    """

    joined: Annotated[tuple[tuple[str, str], tuple[str, str]], PlainValidator(_read_joined)]
    input: Annotated[str, PlainValidator(_read_member)]
    output: Annotated[str, PlainValidator(_read_member)]
    fixed: Annotated[str, PlainValidator(_read_member)]

    def shaft(self, member: str) -> Shaft:
        """The members of the shaft that one of them belongs to."""
        return next((pair for pair in self.joined if member in pair), (member,))

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """All four shafts, in the order of `SET_MEMBERS`."""
        return tuple(dict.fromkeys(self.shaft(member) for member in SET_MEMBERS))

    @property
    def inner(self) -> Shaft:
        """The shaft that neither drives nor is driven nor rests: a joined one, that of set 1 first."""
        used = {self.shaft(member) for member in (self.input, self.output, self.fixed)}
        return next(shaft for shaft in self.shafts if shaft not in used)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        ends = {"input": self.input, "output": self.output, "fixed": self.fixed}
        met: dict[Shaft, str] = {}
        for key, member in ends.items():
            shaft = self.shaft(member)
            if shaft in met:
                what = _("{one} and {other} name the same shaft").format(one=met[shaft], other=key)
                raise Problem(what, _("name a member of another shaft"), (key,))
            met[shaft] = key
        if len(self.inner) == 1:
            # Nothing balances a moment on a free member, so its set has none at all.
            what = _("{member} is free, so its set bears no moment").format(member=value_text(self.inner[0]))
            raise Problem(what, _("let it drive, be driven or rest, or join it"), ("joined",))
        return self


class GearTrain(DescriptionPart):
    """A train of gears, ordinary or planetary, whose numbers of teeth are sought by its ratio.

    The arguments are those of a file (docs: trains), texts with units included. All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "gear train"
    display : Display
    scheme : of `TRAIN_SCHEMES`
    ratio : speed of what drives over that of what is driven; a positive one in either sense of rotation
    input_speed, output_speed : of motor and crank [rad/s]; both in place of the ratio
    pair_behind : teeth of an ordinary pair between the train and what it drives
    driver : "sun" or "carrier" of a planetary train
    shafts : ClosedShafts, of a closed train alone
    planets : number of them
    module : m [m]
    teeth : least and greatest number
    tolerance : of the ratio, relative
    mesh_efficiency : MeshLosses
    chosen : number of the train in the list that is shown in full
    report : GearReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.GearTrain(kind="gear train", scheme="single planets", ratio=5.6, module="4 mm").planets
    3
    """

    title: Text = ""
    kind: Annotated[Literal["gear train"], choice(KIND)]
    display: Display = Display()
    scheme: Annotated[TrainScheme, choice(*TRAIN_SCHEMES)]
    ratio: Annotated[float, PlainValidator(_read_ratio)] | None = None
    input_speed: Annotated[float, PlainValidator(angular_speed)] | None = None
    output_speed: Annotated[float, PlainValidator(angular_speed)] | None = None
    pair_behind: Annotated[tuple[int, int], PlainValidator(_two_numbers)] | None = None
    driver: Annotated[Literal["sun", "carrier"], choice("sun", "carrier")] | None = None
    shafts: ClosedShafts | None = None
    planets: Annotated[int, whole(1, MOST_PLANETS)] = 3
    module: Annotated[float, quantity("length", positive)]
    teeth: Annotated[tuple[int, int], PlainValidator(_bounds)] = (17, 120)
    tolerance: Annotated[float, _share(0.0, 0.2)] = 0.02
    mesh_efficiency: MeshLosses = MeshLosses()
    chosen: Annotated[int, whole(1, 1000)] = 1
    report: GearReportWishes = GearReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @property
    def whole_ratio(self) -> float:
        """From the motor to the crank, with its sign: the ratio, or the quotient of both speeds."""
        if self.ratio is not None:
            return self.ratio
        assert self.input_speed is not None
        assert self.output_speed is not None
        return self.input_speed / self.output_speed

    @property
    def train_ratio(self) -> float:
        """What is left for the train itself, without the pair behind it, which turns the sense round."""
        if self.pair_behind is None:
            return self.whole_ratio
        driving, driven = self.pair_behind
        behind = driven / driving
        # A negative ratio asks for a sense, which the pair turns round; a positive one is met in either.
        return self.whole_ratio / behind

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        speeds = [speed for speed in (self.input_speed, self.output_speed) if speed is not None]
        if self.ratio is not None and len(speeds) == 2:
            what = _("the ratio and both speeds are given: one of them follows")
            raise Problem(what, _("remove one of them"), ("ratio",))
        if self.ratio is None and len(speeds) < 2:
            what = _("the ratio is missing")
            raise Problem(what, _("give ratio, or input_speed and output_speed"), ("ratio",))
        if 0.0 in speeds:
            raise Problem(
                _("a shaft at rest has no ratio"), _("give a speed that is not zero"), ("input_speed",)
            )
        if self.pair_behind is not None and self.whole_ratio < 0:
            what = _("with a pair behind the train the sense of rotation follows from both")
            raise Problem(what, _("give the ratio without a sign"), ("ratio",))
        if self.driver is not None and self.scheme in (*ORDINARY, "two carriers", CLOSED):
            what = _("the driver of this scheme cannot be chosen")
            raise Problem(what, _("remove driver"), ("driver",))
        if (self.scheme == CLOSED) != (self.shafts is not None):
            if self.shafts is None:
                what = _("the shafts of a closed train are missing")
                raise Problem(what, _("give shafts = { joined, input, output, fixed }"), ("shafts",))
            what = _("only a closed train has shafts that are joined")
            raise Problem(what, _('remove shafts, or take scheme = "closed"'), ("shafts",))
        return self


GEAR_TRAINS = DescriptionFiles(KIND, lambda _tables, _where: GearTrain)
"""Trains of gears in files."""
