"""The function `centrode.study` by way of the room of its name, whose import would hide it otherwise."""

from __future__ import annotations

from centrode.dynamics.motion_results import study as study
