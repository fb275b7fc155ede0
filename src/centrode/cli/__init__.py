"""The command line.

Plugins of pydantic are left out of its processes: looking for them reads the records of every package that is
installed, a tenth of the start of `centrode check`, and no description needs one.
"""

import os

os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
