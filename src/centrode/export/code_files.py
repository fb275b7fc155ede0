"""The source files of a mechanism's motion: what stands around its formulas and rules in each language."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence

from centrode.export import motion_rules
from centrode.export.motion_program import MotionProgram
from centrode.numerics.rule_translation import called_first, translate_rules
from centrode.numerics.source_languages import LANGUAGES, Language
from centrode.version import __version__

STATUSES = ("ok", "open", "cut off", "singular", "outside")
"""Statuses of a place in the order of their numbers; outside: beyond the range that was printed."""
SCALARS = ("place", "half", "rate", "second", "time", "reach_low", "reach_high")
WHOLE = ("events", "cells", "possible")
"""Numbers of the record that are written: real ones, and whole ones."""


def source_text(program: MotionProgram, language: Language) -> str:
    """The whole file. Raises Unwritten."""
    formulas = [line for function in program.functions for line in function.lines(language)]
    rules = translate_rules(motion_rules, language, program.numbers)
    heads = called_first(motion_rules) if language.declares else []
    comments = [f"{language.comment} {line}".rstrip() for line in _head(program, language)]
    lines = _WRITERS[language.suffix](program, language, [*formulas, *rules], heads)
    return "\n".join([*comments, "", *lines]).rstrip() + "\n"


def _head(program: MotionProgram, language: Language) -> list[str]:
    low, high = program.numbers["low"], program.numbers["high"]
    unit, name = program.drive_unit, program.name
    what = "time" if program.by_time else "drive"
    lines = [
        f"{_plain(program.mechanism.title or name)}: its motion as functions of the {what} and of dimensions.",
        f"Printed by centrode {__version__}; {language.name} without dependencies.",
        "",
        *_USE[language.suffix](name),
        "",
        f"The {what} is in {unit}, from {low:.6g} to {high:.6g}; beyond, the status is outside and nothing is known.",
    ]
    if not program.by_time:
        lines.append("Speed and acceleration of the drive turn derivatives by it into those by time.")
    lines += [
        "Statuses: " + ", ".join(f"{k} {word}" for k, word in enumerate(STATUSES)) + ".",
        "",
        "Dimensions:",
    ]
    lines += [
        f"  {k + language.first}: {_plain(path)} = {value!r}"
        for k, (path, value) in enumerate(zip(program.paths, program.values, strict=True))
    ]
    lines += ["Results:"]
    return lines + [
        f"  {k + language.first}: {_plain(result.name)} [{result.unit}]"
        for k, result in enumerate(program.results)
    ]


_USE: Mapping[str, Callable[[str], list[str]]] = {
    ".c": lambda name: [
        f"    {name} m;",
        f"    {name}_prepare(&m, {name}_dimensions);",
        f"    int status = {name}_at(&m, drive, speed, acceleration);",
        f"    /* m.row[k] is {name}_results[k] */",
        f"    cc -O2 -c {name}.c",
    ],
    ".py": lambda name: [
        f"    import {name}",
        f"    m = {name}.prepare()",
        f"    status = {name}.at(m, drive, speed, acceleration)  # m.row[k] is RESULTS[k]",
        f"    python {name}.py > table.csv",
    ],
    ".m": lambda name: [
        f"    [status, result, names, dimensions] = {name}(drives, dimensions, speed, acceleration)",
        "    result has a row for every drive and a column for every name",
    ],
    ".js": lambda name: [
        f'    const {name} = require("./{name}.js");',
        f"    const m = {name}.prepare({name}.values);",
        f"    const status = {name}.at(m, drive, speed, acceleration);  // m.row[k] is {name}.results[k]",
    ],
}


def _plain(text: str) -> str:
    """Text for a comment of one line: nothing in it ends the line or the comment."""
    kept = "".join(c if c.isprintable() and c != "\\" else " " for c in text)
    return kept.replace("*/", "* /").replace("??", "? ?").replace("<", "‹")


def _quotation(text: str) -> str:
    """Text between double quotes, as C and JavaScript read it."""
    plain = "".join(c if c.isprintable() else " " for c in text)
    return json.dumps(plain, ensure_ascii=False).replace("?", "\\?").replace("<", "\\x3c")


def _defaults(program: MotionProgram, language: Language) -> list[str]:
    """Lines that fill the tables of a record."""
    return [
        f"{language.element_text(name, str(k))} = {language.notation.number(value)[0]}{language.line_end}"
        for name, values in program.tables.items()
        for k, value in enumerate(values)
    ]


def _arrays(program: MotionProgram) -> dict[str, int]:
    return {name: max(1, size) for name, size in program.sizes.items()} | {
        name: max(1, len(values)) for name, values in program.tables.items()
    }


def _c(program: MotionProgram, language: Language, body: Sequence[str], heads: Sequence[str]) -> list[str]:
    name, dimensions = program.name, len(program.paths)
    number = language.notation.number
    values = ", ".join(number(x)[0] for x in program.values) or "0.0"
    results = ",\n    ".join(_quotation(result.name) for result in program.results)
    paths = ", ".join(_quotation(path) for path in program.paths) or '""'
    record = [f"double {array}[{size}];" for array, size in _arrays(program).items()]
    record += [f"double {scalar};" for scalar in SCALARS] + [f"int {scalar};" for scalar in WHOLE]
    fill = _defaults(program, language)
    given = [f"for (int k = 0; k < {dimensions}; k++) m->given[k] = dimensions[k];"] if dimensions else []
    public = [] if dimensions else ["(void)dimensions;"]
    return [
        "#include <math.h>",
        "",
        "typedef struct {",
        *language.indented_lines(record),
        f"}} {name};",
        f"typedef {name} record;",
        "",
        f"enum {{ {name}_result_count = {len(program.results)}, {name}_dimension_count = {dimensions} }};",
        f"const double {name}_dimensions[] = {{{values}}};",
        f"const char *const {name}_dimension_names[] = {{{paths}}};",
        f"const char *const {name}_results[] = {{\n    {results}\n}};",
        f"const char *const {name}_statuses[] = {{{', '.join(_quotation(word) for word in STATUSES)}}};",
        "",
        *language.helpers.splitlines(),
        "",
        *heads,
        "",
        *body,
        f"void {name}_prepare({name} *m, const double *dimensions) {{",
        *language.indented_lines([*fill, *given, *public, "find_events(m);"]),
        "}",
        "",
        f"int {name}_at({name} *m, double drive, double speed, double acceleration) {{",
        *language.indented_lines(["return motion_at(m, drive, speed, acceleration);"]),
        "}",
    ]


def _python(
    program: MotionProgram, language: Language, body: Sequence[str], _heads: Sequence[str]
) -> list[str]:
    low, high = program.numbers["low"], program.numbers["high"]
    arrays = [f"m.{array} = [0.0] * {size}" for array, size in _arrays(program).items()]
    return [
        "import math",
        "",
        f"DIMENSIONS = {program.values!r}",
        f"DIMENSION_NAMES = {list(program.paths)!r}",
        f"RESULTS = {[result.name for result in program.results]!r}",
        f"STATUSES = {STATUSES!r}",
        f"SPEED = {program.speed!r}",
        "",
        "",
        *language.helpers.splitlines(),
        "",
        "",
        "class Record:",
        '    """Numbers of a mechanism; `row` has the results."""',
        "",
        "",
        *body,
        "def prepare(dimensions=DIMENSIONS):",
        '    """A record whose dimensions are given: its limits and change points are looked for."""',
        "    m = Record()",
        *language.indented_lines([*arrays, *_defaults(program, language)]),
        "    m.given[: len(DIMENSIONS)] = [float(x) for x in dimensions]",
        "    find_events(m)",
        "    return m",
        "",
        "",
        "def at(m, drive, speed=SPEED, acceleration=0.0):",
        '    """Status of a place of the drive; `m.row` then has the results."""',
        "    return motion_at(m, float(drive), float(speed), float(acceleration))",
        "",
        "",
        'if __name__ == "__main__":',
        "    m = prepare()",
        '    print("drive", "status", *RESULTS, sep=";")',
        "    for k in range(361):",
        f"        drive = {low!r} + {high - low!r} * k / 360",
        "        status = STATUSES[at(m, drive)]",
        '        print(drive, status, *m.row[: len(RESULTS)], sep=";")',
    ]


def _matlab(
    program: MotionProgram, language: Language, body: Sequence[str], _heads: Sequence[str]
) -> list[str]:
    name, number = program.name, language.notation.number

    def strings(texts: Sequence[str]) -> str:
        inside = ("".join(c if c.isprintable() else " " for c in text).replace("'", "''") for text in texts)
        return "{" + ", ".join(f"'{text}'" for text in inside) + "}"

    values = " ".join(number(x)[0] for x in program.values)
    arrays = [f"m.{array} = zeros(1, {size});" for array, size in _arrays(program).items()]
    arrays += [f"m.{scalar} = 0;" for scalar in (*SCALARS, *WHOLE)]
    count = len(program.results)
    main = [
        f"names = {strings([result.name for result in program.results])};",
        "if nargin < 2 || isempty(dimensions)",
        f"    dimensions = [{values}];",
        "end",
        "if nargin < 3",
        f"    speed = {number(program.speed)[0]};",
        "end",
        "if nargin < 4",
        "    acceleration = 0;",
        "end",
        *arrays,
        *_defaults(program, language),
        *([f"m.given(1:{len(program.paths)}) = dimensions;"] if program.paths else []),
        "m = find_events(m);",
        "status = zeros(numel(drives), 1);",
        f"result = zeros(numel(drives), {count});",
        "for k = 1:numel(drives)",
        "    [m, status(k)] = motion_at(m, drives(k), speed, acceleration);",
        f"    result(k, :) = m.row(1:{count});",
        "end",
    ]
    head = f"function [status, result, names, dimensions] = {name}(drives, dimensions, speed, acceleration)"
    return [head, *language.indented_lines(main), "end", "", *body, *language.helpers.splitlines()]


def _javascript(
    program: MotionProgram, language: Language, body: Sequence[str], _heads: Sequence[str]
) -> list[str]:
    name, number = program.name, language.notation.number
    arrays = [f"m.{array} = new Float64Array({size});" for array, size in _arrays(program).items()]
    inside = [
        *language.helpers.splitlines(),
        "",
        *body,
        "function prepare(dimensions) {",
        "    const m = {};",
        *language.indented_lines([*arrays, *_defaults(program, language)]),
        "    m.given.set(dimensions);" if program.paths else "",
        "    find_events(m);",
        "    return m;",
        "}",
        "",
        "return {",
        f"    names: [{', '.join(_quotation(path) for path in program.paths)}],",
        f"    values: [{', '.join(number(x)[0] for x in program.values)}],",
        f"    results: [{', '.join(_quotation(result.name) for result in program.results)}],",
        f"    statuses: [{', '.join(_quotation(word) for word in STATUSES)}],",
        "    prepare,",
        f"    at: (m, drive, speed = {number(program.speed)[0]}, acceleration = 0.0) =>",
        "        motion_at(m, drive, speed, acceleration),",
        "};",
    ]
    return [
        f"const {name} = (() => {{",
        '"use strict";',
        *inside,
        "})();",
        f'if (typeof module !== "undefined") module.exports = {name};',
    ]


_WRITERS: Mapping[str, Callable[[MotionProgram, Language, Sequence[str], Sequence[str]], list[str]]] = {
    LANGUAGES["c"].suffix: _c,
    LANGUAGES["python"].suffix: _python,
    LANGUAGES["matlab"].suffix: _matlab,
    LANGUAGES["javascript"].suffix: _javascript,
}
