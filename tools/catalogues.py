"""The catalogues of centrode's sentences: `update` them from the code, `compile` them, `check` them.

The code's sentences are the literals in `_()`, `ngettext()`, `mark()`, `Sentence()` and `Counted()`, and the titles of
the built-in mechanisms. A .po file carries no dates and no version of any tool; a .mo file follows from its .po byte by
byte.
"""

from __future__ import annotations

import ast
import re
import struct
import sys
import tomllib
from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from string import Formatter

from babel.messages.catalog import Catalog, Message
from babel.messages.extract import extract_from_file
from babel.messages.pofile import read_po, write_po

ROOT = Path(__file__).parent.parent
CODE = ROOT / "src" / "centrode"
CLICK = ROOT / "tools" / "click_messages.py"
LEAST_REPEATED = 20
"""Letters from which a text that repeats itself is a slip and no name or sign."""
KEYWORDS = {"_": None, "mark": None, "Sentence": None, "ngettext": (1, 2), "Counted": (1, 2)}
SLAVIC = (
    "nplurals=3; plural=(n%10==1 && n%100!=11 ? 0 : n%10>=2 && n%10<=4 && (n%100<10 || n%100>=20) ? 1 : 2);"
)
PLURAL_FORMS = {"en": "nplurals=2; plural=(n != 1);", "ru": SLAVIC, "uk": SLAVIC}
TRANSLATED = ("ru", "uk")

Forms = tuple[str, ...]


def main(arguments: list[str]) -> int:
    match arguments:
        case ["update"]:
            return update()
        case ["compile"]:
            return compile_all()
        case ["check"]:
            return check()
    print("usage: catalogues.py update | compile | check", file=sys.stderr)
    return 2


def update() -> int:
    """Take the code's sentences into every catalogue: new ones untranslated, those the code dropped left out."""
    template = extracted()
    for language in PLURAL_FORMS:
        catalogue = read(language)
        catalogue.update(template, no_fuzzy_matching=True)
        catalogue.obsolete.clear()
        write(language, catalogue)
        if language in TRANSLATED:
            missing = sum(not complete(message) for message in sentences(catalogue))
            print(f"{language}: {len(catalogue)} sentences, {missing} to translate")
    return 0


def compile_all() -> int:
    for language in PLURAL_FORMS:
        mo_path(language).write_bytes(compiled(language, read(language)))
    return 0


def check() -> int:
    complaints = [*hidden_sentences(), *stale_sentences()]
    for language in PLURAL_FORMS:
        complaints.extend(f"{po_path(language)}: {complaint}" for complaint in faults(language))
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    if complaints:
        print("translate in the .po files, then: make catalogues", file=sys.stderr)
    return 1 if complaints else 0


def extracted() -> Catalog:
    """Every sentence of the code, with the files it stands in.

    Lines are left out: sentences are sorted by their places, and a line more in a module would move others.
    """
    catalogue = Catalog()
    for file in [*sorted(CODE.rglob("*.py")), CLICK]:
        place = file.relative_to(ROOT).as_posix()
        for _line, message, _comments, _context in extract_from_file("python", file, keywords=KEYWORDS):
            catalogue.add(message, locations=[(place, 0)])
    for file in sorted((CODE / "model" / "examples").rglob("*.toml")):
        title = tomllib.loads(file.read_text(encoding="utf-8")).get("title")
        if title:
            catalogue.add(title, locations=[(file.relative_to(ROOT).as_posix(), 0)])
    return catalogue


def po_path(language: str) -> Path:
    return CODE / "locale" / language / "LC_MESSAGES" / "centrode.po"


def mo_path(language: str) -> Path:
    return po_path(language).with_suffix(".mo")


def read(language: str) -> Catalog:
    path = po_path(language)
    text = path.read_text(encoding="utf-8") if path.exists() else header_entry(language)
    return read_po(text.splitlines(keepends=True), locale=language, abort_invalid=True)


def write(language: str, catalogue: Catalog) -> None:
    body = BytesIO()
    write_po(body, catalogue, width=110, omit_header=True, sort_by_file=True, include_lineno=False)
    path = po_path(language)
    path.parent.mkdir(parents=True, exist_ok=True)
    text = header_entry(language) + "\n" + body.getvalue().decode("utf-8").strip() + "\n"
    path.write_text(text, encoding="utf-8")


def header(language: str) -> str:
    return (
        "Project-Id-Version: centrode\n"
        f"Language: {language}\n"
        "MIME-Version: 1.0\n"
        "Content-Type: text/plain; charset=UTF-8\n"
        "Content-Transfer-Encoding: 8bit\n"
        f"Plural-Forms: {PLURAL_FORMS[language]}\n"
    )


def header_entry(language: str) -> str:
    lines = "".join(f'"{line}\\n"\n' for line in header(language).splitlines())
    return f'# Sentences of centrode, BSD-3-Clause.\nmsgid ""\nmsgstr ""\n{lines}'


def sentences(catalogue: Catalog) -> Iterator[Message]:
    """The messages without the header."""
    return (message for message in catalogue if message.id)


def forms(text: str | Iterable[str] | None) -> Forms:
    """The one text of a plain message, or the texts of one with plurals."""
    return (text,) if isinstance(text, str) else tuple(text or ("",))


def complete(message: Message) -> bool:
    return not message.fuzzy and all(forms(message.string))


def hidden_sentences() -> Iterator[str]:
    """Sentences within f-strings, which the extraction does not see before Python 3.12."""
    for file in sorted(CODE.rglob("*.py")):
        for text in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if not isinstance(text, ast.JoinedStr):
                continue
            calls = (node for node in ast.walk(text) if isinstance(node, ast.Call))
            for call in calls:
                named = isinstance(call.func, ast.Name) and call.func.id in KEYWORDS
                if named and any(isinstance(argument, ast.Constant) for argument in call.args):
                    yield f"{file}:{call.lineno}: a sentence inside an f-string is not found; take it out"


def stale_sentences() -> Iterator[str]:
    """What `update` would change: sentences of the code that a catalogue lacks, and the other way round."""
    code = {forms(message.id) for message in sentences(extracted())}
    for language in PLURAL_FORMS:
        known = {forms(message.id) for message in sentences(read(language))}
        for lacking in sorted(code - known):
            yield f"{po_path(language)}: lacks {lacking[0]!r}"
        for unused in sorted(known - code):
            yield f"{po_path(language)}: no longer in the code: {unused[0]!r}"


def faults(language: str) -> Iterator[str]:
    """What is wrong inside one catalogue."""
    catalogue = read(language)
    for message in sentences(catalogue):
        if language in TRANSLATED and not complete(message):
            yield f"{'fuzzy' if message.fuzzy else 'untranslated'}: {forms(message.id)[0]!r}"
        yield from wrong_fields(message)
        yield from repeated_translations(message)
    path = mo_path(language)
    if not path.exists() or path.read_bytes() != compiled(language, catalogue):
        yield "the .mo file is not compiled from it"


def wrong_fields(message: Message) -> Iterator[str]:
    """Fields of a translation that its sentence does not fill, and fields of the sentence that it drops."""
    originals = [fields(text) for text in forms(message.id)]
    allowed, needed = set.union(*originals), set.intersection(*originals)
    for text in filter(None, forms(message.string)):
        for field in sorted(fields(text) - allowed):
            yield f"field {{{field}}} is not in {forms(message.id)[0]!r}"
        for field in sorted(needed - fields(text)):
            yield f"field {{{field}}} is missing in the translation of {forms(message.id)[0]!r}"


def repeated_translations(message: Message) -> Iterator[str]:
    """Translations that hold the whole of themselves more than once, as a slip of the editor leaves them."""
    for text in filter(None, forms(message.string)):
        # a text of a period lies within its double before its end
        if len(text) >= LEAST_REPEATED and (text + text).find(text, 1) < len(text):
            yield f"the translation of {forms(message.id)[0]!r} repeats itself"


def fields(text: str) -> set[str]:
    """Names of the {fields}; none where the braces are not a format, as in a piece of TOML."""
    try:
        names = [name for _literal, name, _spec, _conversion in Formatter().parse(text)]
    except ValueError:
        return set()
    return {re.split(r"[.\[]", name)[0] for name in names if name}


def compiled(language: str, catalogue: Catalog) -> bytes:
    """The .mo file (GNU gettext manual, section 10.3, without the hash table): header and complete messages."""
    entries = {"": header(language)}
    for message in sentences(catalogue):
        if complete(message):
            entries["\0".join(forms(message.id))] = "\0".join(forms(message.string))
    pairs = sorted((key.encode(), value.encode()) for key, value in entries.items())
    start = 28 + 16 * len(pairs)
    tables: list[list[int]] = [[], []]
    texts = b""
    for column in (0, 1):
        for pair in pairs:
            tables[column] += [len(pair[column]), start + len(texts)]
            texts += pair[column] + b"\0"
    head = struct.pack("<7I", 0x950412DE, 0, len(pairs), 28, 28 + 8 * len(pairs), 0, 28 + 16 * len(pairs))
    return head + struct.pack(f"<{4 * len(pairs)}I", *tables[0], *tables[1]) + texts


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
