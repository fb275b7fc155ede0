"""Renderers: sheets on a terminal, as files, as figures, as chapters of documents; they know no mechanics.

Each is loaded when first used: a run without figures imports no matplotlib.
"""

import lazy_loader

from centrode.optional_packages import telling_what_is_missing

_attached, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__getattr__ = telling_what_is_missing(_attached)
