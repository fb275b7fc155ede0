"""What pages are made of: scripts and styles beside this file, and the rule that nothing else runs or is loaded."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent


def page_policy(scripts: Iterable[str]) -> str:
    """What the page may do: run its own scripts, nothing else, and load nothing."""
    sums = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    return f"default-src 'none'; script-src {sums}; style-src 'unsafe-inline'; font-src data:; img-src data:"


def page_script(parts: Iterable[str]) -> str:
    """One script of several texts, whose names nothing else on the page sees."""
    return "".join(['(() => {\n"use strict";\n', *parts, "})();"])


def page_data(data: Any) -> str:
    """Data as a script element holds it: JSON without a sign that ends the element."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


@cache
def page_part(name: str) -> str:
    """A file beside this one that pages hold: a script or a style."""
    return (HERE / name).read_text(encoding="utf-8")
