"""Arguments of a topic's computation, from its options as somebody gives them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode.topics.topic import Command, ValueOption


def option_name(name: str) -> str:
    """An option as it is written."""
    return "--" + name.replace("_", "-")


def option_arguments(command: Command, mechanism: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of the computation; those that the user left out are left to it."""
    if command.arguments is not None:
        return dict(command.arguments(given))
    arguments = {name: value for name, value in given.items() if value is not None and value != ()}
    for option in command.options:
        if isinstance(option, ValueOption) and option.name in arguments:
            value = arguments.pop(option.name)
            if option.read is not None:
                value = option.read(mechanism, value, option_name(option.name))
            arguments[option.parameter or option.name] = value
    return arguments
