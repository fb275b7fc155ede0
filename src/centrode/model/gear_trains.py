"""The description of a train of gears that is sought by its ratio, in files and as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias

from pydantic import PlainValidator, model_validator

from centrode.locale import _
from centrode.model.cam import whole
from centrode.model.description_files import DescriptionFiles
from centrode.model.reading import KEY, DescriptionPart, Problem, choice, value_text
from centrode.model.settings import Display, GearReportWishes
from centrode.model.values import Text, angular_speed, positive, quantity, si

KIND = "gear train"
PLANETARY = ("single planets", "stepped planets", "external meshes", "internal meshes", "two carriers")
ORDINARY = ("one pair", "two pairs")
TRAIN_SCHEMES = (*PLANETARY, *ORDINARY)
"""What trains may be sought."""
FEWEST_TEETH, MOST_TEETH = 10, 250
MOST_PLANETS = 12
MOST_RATIO = 10_000.0

TrainScheme: TypeAlias = Literal[
    "single planets", "stepped planets", "external meshes", "internal meshes", "two carriers",
    "one pair", "two pairs",
]  # fmt: skip


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
        if self.driver is not None and self.scheme in (*ORDINARY, "two carriers"):
            what = _("the driver of this scheme cannot be chosen")
            raise Problem(what, _("remove driver"), ("driver",))
        return self


GEAR_TRAINS = DescriptionFiles(KIND, lambda _tables, _where: GearTrain)
"""Trains of gears in files."""
