"""XML of strangers: bounded, without entities, with nothing fetched."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

from centrode.errors import InputError
from centrode.locale import _

MOST_ELEMENTS = 20_000
DEEPEST = 60


@dataclass
class Element:
    """An element: its name without namespace, its attributes without namespaces, text, children."""

    name: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def get(self, name: str, default: str = "") -> str:
        """An attribute."""
        return self.attributes.get(name, default)


def xml_tree(content: bytes, where: str) -> Element:
    """The root element of a text of XML.

    Raises InputError where it is not well formed, declares entities, or is too large.

    Notes
    -----
    Expat fetches nothing by itself; declared entities are refused, so that none can swell.
    """
    parser = expat.ParserCreate()
    open_elements: list[Element] = []
    root: list[Element] = []
    count = 0

    def refuse(what: str) -> NoReturn:
        raise InputError(where, what, _("save it as plain SVG or XML"))

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if count > MOST_ELEMENTS or len(open_elements) >= DEEPEST:
            what = _("the file has too many elements, or they are nested too deeply")
            raise InputError(where, what, _("keep the mechanism alone"))
        element = Element(_local(name), {_local(key): value for key, value in attributes.items()})
        (open_elements[-1].children if open_elements else root).append(element)
        open_elements.append(element)

    def end(_name: str) -> None:
        open_elements.pop()

    def words(text: str) -> None:
        if open_elements:
            open_elements[-1].text += text

    def entity(*_declared: object) -> None:
        refuse(_("the file declares entities, which are not read"))

    def outside(*_declared: object) -> int:
        refuse(_("the file declares entities, which are not read"))

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = words
    parser.EntityDeclHandler = entity
    parser.ExternalEntityRefHandler = outside
    parser.buffer_text = True
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        what = _("the file is not well formed XML: line {line}, column {column}")
        raise InputError(where, what.format(line=error.lineno, column=error.offset + 1)) from None
    except (LookupError, ValueError):
        raise InputError(where, _("the encoding of the file is not known"), _("save it as UTF-8")) from None
    if not root:
        refuse(_("the file is empty"))
    return root[0]


def _local(name: str) -> str:
    """A name without its prefix."""
    return name.rpartition(":")[2]
