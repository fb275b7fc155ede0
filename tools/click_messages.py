"""The sentences of click that a user of centrode can see, for extraction into the catalogues; never run.

Click asks the standard library's gettext for them, and that is pointed at centrode's catalogues when the
command line starts. They are written here exactly as in click 8.5.
"""

from centrode.locale import _, mark, ngettext

n = 1

_("Usage:")
mark("[OPTIONS]")
mark("COMMAND [ARGS]...")
_("Options")
_("Positional arguments")
_("Commands")
_("Show this message and exit.")
_("Show the version and exit.")
_("%(prog)s, version %(version)s")
_("default: {default}")
_("required")
_("(dynamic)")
_("env var: {var}")

_("Error: {message}")
_("Try '{command} {option}' for help.")
_("Missing command.")
_("Missing argument")
_("Missing option")
_("Missing parameter")
_("No such command {name!r}.")
_("No such option {name!r}.")
ngettext("Did you mean {possibility}?", "(Did you mean one of: {possibilities}?)", n)
ngettext("Got unexpected extra argument ({args})", "Got unexpected extra arguments ({args})", n)
ngettext("Option {name!r} requires an argument.", "Option {name!r} requires {nargs} arguments.", n)
_("Option {name!r} does not take a value.")
_("Argument {name!r} takes {nargs} values.")
_("Invalid value: {message}")
_("Invalid value for {param_hint}: {message}")
_("Choose from:\n\t{choices}")
ngettext("{value!r} is not {choice}.", "{value!r} is not one of {choices}.", n)
_("{value!r} is not a valid {number_type}.")
_("{value} is not in the range {range}.")
_("{value!r} is not a valid boolean. Recognized values: {states}")

mark("text")
mark("integer")
mark("integer range")
mark("float")
mark("float range")
mark("boolean")
mark("choice")
mark("path")
mark("file")
mark("directory")
