"""A report made by hand: every block, texts that would be code if they could."""

from __future__ import annotations

import numpy as np

from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    FormulaBlock,
    ItemsBlock,
    Moving,
    ParagraphBlock,
    Picture,
    Report,
    SectionBlocks,
    SystemBlock,
    TableBlock,
    shown,
)

HOSTILE = (
    '#panic(1) *b* _i_ `c` <tag> @ref // c /* d ~ $ x $ \\ \\u{41} "q" [x] #let y = 1; </script><script>alert(1)'
    "</script> &amp; <!-- ]]> = + - 1. {x} 'p' -- ... #"
)
SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="WIDTHpt" height="HEIGHTpt" viewBox="0 0 WIDTH HEIGHT">'
    b'<rect width="WIDTH" height="HEIGHT" fill="#0072B2"/></svg>'
)


def svg(width: float, height: float) -> bytes:
    return SVG.replace(b"WIDTH", b"%g" % width).replace(b"HEIGHT", b"%g" % height)


def long_sum(terms: int) -> str:
    return " + ".join(f"l_({k}) sin (phi_({k}) - phi_({k + 1})) cos phi_({k})" for k in range(1, terms + 1))


def moving() -> Moving:
    turn = np.linspace(0.0, 6.0, 7)
    places = {"O": np.zeros((7, 2)), "A": np.stack([np.cos(turn), np.sin(turn)], axis=1)}
    still = Picture(svg(400, 300), "", 5.0)
    texts = tuple(f"{value:.1f}" for value in turn)
    return Moving(places, {"OA": ("O", "A")}, ("O",), {}, {}, turn, texts, ("A",), still, "It moves")


def blocks(text: str = HOSTILE) -> tuple[Block, ...]:
    told = shown(text)
    matrix = tuple(tuple(f"l_({i}) cos (phi_({i}) - phi_({j}))" for j in range(9)) for i in range(9))
    return (
        ParagraphBlock(f"{told} $x^(2)$ {told}"),
        ItemsBlock((told, "$a + b$ " + told), numbered=True),
        ItemsBlock((told,)),
        FormulaBlock((("x_(1)", "1", "2"), (f'x_("{name(text)}")', long_sum(9)), (long_sum(8), "0"))),
        FormulaBlock((("epsilon", f"-frac(1, Delta) ({long_sum(12)})"),)),
        FormulaBlock((("y", " ".join(["frac(a b c d e f g h i j k l m n o, c)"] * 9)),)),
        SystemBlock((("a", "0"), ("0", "b + c")), ("x", "y"), ("1", "-d")),
        SystemBlock(matrix, tuple(f"omega_({i})" for i in range(9)), ("0",) * 9),
        TableBlock(("name", "$x$, m"), tuple((told, f"{k}.5") for k in range(3)), told, (False, True)),
        TableBlock(("", ""), ()),
        TableBlock(
            tuple(f"$x_({k})$, m" for k in range(30)), (("123.4567",) * 30,) * 40, "Wide", (True,) * 30
        ),
        TableBlock(("words", "more"), (("word " * 60, "x" * 30),), "Long"),
        Picture(svg(2000, 300), told, 27.0),
        Picture(svg(300, 2000), "", 4.0),
        Picture(svg(595.3, 419.5), "To scale", 8.268, to_scale=True),
        CheckBlock(told, holds=True),
        CheckBlock("$10^(-15)$ off", holds=False),
        moving(),
    )


def name(text: str) -> str:
    """A text inside of a string of mathematics."""
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\u{24}")


def report(text: str = HOSTILE, language: str = "en") -> Report:
    return Report(
        text,
        text,
        language,
        (
            ChapterBlocks(
                "one", text, (SectionBlocks("", blocks(text)), SectionBlocks(text, (ParagraphBlock("end"),)))
            ),
            ChapterBlocks("two", "Two", missing=text),
        ),
    )
