"""What surrounds the kernels of one mechanism, as a function in LLVM's language: one call judges and writes.

It is the same function for all mechanisms: a table of addresses and counts (`FrameSlot`) tells it what to work on. It
puts numbers where kernels look for them, calls these, finds the least and greatest of the nodes, the turns of links,
and whether all samples close; what it computes is what `frame_kernels` computes by NumPy.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

from centrode.kinematics.machine_code.variables import AWAY, MOST, TURN, WHOLE
from centrode.kinematics.samples import CLOSED
from centrode.numerics.machine_code.loops import ARGUMENTS, FUNCTION

CALL = 1 + len(ARGUMENTS)
"""Slots of a kernel: its address and its arguments."""


class FrameSlot(IntEnum):
    """Places in the table of a frame: numbers, or addresses of rows of numbers."""

    MESH = 0
    SPARSE = CALL
    SAMPLES = 2 * CALL
    VALUES = 3 * CALL
    FOR_MESH = VALUES + 1
    FOR_SPARSE = VALUES + 3
    FOR_SAMPLES = VALUES + 5
    LEAST = VALUES + 7
    ROWS = VALUES + 8
    REDUCED = VALUES + 9
    CONDITIONS = VALUES + 10
    LINKS = VALUES + 12
    START = VALUES + 13
    AT_START = VALUES + 14
    WOUND = VALUES + 15
    CENTRES = VALUES + 16
    RESIDUAL = VALUES + 17
    SLACK = VALUES + 18
    TURNED = VALUES + 19
    ANGLES = VALUES + 20
    WOUND_AT_SAMPLES = VALUES + 21
    ANGLE_ROWS = VALUES + 22
    COUNT = VALUES + 23


class FrameAnswer(IntEnum):
    """What the function gives back."""

    NOT_CLEAR = 0
    CLEAR = 1
    WINDINGS = 2
    """Links may wind otherwise than the last time."""


class Task(IntEnum):
    """What the function is asked to do."""

    MOVE = 0
    TURN = 1
    JUDGE = 2
    CALL = 3
    """Of a table that has one kernel alone."""


def frame_text(width: int) -> str:
    """The function for vectors of so many numbers: (table, task) -> answer."""
    return "\n".join(
        [
            "declare double @llvm.fabs.f64(double)",
            _extreme("least", "olt", math.inf, width),
            _extreme("greatest", "ogt", -math.inf, width),
            _gather(),
            _call(),
            _centre(),
            _turn(width),
            _reduce_mesh(),
            _conditions(),
            _wind(),
            _write(),
            _move(),
            _entry(),
        ]
    )


def _number(x: float) -> str:
    return f"0x{struct.unpack('<Q', struct.pack('<d', x))[0]:016X}"


def _vector(x: float, width: int) -> str:
    return "<" + ", ".join([f"double {_number(x)}"] * width) + ">"


def _extreme(name: str, predicate: str, start: float, width: int) -> str:
    """The least or greatest of a row; NaN where one is."""
    vector = f"<{width} x double>"
    loop = _Loop("i", "count", step=width)
    lines = [
        f"define internal double @{name}(ptr %row, i64 %count) {{",
        "entry:",
        f"  %last = sub i64 %count, {width}",
        "  br label %loop",
        loop.head,
        f"  %best = phi {vector} [ {_vector(start, width)}, %entry ], [ %better, %loop ]",
        f"  %bad = phi {vector} [ zeroinitializer, %entry ], [ %worse, %loop ]",
        # the last vector ends with the row
        "  %beyond = icmp sgt i64 %i, %last",
        "  %at = select i1 %beyond, i64 %last, i64 %i",
        "  %place = getelementptr double, ptr %row, i64 %at",
        f"  %x = load {vector}, ptr %place, align 8",
        f"  %is = fcmp {predicate} {vector} %x, %best",
        f"  %better = select <{width} x i1> %is, {vector} %x, {vector} %best",
        f"  %none = fcmp uno {vector} %x, %x",
        f"  %worse = select <{width} x i1> %none, {vector} %x, {vector} %bad",
        loop.end,
        "done:",
        f"  %r0 = extractelement {vector} %better, i32 0",
        f"  %n0 = extractelement {vector} %worse, i32 0",
    ]
    for k in range(1, width):
        lines += [
            f"  %x{k} = extractelement {vector} %better, i32 {k}",
            f"  %c{k} = fcmp {predicate} double %x{k}, %r{k - 1}",
            f"  %r{k} = select i1 %c{k}, double %x{k}, double %r{k - 1}",
            f"  %y{k} = extractelement {vector} %worse, i32 {k}",
            f"  %n{k} = fadd double %n{k - 1}, %y{k}",
        ]
    # what is bad is zero or NaN
    lines += [f"  %r = fadd double %r{width - 1}, %n{width - 1}", "  ret double %r", "}"]
    return "\n".join(lines)


@dataclass(frozen=True)
class _Loop:
    """A loop whose counter grows from zero by a step while it is below a count; at least one round is taken.

    Attributes
    ----------
    counter : its name
    count : name of the count
    first, last : its first block, and that from which it goes on
    behind, before : the blocks behind it and before it
    step : of the counter
    """

    counter: str
    count: str
    first: str = "loop"
    last: str = "loop"
    behind: str = "done"
    before: str = "entry"
    step: int = 1

    @property
    def head(self) -> str:
        """What the first block begins with."""
        came = f"[ 0, %{self.before} ], [ %{self.counter}.next, %{self.last} ]"
        return f"{self.first}:\n  %{self.counter} = phi i64 {came}"

    @property
    def end(self) -> str:
        """What the last block ends with."""
        counter = self.counter
        return (
            f"  %{counter}.next = add i64 %{counter}, {self.step}\n"
            f"  %{counter}.more = icmp slt i64 %{counter}.next, %{self.count}\n"
            f"  br i1 %{counter}.more, label %{self.first}, label %{self.behind}"
        )


def _slot(name: str, slot: int, kind: str = "i64") -> str:
    return (
        f"  %{name}.slot = getelementptr i64, ptr %table, i64 {slot}\n"
        f"  %{name} = load {kind}, ptr %{name}.slot, align 8"
    )


def _gather() -> str:
    """Put numbers where a kernel looks for its inputs: two slots say which they are and how many."""
    loop = _Loop("i", "count")
    return f"""
define internal void @gather(ptr %table, i64 %slot, i64 %kernel) {{
entry:
  %from.at = getelementptr i64, ptr %table, i64 %slot
  %from = load ptr, ptr %from.at, align 8
  %many = add i64 %slot, 1
  %count.at = getelementptr i64, ptr %table, i64 %many
  %count = load i64, ptr %count.at, align 8
  %inputs.slot = add i64 %kernel, 5
  %inputs.at = getelementptr i64, ptr %table, i64 %inputs.slot
  %inputs = load ptr, ptr %inputs.at, align 8
{_slot("values", FrameSlot.VALUES, "ptr")}
  %some = icmp sgt i64 %count, 0
  br i1 %some, label %loop, label %done
{loop.head}
  %which.at = getelementptr i64, ptr %from, i64 %i
  %which = load i64, ptr %which.at, align 8
  %value.at = getelementptr double, ptr %values, i64 %which
  %value = load double, ptr %value.at, align 8
  %to = getelementptr double, ptr %inputs, i64 %i
  store double %value, ptr %to, align 8
{loop.end}
done:
  ret void
}}"""


def _call() -> str:
    """Call a kernel with the arguments that stand behind its address."""
    kinds = [argument.split()[0] for argument in ARGUMENTS]
    lines = ["define internal void @call(ptr %table, i64 %slot) {", "entry:"]
    lines += ["  %kernel.at = getelementptr i64, ptr %table, i64 %slot"]
    lines += ["  %kernel = load ptr, ptr %kernel.at, align 8"]
    for k, kind in enumerate(kinds):
        lines += [
            f"  %p{k} = getelementptr i64, ptr %kernel.at, i64 {k + 1}",
            f"  %a{k} = load {kind}, ptr %p{k}, align 8",
        ]
    arguments = ", ".join(f"{kind} %a{k}" for k, kind in enumerate(kinds))
    return "\n".join([*lines, f"  call void %kernel({arguments})", "  ret void", "}"])


def _nearest_whole(name: str, value: str) -> str:
    """The nearest whole number, as `whole_turns` rounds it."""
    return (
        f"  %{name}.up = fadd double {value}, {_number(WHOLE)}\n"
        f"  %{name} = fsub double %{name}.up, {_number(WHOLE)}"
    )


def _centre() -> str:
    """Centre of a link's angle; NaN where it does not stay near enough to one, or winds otherwise."""
    loop = _Loop("i", "count", behind="judge")
    return f"""
define internal double @centre(ptr %raw, ptr %wound, i64 %count, i64 %start, double %initial) {{
entry:
  %before = load double, ptr %raw, align 8
  br label %loop
{loop.head}
  %last = phi double [ %before, %entry ], [ %angle, %loop ]
  %turns = phi double [ 0.0, %entry ], [ %turned, %loop ]
  %most = phi double [ 0.0, %entry ], [ %wider, %loop ]
  %high = phi double [ {_number(-math.inf)}, %entry ], [ %higher, %loop ]
  %low = phi double [ {_number(math.inf)}, %entry ], [ %lower, %loop ]
  %sum = phi double [ 0.0, %entry ], [ %summed, %loop ]
  %at.start = phi double [ 0.0, %entry ], [ %there, %loop ]
  %angle.at = getelementptr double, ptr %raw, i64 %i
  %angle = load double, ptr %angle.at, align 8
  %way = fsub double %angle, %last
  %share = fmul double %way, {_number(-1.0 / TURN)}
{_nearest_whole("step", "%share")}
  %turned = fadd double %turns, %step
  %back = fmul double %step, {_number(TURN)}
  %jump = fadd double %way, %back
  %size = call double @llvm.fabs.f64(double %jump)
  %is.wider = fcmp ogt double %size, %most
  %wider = select i1 %is.wider, double %size, double %most
  %off = fmul double %turned, {_number(TURN)}
  %whole = fadd double %angle, %off
  %is.start = icmp eq i64 %i, %start
  %there = select i1 %is.start, double %whole, double %at.start
  %wound.at = getelementptr double, ptr %wound, i64 %i
  %winds = load double, ptr %wound.at, align 8
  %rest = fsub double %whole, %winds
  %is.higher = fcmp ogt double %rest, %high
  %higher = select i1 %is.higher, double %rest, double %high
  %is.lower = fcmp olt double %rest, %low
  %lower = select i1 %is.lower, double %rest, double %low
  %summed = fadd double %sum, %rest
{loop.end}
judge:
  %from = fsub double %initial, %there
  %from.share = fmul double %from, {_number(1.0 / TURN)}
{_nearest_whole("turn", "%from.share")}
  %from.back = fmul double %turn, {_number(TURN)}
  %left = fsub double %from, %from.back
  %left.size = call double @llvm.fabs.f64(double %left)
  %width = fsub double %higher, %lower
  %half = fmul double %width, 0.5
  %reach = fadd double %half, %wider
  %small = fcmp olt double %wider, {_number(MOST)}
  %near = fcmp olt double %left.size, {_number(math.pi - AWAY)}
  %held = fcmp olt double %reach, {_number(math.pi - AWAY)}
  ; NaN anywhere is in the sum
  %known = fcmp ord double %summed, %summed
  %one = and i1 %small, %near
  %two = and i1 %held, %known
  %good = and i1 %one, %two
  %both = fadd double %higher, %lower
  %middle = fmul double %both, 0.5
  %centre = fadd double %middle, %from.back
  %found = select i1 %good, double %centre, double {_number(math.nan)}
  ret double %found
}}"""


def _turn(width: int) -> str:
    """Add the whole turns to the angles of the samples, and put these where they belong."""
    vector = f"<{width} x double>"
    whole = _vector(WHOLE, width)
    links = _Loop("k", "many", "link", "link.end")
    samples = _Loop("i", "count", behind="link.end", before="link", step=width)
    return f"""
define internal void @turn(ptr %table) {{
entry:
{_slot("count", FrameSlot.SAMPLES + 1)}
{_slot("many", FrameSlot.TURNED)}
{_slot("angles", FrameSlot.ANGLES, "ptr")}
{_slot("wound", FrameSlot.WOUND_AT_SAMPLES, "ptr")}
{_slot("rows", FrameSlot.ANGLE_ROWS, "ptr")}
{_slot("centres", FrameSlot.CENTRES, "ptr")}
  %last = sub i64 %count, {width}
  %some = icmp sgt i64 %many, 0
  br i1 %some, label %link, label %done
{links.head}
  %first = mul i64 %k, %count
  %angle.row = getelementptr double, ptr %angles, i64 %first
  %wound.row = getelementptr double, ptr %wound, i64 %first
  %to.at = getelementptr ptr, ptr %rows, i64 %k
  %to.row = load ptr, ptr %to.at, align 8
  %centre.at = getelementptr double, ptr %centres, i64 %k
  %centre.one = load double, ptr %centre.at, align 8
  %centre.in = insertelement {vector} poison, double %centre.one, i32 0
  %centre = shufflevector {vector} %centre.in, {vector} poison, <{width} x i32> zeroinitializer
  br label %loop
{samples.head}
  %beyond = icmp sgt i64 %i, %last
  %at = select i1 %beyond, i64 %last, i64 %i
  %angle.at = getelementptr double, ptr %angle.row, i64 %at
  %angle = load {vector}, ptr %angle.at, align 8
  %wound.at = getelementptr double, ptr %wound.row, i64 %at
  %winds = load {vector}, ptr %wound.at, align 8
  %middle = fadd {vector} %centre, %winds
  %off = fsub {vector} %middle, %angle
  %share = fmul {vector} %off, {_vector(1.0 / TURN, width)}
  %up = fadd {vector} %share, {whole}
  %turns = fsub {vector} %up, {whole}
  %more.turns = fmul {vector} %turns, {_vector(TURN, width)}
  %turned = fadd {vector} %angle, %more.turns
  %to = getelementptr double, ptr %to.row, i64 %at
  store {vector} %turned, ptr %to, align 8
{samples.end}
link.end:
{links.end}
done:
  ret void
}}"""


def _reduce_mesh() -> str:
    """Compute the nodes of the mesh, and the least of the first rows and the greatest of the others."""
    rows = _Loop("r", "rows", "row", "row.end")
    return f"""
define internal void @reduce_mesh(ptr %table, i64 %rows) {{
entry:
  call void @gather(ptr %table, i64 {FrameSlot.FOR_MESH}, i64 {FrameSlot.MESH})
  call void @call(ptr %table, i64 {FrameSlot.MESH})
{_slot("nodes", FrameSlot.MESH + 1)}
{_slot("room", FrameSlot.MESH + 11, "ptr")}
{_slot("stride", FrameSlot.MESH + 12)}
{_slot("least", FrameSlot.LEAST)}
{_slot("reduced", FrameSlot.REDUCED, "ptr")}
  br label %row
{rows.head}
  %offset = mul i64 %r, %stride
  %row.at = getelementptr double, ptr %room, i64 %offset
  %is.least = icmp slt i64 %r, %least
  br i1 %is.least, label %low, label %high
low:
  %lowest = call double @least(ptr %row.at, i64 %nodes)
  br label %row.end
high:
  %highest = call double @greatest(ptr %row.at, i64 %nodes)
  br label %row.end
row.end:
  %extreme = phi double [ %lowest, %low ], [ %highest, %high ]
  %to = getelementptr double, ptr %reduced, i64 %r
  store double %extreme, ptr %to, align 8
{rows.end}
done:
  ret void
}}"""


def _conditions() -> str:
    """Whether every number of the nodes that has to keep a sign keeps it, by its least and greatest values."""
    pairs = _Loop("c", "count", "condition", "condition.met", behind="hold")
    return f"""
define internal i1 @conditions_hold(ptr %table) {{
entry:
{_slot("reduced", FrameSlot.REDUCED, "ptr")}
{_slot("pairs", FrameSlot.CONDITIONS, "ptr")}
{_slot("count", FrameSlot.CONDITIONS + 1)}
  %some = icmp sgt i64 %count, 0
  br i1 %some, label %condition, label %hold
{pairs.head}
  %c.first = mul i64 %c, 2
  %c.second = add i64 %c.first, 1
  %first.at = getelementptr i64, ptr %pairs, i64 %c.first
  %first = load i64, ptr %first.at, align 8
  %second.at = getelementptr i64, ptr %pairs, i64 %c.second
  %second = load i64, ptr %second.at, align 8
  %a.at = getelementptr double, ptr %reduced, i64 %first
  %a = load double, ptr %a.at, align 8
  %above = fcmp ogt double %a, 0.0
  br i1 %above, label %condition.met, label %otherwise
otherwise:
  ; a number that may be negative throughout: the place of its greatest, else none
  %may = icmp sge i64 %second, 0
  br i1 %may, label %negative, label %broken
negative:
  %b.at = getelementptr double, ptr %reduced, i64 %second
  %b = load double, ptr %b.at, align 8
  %below = fcmp olt double %b, 0.0
  br i1 %below, label %condition.met, label %broken
condition.met:
{pairs.end}
hold:
  ret i1 true
broken:
  ret i1 false
}}"""


def _wind() -> str:
    """Compute the nodes that tell turns, and the centre of every link's angle; whether all are known."""
    links = _Loop("l", "links", "link", "link.met", behind="known")
    return f"""
define internal i1 @wind_links(ptr %table, i64 %links) {{
entry:
  call void @gather(ptr %table, i64 {FrameSlot.FOR_SPARSE}, i64 {FrameSlot.SPARSE})
  call void @call(ptr %table, i64 {FrameSlot.SPARSE})
{_slot("count", FrameSlot.SPARSE + 1)}
{_slot("room", FrameSlot.SPARSE + 11, "ptr")}
{_slot("stride", FrameSlot.SPARSE + 12)}
{_slot("start", FrameSlot.START)}
{_slot("initial", FrameSlot.AT_START, "ptr")}
{_slot("wound", FrameSlot.WOUND, "ptr")}
{_slot("centres", FrameSlot.CENTRES, "ptr")}
  br label %link
{links.head}
  %raw.offset = mul i64 %l, %stride
  %raw = getelementptr double, ptr %room, i64 %raw.offset
  %wound.offset = mul i64 %l, %count
  %wound.row = getelementptr double, ptr %wound, i64 %wound.offset
  %angle.at = getelementptr double, ptr %initial, i64 %l
  %angle = load double, ptr %angle.at, align 8
  %found = call double @centre(ptr %raw, ptr %wound.row, i64 %count, i64 %start, double %angle)
  %centre.to = getelementptr double, ptr %centres, i64 %l
  store double %found, ptr %centre.to, align 8
  %is.known = fcmp ord double %found, %found
  br i1 %is.known, label %link.met, label %otherwise
link.met:
{links.end}
known:
  ret i1 true
otherwise:
  ret i1 false
}}"""


def _write() -> str:
    """Write the samples; whether all of them close, with radicands above zero where these are looked at."""
    return f"""
define internal i1 @write_samples(ptr %table) {{
entry:
  call void @gather(ptr %table, i64 {FrameSlot.FOR_SAMPLES}, i64 {FrameSlot.SAMPLES})
  call void @call(ptr %table, i64 {FrameSlot.SAMPLES})
{_slot("count", FrameSlot.SAMPLES + 1)}
{_slot("residual", FrameSlot.RESIDUAL, "ptr")}
  %worst = call double @greatest(ptr %residual, i64 %count)
  %closes = fcmp ole double %worst, {_number(0.5 * CLOSED)}
  br i1 %closes, label %closed, label %open
closed:
{_slot("slack", FrameSlot.SLACK, "ptr")}
  %no.slack = icmp eq ptr %slack, null
  br i1 %no.slack, label %clear, label %judge.slack
judge.slack:
  %least.slack = call double @least(ptr %slack, i64 %count)
  %enough = fcmp ogt double %least.slack, 0.0
  ret i1 %enough
clear:
  ret i1 true
open:
  ret i1 false
}}"""


def _move() -> str:
    """Judge by the nodes, wind the links, write the samples, as far as the table has each: see `FrameAnswer`."""
    return f"""
define internal i64 @move(ptr %table, i64 %task) {{
entry:
{_slot("rows", FrameSlot.ROWS)}
  %judges = icmp sgt i64 %rows, 0
  br i1 %judges, label %judge, label %turning
judge:
  call void @reduce_mesh(ptr %table, i64 %rows)
  %hold = call i1 @conditions_hold(ptr %table)
  br i1 %hold, label %turning, label %not.clear
turning:
{_slot("links", FrameSlot.LINKS)}
  %turns = icmp sgt i64 %links, 0
  br i1 %turns, label %wind, label %judged
wind:
  %wound = call i1 @wind_links(ptr %table, i64 %links)
  br i1 %wound, label %judged, label %windings
judged:
  %only = icmp eq i64 %task, {Task.JUDGE}
  br i1 %only, label %clear, label %samples
samples:
  %closed = call i1 @write_samples(ptr %table)
  br i1 %closed, label %clear, label %not.clear
clear:
  ret i64 {FrameAnswer.CLEAR}
windings:
  ret i64 {FrameAnswer.WINDINGS}
not.clear:
  ret i64 {FrameAnswer.NOT_CLEAR}
}}"""


def _entry() -> str:
    return f"""
define i64 @{FUNCTION}(ptr %table, i64 %task) {{
entry:
  switch i64 %task, label %move [ i64 {Task.TURN}, label %turn i64 {Task.CALL}, label %call ]
move:
  %answer = call i64 @move(ptr %table, i64 %task)
  ret i64 %answer
turn:
  call void @turn(ptr %table)
  ret i64 {FrameAnswer.CLEAR}
call:
  call void @call(ptr %table, i64 0)
  ret i64 {FrameAnswer.CLEAR}
}}
"""
