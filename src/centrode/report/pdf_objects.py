"""The objects of a PDF packed: dictionaries and arrays compressed together, as PDF has it since version 1.5.

Typst writes each object by itself and uncompressed. A tagged document has thousands of them, one for each cell of a
table: half of its size, of which a tenth is left. Source: ISO 32000-1, 7.5.7 and 7.5.8; PDF/A-2 (ISO 19005-2) allows
both kinds of streams.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator, Mapping
from itertools import pairwise

TOGETHER = 200
"""Objects of one stream."""
LEVEL = 9
_START = re.compile(rb"startxref\s+(\d+)\s+%%EOF\s*\Z")
_SECTION = re.compile(rb"(\d+) (\d+)[ \r]*\n")
_OBJECT = re.compile(rb"(\d+) 0 obj\s")
_COMPRESSED = re.compile(
    rb"<<(?=(?:(?!stream).)*?/Filter\s*/FlateDecode)(?!(?:(?!stream).)*?/DecodeParms)(?:(?!stream).)*?"
    rb"/Length (?P<length>\d+)\b(?:(?!stream).)*?>>\s*stream\r?\n(?P<data>.*)\r?\nendstream\s*",
    re.DOTALL,
)
_STREAM = re.compile(rb">>\s*stream\r?\n")


def packed_pdf(document: bytes) -> bytes:
    """The same document with its objects in streams; as it is where it is not written as typst writes it."""
    found = _START.search(document)
    if found is None or not document.startswith(b"xref", int(found.group(1))):
        return document
    places, trailer = _places(document, int(found.group(1)))
    if b"/Encrypt" in trailer:
        return document
    starts = sorted([*places.values(), int(found.group(1))])
    ends = dict(pairwise(starts))
    objects: dict[int, bytes] = {}
    for number, place in places.items():
        text = document[place : ends[place]]
        head = _OBJECT.match(text)
        if head is None or int(head.group(1)) != number:
            return document
        objects[number] = text[head.end() : text.rindex(b"endobj")].strip()
    return _written(document[: min(places.values())], objects, trailer)


def _places(document: bytes, start: int) -> tuple[dict[int, int], bytes]:
    """Where each object stands, by the table of a document; and what is in its trailer."""
    places: dict[int, int] = {}
    at = start + len(b"xref")
    while section := _SECTION.match(document, _skip_blanks(document, at)):
        first, count = map(int, section.groups())
        at = section.end() + 20 * count
        for number in range(count):
            entry = document[section.end() + 20 * number :][:20]
            if entry[17:18] == b"n":
                places[first + number] = int(entry[:10])
    text = document[document.index(b"trailer", at) + len(b"trailer") : document.rindex(b"startxref")].strip()
    return places, text.removeprefix(b"<<").removesuffix(b">>").strip()


def _skip_blanks(document: bytes, at: int) -> int:
    while document[at : at + 1].isspace():
        at += 1
    return at


def _written(head: bytes, objects: Mapping[int, bytes], trailer: bytes) -> bytes:
    """Streams as they are, everything else in streams of objects, and a table of all of them as a stream."""
    out = bytearray(head)
    entries: dict[int, tuple[int, int, int]] = {0: (0, 0, 65535)}
    packed: list[int] = []
    for number, text in objects.items():
        if _STREAM.search(text):
            text = _tighter(text)
            entries[number] = 1, len(out), 0
            out += b"%d 0 obj\n%b\nendobj\n" % (number, text)
        else:
            packed.append(number)
    last = max(objects)
    for first in range(0, len(packed), TOGETHER):
        some = packed[first : first + TOGETHER]
        last += 1
        entries[last] = 1, len(out), 0
        entries |= {number: (2, last, k) for k, number in enumerate(some)}
        out += _stream(last, *_object_stream([(number, objects[number]) for number in some]))
    last += 1
    entries[last] = 1, len(out), 0
    start = len(out)
    out += _stream(last, *_table(entries, last + 1, trailer))
    return bytes(out) + b"startxref\n%d\n%%%%EOF" % start


def _tighter(text: bytes) -> bytes:
    """A compressed stream at the best level, which typst does not take; as it is where that does not help."""
    found = _COMPRESSED.fullmatch(text)
    if found is None or int(found["length"]) != len(found["data"]):
        return text
    data = zlib.compress(zlib.decompress(found["data"]), LEVEL)
    if len(data) >= len(found["data"]):
        return text
    head = text[: found.start("length")] + b"%d" % len(data) + text[found.end("length") : found.start("data")]
    return head + data + text[found.end("data") :]


def _object_stream(objects: list[tuple[int, bytes]]) -> tuple[bytes, bytes]:
    """The dictionary of a stream of objects, and what it holds: numbers and places, then the objects."""
    offsets = list(_offsets(objects))
    index = (
        b" ".join(b"%d %d" % (number, at) for (number, _text), at in zip(objects, offsets, strict=True))
        + b"\n"
    )
    body = b"\n".join(text for _number, text in objects)
    return b"/Type/ObjStm/N %d/First %d" % (len(objects), len(index)), index + body


def _offsets(objects: list[tuple[int, bytes]]) -> Iterator[int]:
    at = 0
    for _number, text in objects:
        yield at
        at += len(text) + 1


def _table(entries: Mapping[int, tuple[int, int, int]], size: int, trailer: bytes) -> tuple[bytes, bytes]:
    """The dictionary of the table of all objects, and its rows: kind, place or stream, number in the stream."""
    rows = b"".join(
        kind.to_bytes(1, "big") + one.to_bytes(4, "big") + other.to_bytes(2, "big")
        for kind, one, other in (entries.get(number, (0, 0, 65535)) for number in range(size))
    )
    rest = re.sub(rb"/Size\s+\d+", b"", trailer)
    return b"/Type/XRef/W[1 4 2]/Size %d%b" % (size, rest), rows


def _stream(number: int, dictionary: bytes, content: bytes) -> bytes:
    data = zlib.compress(content, LEVEL)
    return b"%d 0 obj\n<<%b/Filter/FlateDecode/Length %d>>\nstream\n%b\nendstream\nendobj\n" % (
        number,
        dictionary,
        len(data),
        data,
    )
