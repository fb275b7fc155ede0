"""Text with mathematics between dollar signs: what users wrote comes back as it was, whatever it holds."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from centrode.render.document.blocks import shown
from centrode.report.texts import TextPart, parts_of

TEXTS = st.text(st.sampled_from('$\\a "#<é\n'), max_size=12) | st.text(max_size=12)
FORMULAS = st.sampled_from(["x", "phi_(1) = 3", 'x_("a\\u{24}")', '"q\\"" + 1', "x\\ y"])


def test_parts_in_order() -> None:
    assert parts_of("so $a = b$ holds") == [
        TextPart("so "),
        TextPart("a = b", mathematics=True),
        TextPart(" holds"),
    ]
    assert parts_of(r"5 \$ and $x$") == [TextPart("5 $ and "), TextPart("x", mathematics=True)]
    assert parts_of("$a$$b$") == [TextPart("a", mathematics=True), TextPart("b", mathematics=True)]


def test_a_sign_without_partner_is_text() -> None:
    assert parts_of("costs 5 $") == [TextPart("costs 5 $")]
    assert parts_of("") == []


@given(TEXTS)
def test_what_is_shown_is_text(text: str) -> None:
    assert parts_of(shown(text)) == ([TextPart(text)] if text else [])


@given(st.lists(st.tuples(TEXTS, FORMULAS), max_size=4))
def test_texts_and_formulas_in_turn(pairs: list[tuple[str, str]]) -> None:
    marked = "".join(f"{shown(text)}${formula}$" for text, formula in pairs)
    wanted = [
        part for text, formula in pairs for part in (TextPart(text), TextPart(formula, mathematics=True))
    ]
    assert parts_of(marked) == [part for part in wanted if part.text]
