"""`centrode balance`: counterweights for a mechanism, and what they do to its shaking force."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import centrode as ct
from centrode import render
from centrode.cli import output
from centrode.cli.about import about as naming
from centrode.cli.arguments import (
    dark_option,
    mechanism_argument,
    no_figures_option,
    samples_option,
    written_option,
)
from centrode.cli.expected import announce_size
from centrode.cli.pairs import pairs
from centrode.cli.progress import Progress
from centrode.cli.tables import tables_options
from centrode.errors import InputError
from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.dynamics.balancing.balance import To

OPTIONS: tuple[Callable[..., Any], ...] = (
    click.option(
        "--on",
        "links",
        multiple=True,
        metavar=mark("LINK"),
        help=mark('Link for a counterweight, or "LINK@POINT" with the point its radius is measured from.'),
    ),
    click.option("--full", is_flag=True, help=mark("Make the shaking force zero (the rule).")),
    click.option(
        "--least-maximum",
        "least",
        is_flag=True,
        help=mark("Make the greatest effects as small as they can be."),
    ),
    click.option(
        "--fraction",
        metavar=mark("F"),
        help=mark('Slider-crank: balance what turns, and this much of what moves to and fro ("1/2").'),
    ),
    click.option(
        "--moment", is_flag=True, help=mark("With --full: balance the shaking moment too, by discs.")
    ),
    click.option(
        "--weights",
        metavar=mark("F,M,T"),
        help=mark("With --least-maximum: weights of force, moment and drive (1,0,0 if left out)."),
    ),
    click.option(
        "--radius",
        "radii",
        multiple=True,
        metavar=mark("[LINK=]LENGTH"),
        help=mark('Distance of the counterweight from its point ("50 mm").'),
    ),
    click.option(
        "--most",
        "heaviest",
        multiple=True,
        metavar=mark("[LINK=]MASS"),
        help=mark('Greatest mass of a counterweight ("3 kg").'),
    ),
    click.option(
        "--thickness", metavar=mark("LENGTH"), help=mark("Counterweights are discs of this thickness.")
    ),
    click.option("--density", metavar=mark("DENSITY"), help=mark("Density of discs (steel if left out).")),
    click.option(
        "--about",
        metavar=mark("PLACE"),
        help=mark('What moments are taken about: a point of the frame, or "0.2,0.1" in metres.'),
    ),
    click.option(
        "--steady", is_flag=True, help=mark("At the real speed of the machine, not at its mean speed.")
    ),
)


def with_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with its own options, in this order."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


@click.command(help=mark("Find counterweights that balance a mechanism."))
@mechanism_argument
@with_options
@written_option
@tables_options
@samples_option
@no_figures_option
@dark_option
def balance(
    mechanism: str, out: Path | None, samples: int | None, no_figures: bool, dark: bool, **given: Any
) -> None:
    """Print counterweights and what they do; write the balanced description and pictures where asked."""
    description = ct.load(mechanism)
    announce_size(description, samples)
    names: list[str] = []
    asked = _asked(given)
    if out is None:
        with naming(mechanism):
            found = ct.balance(description, samples=samples, **asked)
    else:
        with output.output_folder(out) as draft, Progress() as progress:
            progress.say(_("solving"))
            with naming(mechanism):
                found = ct.balance(description, samples=samples, **asked)
            _write(found, draft, progress, figures=not no_figures, dark=dark)
            names = output.finished(draft)
    click.echo(_(description.title) or mechanism)
    click.echo()
    click.echo(render.aligned(ct.balance_rows(found)))
    header, rows = ct.balance_effects(found)
    click.echo("\n" + render.aligned(rows, header, right=(2, 3, 4)))
    steps = ct.balance_steps(found)
    if steps:
        click.echo("\n" + "\n".join([_("masses replaced at the joints:"), *(f"  {step}" for step in steps)]))
    if out is not None:
        click.echo("\n" + output.files_in(out, names))


def _asked(given: dict[str, Any]) -> dict[str, Any]:
    """The arguments of `ct.balance` that the options say."""
    found: dict[str, Any] = {
        "on": given["links"] or None,
        "to": _aim(given),
        "moment": given["moment"],
        "speed": "steady" if given["steady"] else "mean",
        "radius": _by_link(given["radii"], "--radius", "OA=50 mm"),
        "most": _by_link(given["heaviest"], "--most", "OA=3 kg"),
        "thickness": given["thickness"],
    }
    if given["fraction"] is not None:
        found["fraction"] = given["fraction"]
    if given["density"] is not None:
        if given["thickness"] is None:
            raise InputError("--density", _("it belongs to --thickness"), _("give that too"))
        found["density"] = given["density"]
    if given["weights"] is not None:
        if found["to"] != "least":
            raise InputError("--weights", _("they belong to --least-maximum"), _("say that too"))
        found["weights"] = [part.strip() for part in given["weights"].split(",")]
    if given["about"] is not None:
        found["about"] = _place(given["about"])
    return found


def _aim(given: dict[str, Any]) -> To:
    """What the balance is for; InputError where several things are asked for."""
    asked = {
        "--full": given["full"],
        "--least-maximum": given["least"],
        "--fraction": given["fraction"] is not None,
    }
    named = [option for option, said in asked.items() if said]
    if len(named) > 1:
        what = _("{one} and {other} are given together").format(one=named[0], other=named[1])
        raise InputError(named[1], what, _("keep one of them"))
    if not named:
        return "full"
    kinds: dict[str, To] = {"--full": "full", "--least-maximum": "least", "--fraction": "fraction"}
    return kinds[named[0]]


def _by_link(texts: tuple[str, ...], where: str, sample: str) -> str | dict[str, str] | None:
    """One value for all, or values by link."""
    if not texts:
        return None
    if len(texts) == 1 and "=" not in texts[0]:
        return texts[0]
    return pairs(texts, where, sample)


def _place(text: str) -> str | tuple[float, float]:
    """A name, or two coordinates."""
    first, sign, second = text.partition(",")
    if not sign:
        return text
    try:
        return float(first), float(second)
    except ValueError:
        what = _("expected a point of the frame or two numbers, got {text}").format(text=f'"{text}"')
        raise InputError("--about", what, _("write {sample}").format(sample='"0.2,0.1"')) from None


def _write(found: ct.Balance, folder: Path, progress: Progress, *, figures: bool, dark: bool) -> None:
    progress.say(_("writing tables"))
    (folder / "balanced.toml").write_text(ct.mechanism_text(found.balanced), encoding="utf-8")
    ct.write_balance_csv(found, folder / "balance.csv")
    ct.write_harmonics_csv(found, folder / "harmonics.csv")
    if figures:
        progress.say(_("drawing"))
        drawn = ct.balance_figures(found, ct.motion(found.mechanism))
        shown = {name: ct.darkened(figure) for name, figure in drawn.items()} if dark else drawn
        ct.save_figures(shown, folder)
