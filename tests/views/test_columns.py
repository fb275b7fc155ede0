"""What rounding leaves of zero is zero where it is shown."""

import numpy as np

from centrode.views.columns import without_rounding


def test_a_number_of_rounding_is_zero_beside_a_greater_one() -> None:
    assert without_rounding([-7.39e-16, 1.4]).tolist() == [0.0, 1.4]
    # beside nothing greater it stays what it is, whatever its size
    assert without_rounding([-7.39e-16, 2e-16]).tolist() == [-7.39e-16, 2e-16]
    assert np.array_equal(without_rounding([[1e-13, 1.0], [1e-13, 0.0]]), [[0.0, 1.0], [1e-13, 0.0]])
