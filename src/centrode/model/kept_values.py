"""Values that are kept between requests of one description, found by the description itself: the newest ones only.

Descriptions are frozen, so the object says all: nothing is compared, and no digest is computed.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

from centrode.model.mechanism import Mechanism

Value = TypeVar("Value")


class KeptValues(Generic[Value]):
    """The values that were requested last, of descriptions and keys; `most` of them."""

    def __init__(self, most: int) -> None:
        self._most = most
        # the description is kept beside the value: so no other one can come to stand under its number
        self._values: OrderedDict[tuple[int, Hashable], tuple[Mechanism, Value]] = OrderedDict()
        self._one_at_a_time = threading.Lock()

    def get(self, mechanism: Mechanism, key: Hashable, make: Callable[[], Value]) -> Value:
        """The value of a description under a key, made where it is not there."""
        place = (id(mechanism), key)
        with self._one_at_a_time:
            if place in self._values:
                self._values.move_to_end(place)
                return self._values[place][1]
        # made without the lock: two threads may make the same value, which costs time and nothing else
        value = make()
        with self._one_at_a_time:
            self._values[place] = (mechanism, value)
            while len(self._values) > self._most:
                self._values.popitem(last=False)
        return value
