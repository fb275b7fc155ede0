"""Answers as bytes: a header in JSON, then numbers of four bytes that a browser takes as they are."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt


def frame_bytes(header: Mapping[str, Any], arrays: Mapping[str, npt.ArrayLike]) -> bytes:
    """A header with the shape and the place of each array, and the arrays behind it.

    The length of the header stands before it as four bytes, least first; blanks after it make its end a multiple of
    four. Offsets count numbers from the first one.
    """
    described: dict[str, Any] = {}
    parts: list[bytes] = []
    offset = 0
    for name, values in arrays.items():
        # what is beyond single precision is beyond any picture: it becomes infinite
        with np.errstate(over="ignore"):
            array = np.ascontiguousarray(values, dtype="<f4")
        described[name] = {"shape": list(array.shape), "offset": offset}
        parts.append(array.tobytes())
        offset += array.size
    written = json.dumps({**header, "arrays": described}, ensure_ascii=False, allow_nan=False).encode()
    written += b" " * (-len(written) % 4)
    return struct.pack("<I", len(written)) + written + b"".join(parts)


def read_frame(content: bytes) -> tuple[dict[str, Any], dict[str, npt.NDArray[np.float32]]]:
    """Header and arrays of a frame."""
    (length,) = struct.unpack_from("<I", content)
    header = json.loads(content[4 : 4 + length])
    numbers = np.frombuffer(content, dtype="<f4", offset=4 + length)
    arrays = {
        name: numbers[one["offset"] : one["offset"] + int(np.prod(one["shape"]))].reshape(one["shape"])
        for name, one in header["arrays"].items()
    }
    return header, arrays
