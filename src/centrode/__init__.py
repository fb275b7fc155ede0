"""Centrode: from the description of a mechanism to its motion, forces, equations, drawings and report.

A mechanism is a file ("press.toml"), the name of a built-in one ("six-bar-press"), or a `Mechanism`:

    import centrode as ct

    ct.example_names()                        # the built-in mechanisms
    ct.check("six-bar-press")                 # mobility, groups, order of solution
    motion = ct.motion("six-bar-press")       # positions, velocities, accelerations: an xarray.Dataset
    forces = ct.reactions("six-bar-press")    # forces in the joints
    print(ct.summary(forces))                 # any result in words; ct.tables, ct.figures, ct.write
    ct.write_report(ct.report("six-bar-press"), "report")

`help(ct.motion)` explains one function; the commands of the terminal do the same (`centrode --help`). All names stand
in reading order in `__init__.pyi`; each is imported when it is first used.
"""

import centrode.interruption as _interruption  # noqa: F401 (what follows takes its time)

# isort: split
import lazy_loader

from centrode.notebook import register as _show_in_notebooks
from centrode.optional_packages import telling_what_is_missing as _telling_what_is_missing
from centrode.version import __version__ as __version__

_attached, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__getattr__ = _telling_what_is_missing(_attached)

_show_in_notebooks()
