"""Centrode: from the description of a mechanism to its motion, forces, equations, drawings and report.

The public face stands in `__init__.pyi`, in reading order; each name is imported when it is first used.
"""

import lazy_loader

from centrode.notebook import register as _show_in_notebooks
from centrode.optional_packages import telling_what_is_missing as _telling_what_is_missing
from centrode.version import __version__ as __version__

_attached, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__getattr__ = _telling_what_is_missing(_attached)

_show_in_notebooks()
