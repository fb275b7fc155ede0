"""The built-in mechanisms: TOML files beside this one, each with its source and the facts to look at."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from centrode.errors import InputError
from centrode.locale import _

DIRECTORY = Path(__file__).parent
FOLDERS = {
    "linkage": DIRECTORY,
    "cam": DIRECTORY / "cams",
    "gear pair": DIRECTORY / "gears",
    "gear train": DIRECTORY / "trains",
}
"""Where the descriptions of each kind lie."""


def example_names(kind: str = "linkage") -> tuple[str, ...]:
    """Names of the built-in mechanisms of a kind, "linkage", "cam", "gear pair" or "gear train", sorted.

    Examples
    --------
    >>> import centrode as ct
    >>> "crank-rocker" in ct.example_names()
    True
    >>> ct.example_names("cam")[0]
    'cam-from-curvature'
    """
    if kind not in FOLDERS:
        what = _("there are no built-in mechanisms of kind {kind}").format(kind=f'"{kind}"')
        raise InputError("", what, _("use one of {known}").format(known=", ".join(FOLDERS)))
    return tuple(sorted(path.stem for path in FOLDERS[kind].glob("*.toml")))


def example_text(name: str) -> str:
    """The TOML text of a built-in mechanism.

    Raises InputError if there is none of this name.
    """
    folders = {known: folder for kind, folder in FOLDERS.items() for known in example_names(kind)}
    names = sorted(folders)
    if name not in folders:
        near = get_close_matches(name, names, n=1)
        repair = (
            _('did you mean "{name}"?').format(name=near[0])
            if near
            else _("list them with: centrode examples")
        )
        raise InputError("", _('there is no built-in mechanism called "{name}"').format(name=name), repair)
    return (folders[name] / f"{name}.toml").read_text(encoding="utf-8")
