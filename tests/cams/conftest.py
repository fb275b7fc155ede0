"""The paper's example, and a high-precision oracle for paths of exponential curvature."""

from __future__ import annotations

import mpmath as mp
import pytest

from centrode.cams.curvature_laws import ExponentialCurvature

DIGITS = 40
STEPS = 12
ORDER = 36


def exponential_path(
    k0: float, k1: float, rho0: float, gamma0: float, phi: float
) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """rho, gamma and eta' at phi to some 30 digits, by Taylor series of ln(rho) and gamma with 40 digits.

    Written from the geometry, not from the package: `ln(rho)' = tan(gamma), gamma' = 1 - rho K / cos(gamma)`, with
    t = tan(gamma), `t' = (1 + t^2) (1 - rho K sqrt(1 + t^2))`.
    """
    with mp.workdps(DIGITS):
        h = mp.mpf(phi) / STEPS
        rho, gamma = mp.mpf(rho0), mp.mpf(gamma0)
        for step in range(STEPS):
            curvature = mp.mpf(k0) * mp.exp(mp.mpf(k1) * step * h)
            rho, gamma = _step(rho, gamma, curvature, mp.mpf(k1), h)
        bend = rho * mp.mpf(k0) * mp.exp(mp.mpf(k1) * mp.mpf(phi))
        return rho, gamma, mp.cos(gamma) - bend


def _step(rho: mp.mpf, gamma: mp.mpf, curvature: mp.mpf, k1: mp.mpf, h: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    # w = 1/cos(gamma): w' = w t gamma', t' = w^2 gamma', q = rho K w: q' = q (t + k1 + t gamma')
    t, w = [mp.tan(gamma)], [1 / mp.cos(gamma)]
    q, turn, g = [rho * curvature / mp.cos(gamma)], [], [gamma]
    log = [mp.log(rho)]
    for n in range(ORDER):
        turn.append((1 if n == 0 else 0) - q[n])
        g.append(turn[n] / (n + 1))
        log.append(t[n] / (n + 1))
        square = [mp.fsum(w[i] * w[k - i] for i in range(k + 1)) for k in range(n + 1)]
        tilt = [mp.fsum(t[i] * turn[k - i] for i in range(k + 1)) for k in range(n + 1)]
        t.append(mp.fsum(square[i] * turn[n - i] for i in range(n + 1)) / (n + 1))
        w.append(mp.fsum(w[i] * tilt[n - i] for i in range(n + 1)) / (n + 1))
        rate = [t[k] + tilt[k] + (k1 if k == 0 else 0) for k in range(n + 1)]
        q.append(mp.fsum(q[i] * rate[n - i] for i in range(n + 1)) / (n + 1))
    return mp.exp(mp.polyval(log[::-1], h)), mp.polyval(g[::-1], h)


@pytest.fixture
def law() -> ExponentialCurvature:
    """The curvature of the paper's example."""
    return ExponentialCurvature(10.0, 0.75)
