"""A kernel whose lanes stay while steps pass by in parts: a call costs little besides its work."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.algebra.machine_code.kernels import Kernel, address
from centrode.algebra.scans import Array


class Stream:
    """A kernel with the lanes inside and their numbers, called with one part of the steps after the other.

    Parameters
    ----------
    kernel : one without a state
    parameters : (parameters, lanes), which stay as they are
    threads : share the steps of a part
    """

    def __init__(self, kernel: Kernel, parameters: npt.ArrayLike, threads: int = 1) -> None:
        self.kernel, self.threads = kernel, threads
        self.parameters = np.ascontiguousarray(parameters, kernel.number)
        if self.parameters.ndim != 2 or len(self.parameters) != len(kernel.scan.parameters):
            raise ValueError(
                f"expected ({len(kernel.scan.parameters)}, lanes) values, got {self.parameters.shape}"
            )
        self.lanes = self.parameters.shape[1]
        self._alone = threads == 1 and self.lanes >= kernel.shape.vector.width
        self._below = kernel.tables.of_lanes.below(self.parameters)
        self._of_lanes = (address(self._below), self._below.strides[0] // kernel.number.itemsize)

    def __call__(self, inputs: npt.ArrayLike | None, out: Array) -> Array:
        """Take some steps.

        Parameters
        ----------
        inputs : (inputs, steps), numbers of a row side by side; none if the scan has none
        out : (outputs, steps, lanes), is written to; its last axis has to be contiguous
        """
        kernel = self.kernel
        if not self._alone or inputs is None:
            return kernel.run(
                self.parameters, inputs, out=out, steps=out.shape[1], threads=self.threads
            ).outputs
        rows, size = np.asarray(inputs, kernel.number), kernel.number.itemsize
        self._check(rows, out)
        rows = kernel.tables.of_steps.below(rows)
        if rows.shape[1]:
            kernel.function.call(
                self.lanes, rows.shape[1], *self._of_lanes, address(rows), rows.strides[0] // size, 0, 0, 0, 0,
                address(out), out.strides[0] // size, out.strides[1] // size,
            )  # fmt: skip
        return out

    def _check(self, rows: npt.NDArray[Any], out: Array) -> None:
        """Machine code writes where it is told to: nothing else looks at sizes."""
        scan, number = self.kernel.scan, self.kernel.number
        if rows.ndim != 2 or len(rows) != len(scan.inputs) or rows.strides[1] != number.itemsize:
            raise ValueError(f"expected ({len(scan.inputs)}, n) values, row by row, got {rows.shape}")
        shape = (len(scan.outputs), rows.shape[1], self.lanes)
        if out.shape != shape or out.dtype != number or (out.size and out.strides[2] != number.itemsize):
            raise ValueError(f"out has to be {shape} of {number} with a contiguous last axis")
